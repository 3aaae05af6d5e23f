"""What a part of the results is made from, and what it is made into."""

from collections import defaultdict
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

from analysis.pages.apa_table import ApaTable
from analysis.pages.published import STUDY_FILE, printed
from analysis.pages.style import Captioned
from analysis.sources.frames import StudyData
from analysis.sources.recorded import Recorded

Numbers = Mapping[str, Any]


@dataclass(frozen=True)
class Found:
    """What a section is made from: the numbers of the battery, the analysed sample, everybody
    randomised, what was recorded where that is known, and the folder of the printed numbers."""

    numbers: Numbers
    study: StudyData
    randomised: StudyData
    recorded: Recorded | None
    paper: Path

    @property
    def alpha(self) -> float:
        """The level that tests are judged at."""
        level: float = self.numbers["source"]["alpha_level"]
        return level

    def printed(self, quantity: str) -> str:
        """One printed number of the study, as text."""
        table = printed(self.paper, STUDY_FILE)
        return str(table.loc[table["quantity"] == quantity, "value"].iloc[0])

    def effect(self, outcome: str, effect: str) -> Numbers | None:
        """One line of an outcome's ANOVA, or None where there is no ANOVA."""
        rows = self.own(outcome)["anova"]
        return next((row for row in rows or () if row["effect"] == effect), None)

    def own(self, outcome: str) -> Numbers:
        """The numbers of an outcome; all of them are None where the study does not ask for it."""
        numbers: Numbers = self.numbers["outcomes"].get(outcome, defaultdict(lambda: None))
        return numbers


Drawing = Callable[[], Captioned]
"""Draws a figure when it is wanted; raises Refusal where it cannot be had."""


@dataclass(frozen=True)
class Part:
    """A part of the results under its title: sentences (*x* is an italic x), tables, figures."""

    title: str
    sentences: list[str]
    tables: list[ApaTable]
    drawings: list[Drawing]


def drawing(make: Callable[..., Captioned], *arguments: object, **named: object) -> Drawing:
    """The figure that a function draws of these arguments."""
    return partial(make, *arguments, **named)
