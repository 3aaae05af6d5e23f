"""Algorithm 1 (paper 5.2.2): from comprehension to the level of the next instruction."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Literal

from game.coach.acts import Level
from game.coach.presets import Preset

Verdict = Literal["lower", "keep", "raise"]

DECIMALS = 9
"""Thresholds decide on rounded values, so that the last bit of exp() decides nothing."""


def verdict(comprehension: float, lower_below: float, raise_above: float) -> Verdict:
    """What an evaluation asks for; strict, so a value on a threshold keeps the level."""
    value = round(comprehension, DECIMALS)
    if value < lower_below:
        return "lower"
    return "raise" if value > raise_above else "keep"


@dataclass(frozen=True)
class LevelState:
    """The level in force, and what the evaluations within the goal have said so far.

    `latest` is the last verdict, `run` how many evaluations in a row gave it; `went_down` whether
    one that counted asked for a lower level, even where there is none below.
    """

    level: Level
    latest: Verdict = "keep"
    run: int = 0
    went_down: bool = False

    @classmethod
    def first(cls, preset: Preset) -> LevelState:
        return cls(preset.first_level)

    def evaluated(
        self, preset: Preset, comprehension: float, *, in_goal_room: bool = False
    ) -> LevelState:
        """The state after an evaluation that carries evidence."""
        said = verdict(comprehension, preset.lower_below, preset.raise_above)
        run = self.run + 1 if said == self.latest else 1
        heard = replace(self, latest=said, run=run)
        if run < preset.agreement:
            return heard
        if preset.rule == "absolute":
            barred = preset.highest_only_in_goal_room and not in_goal_room
            level = _ABSOLUTE["keep" if said == "raise" and barred else said]
            return replace(heard, level=level)
        if said == "keep" or (said == "raise" and preset.raise_only_at_goal_end):
            return heard
        return LevelState(_moved(self.level, said), went_down=said == "lower")

    def goal_ended(self, preset: Preset, *, rescued: bool) -> LevelState:
        """The state with which the next goal begins: what the last one said is forgotten."""
        if rescued and preset.after_rescue == "first_level":
            return LevelState.first(preset)
        rises = (
            preset.raise_only_at_goal_end
            and self.latest == "raise"
            and self.run >= preset.agreement
            and not self.went_down
        )
        return LevelState(_moved(self.level, "raise") if rises else self.level)


_ABSOLUTE = {"lower": Level.C1, "keep": Level.C2, "raise": Level.C3}
_STEP = {"lower": -1, "keep": 0, "raise": 1}


def _moved(level: Level, said: Verdict) -> Level:
    return Level(min(Level.C3, max(Level.C1, level + _STEP[said])))
