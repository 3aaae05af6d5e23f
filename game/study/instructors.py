"""The pair of instructors of a study: how they are named in study.toml, and who each one is."""

from __future__ import annotations

from typing import NamedTuple

from game.coach.acts import Level
from game.coach.knowledge.assumed import QuizMark
from game.coach.own import SEPARATOR
from game.coach.presets import PRESETS
from game.coach.registry import KINDS
from game.coach.spec import CoachSpec, coach_given
from game.coach.yoke import Yoke
from game.errors import choose_from


class Instructor(NamedTuple):
    """An instructor. `preset` is how it adapts, and `level` the level it keeps whatever the
    design's; None where the study says."""

    kind: str
    preset: str | None = None
    level: Level | None = None

    def takes(self, choice: str) -> bool:
        """Whether it is given something: `level`, `preset`, `quiz` or `yoke`."""
        return self.kind in KINDS and choice in KINDS[self.kind].choices

    @property
    def by_design(self) -> bool:
        """Whether it speaks at the static level of the design cell."""
        return self.takes("level") and self.level is None

    def spec(
        self,
        level: Level,
        preset: str,
        quiz: dict[str, QuizMark] | None = None,
        yoke: Yoke | None = None,
    ) -> CoachSpec:
        """It as a coach for a mission, given what it takes of this."""
        return coach_given(
            self.kind,
            level=self.level or level,
            preset=self.preset or preset,
            quiz=quiz,
            yoke=yoke,
        )


def instructor_named(name: str) -> Instructor:
    """The instructor that a name in study.toml means: a kind of coach, `ana:PRESET`,
    `static:LEVEL`, or `FILE.py:CLASS`. Raises ValueError for a name that is none."""
    kind, _, detail = name.partition(SEPARATOR)
    if kind in KINDS:
        if not detail:
            return Instructor(kind)
        if detail in PRESETS and "preset" in KINDS[kind].choices:
            return Instructor(kind, preset=detail)
        if detail in ("1", "2", "3") and "level" in KINDS[kind].choices:
            return Instructor(kind, level=Level(int(detail)))
        can = PRESETS if "preset" in KINDS[kind].choices else ("1", "2", "3")
        raise ValueError(f"instructors: there is no {name}. {choose_from(detail, can)}")
    if detail and kind.endswith(".py"):
        return Instructor(name)
    known = ("FILE.py:CLASS", "ana:PRESET", "static:LEVEL")
    raise ValueError(f"instructors: there is no {name}. {choose_from(name, (*KINDS, *known))}")
