"""Algorithm 1 (paper 5.2.2): from comprehension to the level of the next instruction."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cache
from typing import Literal

from game.coach.acts import Level
from game.coach.presets import Preset
from game.world.events import LevelWish

Verdict = Literal["lower", "keep", "raise"]

DECIMALS = 9
"""Thresholds decide on rounded values, so that the last bit of exp() decides nothing."""

SHIFT = 0.2
"""By how much each press of the level key shifts both thresholds. After two presses for simpler
words, a walk that leaves the goal an open question lowers the level."""
MOST_PREFERENCE = 2
"""So many presses count at most, either way."""
LEAST = 0.05
"""No threshold lies nearer to 0 or 1."""


def preferring(before: int, want: LevelWish) -> int:
    """How many more times simpler words have been asked for than shorter ones, once `want` has been
    asked for too; at most `MOST_PREFERENCE` either way."""
    after = before + (1 if want == "simpler" else -1)
    return min(MOST_PREFERENCE, max(-MOST_PREFERENCE, after))


def granted(want: LevelWish, before: Level, chosen: Level | None = None) -> Level:
    """The level that answers a request: the one that the coach would have `chosen`, if it lies on
    the side that was asked for, else the next one there; the same where there is none."""
    if want == "simpler":
        nearest = _moved(before, "lower")
        return nearest if chosen is None else min(nearest, chosen)
    nearest = _moved(before, "raise")
    return nearest if chosen is None else max(nearest, chosen)


def thresholds(preset: Preset, preference: int) -> tuple[float, float]:
    """Below the first the level goes down, above the second up, for a rescuer with this
    `preference`."""
    return _shifted(preset.lower_below, preset.raise_above, preference)


@cache
def _shifted(lower_below: float, raise_above: float, preference: int) -> tuple[float, float]:
    shift = SHIFT * preference
    low, high = (round(float(it) + shift, DECIMALS) for it in (lower_below, raise_above))
    return max(LEAST, low), min(1 - LEAST, high)


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
    one that counted asked for a lower level, even where there is none below. `preference` is above
    0 for a rescuer who has asked for simpler words, below for one who has asked for shorter ones.
    """

    level: Level
    latest: Verdict = "keep"
    run: int = 0
    went_down: bool = False
    preference: int = 0

    @classmethod
    def first(cls, preset: Preset) -> LevelState:
        return cls(preset.first_level)

    def thresholds(self, preset: Preset) -> tuple[float, float]:
        """The thresholds of `preset` as the rescuer's preference shifts them."""
        return thresholds(preset, self.preference)

    def evaluated(
        self, preset: Preset, comprehension: float, *, in_goal_room: bool = False
    ) -> LevelState:
        """The state after an evaluation that carries evidence."""
        said = verdict(comprehension, *self.thresholds(preset))
        run = self.run + 1 if said == self.latest else 1
        heard = LevelState(self.level, said, run, self.went_down, self.preference)
        if run < preset.agreement:
            return heard
        if preset.rule == "absolute":
            barred = preset.highest_only_in_goal_room and not in_goal_room
            level = _ABSOLUTE["keep" if said == "raise" and barred else said]
            return replace(heard, level=level)
        if said == "keep" or (said == "raise" and preset.raise_only_at_goal_end):
            return heard
        return self._at(_moved(self.level, said), went_down=said == "lower")

    def lowered(self) -> LevelState:
        """The state after the rescuer was found lost or astray: one level down, and not up at the
        goal."""
        return self._at(_moved(self.level, "lower"), went_down=True)

    def asked(self, want: LevelWish) -> LevelState:
        """The state after the rescuer has asked for other words: one level that way, and a
        preference for it; after simpler words not up at the goal."""
        preference = preferring(self.preference, want)
        level, simpler = granted(want, self.level), want == "simpler"
        return LevelState(level, went_down=simpler, preference=preference)

    def given_up(self) -> LevelState:
        """The state with which the next goal begins after one that was given up: the level stays,
        and what was said is forgotten."""
        return self._at(self.level)

    def rescued(self, preset: Preset) -> LevelState:
        """The state with which the next goal begins after a rescue."""
        if preset.after_rescue == "first_level":
            return self._at(preset.first_level)
        rises = (
            preset.raise_only_at_goal_end
            and self.latest == "raise"
            and self.run >= preset.agreement
            and not self.went_down
        )
        return self._at(_moved(self.level, "raise") if rises else self.level)

    def _at(self, level: Level, *, went_down: bool = False) -> LevelState:
        return LevelState(level, went_down=went_down, preference=self.preference)


_ABSOLUTE = {"lower": Level.C1, "keep": Level.C2, "raise": Level.C3}
_STEP = {"lower": -1, "keep": 0, "raise": 1}


def _moved(level: Level, said: Verdict) -> Level:
    return Level(min(Level.C3, max(Level.C1, level + _STEP[said])))
