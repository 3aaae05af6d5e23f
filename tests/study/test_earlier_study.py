"""A study of an earlier version, whose questions are in items.toml, runs as it did."""

from __future__ import annotations

import shutil
from pathlib import Path
from typing import Any

import msgspec

from game.study.folder import Study, open_study
from tests.study.people import P01, journal_of, small_study, take_part

EARLIER = Path(__file__).parents[1] / "data" / "earlier_study"


def earlier_study(folder: Path) -> Study:
    """A small study as an earlier version made it."""
    small_study(folder)
    for name in ("forms.toml", "instructions.toml"):
        (folder / name).unlink()
    for name in ("items.toml", "texts.toml"):
        shutil.copy(EARLIER / name, folder / name)
    return open_study(folder)


def told(study: Study) -> list[dict[str, Any]]:
    """Every record of the session, but for the hashes of what it was made from."""
    records = []
    for entry in journal_of(study).entries:
        fields = msgspec.to_builtins(entry.record)
        records.append({k: v for k, v in fields.items() if k not in ("inputs", "version")})
    return records


def test_its_questions_are_read_as_forms_with_a_note(tmp_path: Path) -> None:
    study = earlier_study(tmp_path / "earlier")
    assert [name for name in study.inputs if name.endswith(".toml")] == [
        "study.toml",
        "texts.toml",
        "items.toml",
    ]
    (note,) = study.notes
    assert "items.toml" in note
    assert "forms.toml" in note


def test_a_session_of_it_is_that_of_a_new_study(tmp_path: Path) -> None:
    earlier, new = earlier_study(tmp_path / "earlier"), small_study(tmp_path / "new")
    assert earlier.course == new.course
    for study in (earlier, new):
        assert take_part(study, P01)[0] == "over"
    assert told(earlier) == told(new)
