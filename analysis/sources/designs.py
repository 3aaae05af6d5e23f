"""What a study's settings say of its design: what it crosses, and which of the paper's tests it
supports."""

import tomllib
from dataclasses import dataclass
from pathlib import Path
from typing import Any, get_args

from analysis.sources.absent import SourceError
from analysis.sources.factors import ADAPTIVITY, COMPLEXITY
from game.forms.form import Forms
from game.tables.designs import (
    LABELLED_LATE,
    PRIMARY_CORRECTION,
    PRIMARY_OUTCOMES,
    Correction,
    labelled_late,
    levels_given,
    supported,
)

SETTINGS = "study.toml"


@dataclass(frozen=True)
class Primary:
    """The primary outcomes that the settings fix before any data are collected, and the correction
    of each effect's p over them."""

    outcomes: tuple[str, ...]
    correction: Correction


@dataclass(frozen=True)
class Crossed:
    """What a study crosses: its instructors as study.toml names them, the static levels that
    people were given, and the number of rounds; the paper's, if nothing is said. `primary` is None
    where no settings are known."""

    instructors: tuple[str, str] = ("static", "ana")
    levels: tuple[str, ...] = COMPLEXITY
    rounds: int = 2
    labels: bool = True
    preference: bool = True
    labelled_late: bool = False
    primary: Primary | None = None

    @property
    def words(self) -> tuple[str, str]:
        """What the two instructors are called in results: static and adaptive where they are, their
        own names in other pairs."""
        first, second = (name.partition(":")[0] for name in self.instructors)
        return ADAPTIVITY if first == "static" != second else self.instructors

    @property
    def has_anova(self) -> bool:
        """Whether the design has the paper's mixed ANOVA: everybody has both instructors, and rooms
        are labelled, which forms the knowledge groups."""
        return self.rounds > 1 and self.labels

    @property
    def gap(self) -> str:
        """What a difference is of: the second instructor less the first."""
        return " - ".join(reversed(self.words))

    @property
    def mapping(self) -> str:
        """Who `static` and `adaptive` stand for, where they are not that; else empty."""
        if self.words == ADAPTIVITY:
            return ""
        return " and ".join(
            f"“{word}” stands for {name}" for word, name in zip(ADAPTIVITY, self.words, strict=True)
        )

    def notes(self, forms: Forms) -> list[str]:
        """What a reader must know of the design; nothing for the paper's."""
        tests = supported(
            pair=self.instructors,
            levels=self.levels,
            rounds=self.rounds,
            labels=self.labels,
            preference=self.preference,
            forms=forms,
        )
        lacking = [f"{test.name} ({'; '.join(test.lacking)})" for test in tests if test.lacking]
        notes = [f"in columns and tests {self.mapping}"] if self.mapping else []
        if self.labelled_late:
            notes.append(LABELLED_LATE)
        if lacking:
            notes.append(f"the design does not support: {', '.join(lacking)}")
        return notes


PAPER_DESIGN = Crossed()


def crossed_in(folder: Path) -> Crossed:
    """What the study whose settings lie in `folder` crosses; the paper's design where there are no
    settings. Raises SourceError for settings that cannot be read."""
    path = folder / SETTINGS
    try:
        tree: dict[str, Any] = tomllib.loads(path.read_text(encoding="utf-8-sig"))
    except FileNotFoundError:
        return PAPER_DESIGN
    except (OSError, UnicodeDecodeError, tomllib.TOMLDecodeError) as error:
        raise SourceError(f"the settings cannot be read ({error})", place=str(path)) from error
    static, ana = PAPER_DESIGN.instructors
    correction = tree.get("primary", {}).get("correction", PRIMARY_CORRECTION)
    if correction not in get_args(Correction):
        raise SourceError(
            f"primary.correction is {correction!r}",
            place=str(path),
            hint=f"It must be one of {', '.join(get_args(Correction))}",
        )
    first, second = tree.get("instructors") or (static, tree.get("coach", ana))
    return Crossed(
        instructors=(first, second),
        levels=levels_given((first, second), tree.get("static_levels", (1, 2, 3))),
        rounds=tree.get("rounds", PAPER_DESIGN.rounds),
        labels="label" in tree.get("round_phases", ("label",)),
        preference="preference" in tree.get("phases", ("preference",)),
        labelled_late=labelled_late(tree.get("round_phases", ())),
        primary=Primary(
            tuple(tree.get("primary", {}).get("outcomes", PRIMARY_OUTCOMES)),
            correction,
        ),
    )
