"""What a study's settings say of its design: which of the paper's tests it supports."""

import tomllib
from pathlib import Path
from typing import Any

from analysis.sources.absent import SourceError
from game.forms.form import Forms
from game.tables.designs import supported

SETTINGS = "study.toml"
_PAIR = ("static", "ana")


def design_notes(folder: Path, forms: Forms) -> list[str]:
    """What a reader must know of the design of the study whose settings lie in `folder`; nothing
    for the paper's design. Raises SourceError for settings that cannot be read."""
    path = folder / SETTINGS
    try:
        tree: dict[str, Any] = tomllib.loads(path.read_text(encoding="utf-8-sig"))
    except FileNotFoundError:
        return []
    except (OSError, UnicodeDecodeError, tomllib.TOMLDecodeError) as error:
        raise SourceError(f"the settings cannot be read ({error})", place=str(path)) from error
    first, second = tree.get("instructors") or (_PAIR[0], tree.get("coach", _PAIR[1]))
    notes = []
    if first != "static":
        notes.append(
            f"in columns and tests `static` stands for the instructor {first}, and `adaptive` for "
            f"{second}"
        )
    tests = supported(
        pair=(first, second),
        levels=[f"C{level}" for level in tree.get("static_levels", (1, 2, 3))],
        rounds=tree.get("rounds", 2),
        labels="label" in tree.get("round_phases", ("label",)),
        preference="preference" in tree.get("phases", ("preference",)),
        forms=forms,
    )
    lacking = [f"{test.name} ({'; '.join(test.lacking)})" for test in tests if test.lacking]
    if lacking:
        notes.append(f"the design does not support: {', '.join(lacking)}")
    return notes
