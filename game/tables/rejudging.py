"""Algorithm 1 run again on recorded evaluations, under another preset: pure.

The rescuer's behaviour stays as it was under the levels that were actually shown. So this tells how
a rule judges given behaviour, not what people would have done under that rule.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import NamedTuple

import msgspec

from game.coach.acts import Level
from game.coach.levels import LevelState
from game.coach.presets import Preset, preset
from game.tables.mission_tables import level_name
from game.tables.rows import LevelName
from game.world.events import LevelWish

Rule = Preset
"""The choices that Algorithm 1 leaves open, as the analysis knows them."""


class Judged(NamedTuple):
    """An evaluation at mission time `at_ms` that carries evidence, and its comprehension."""

    at_ms: int
    comprehension: float


class Lost(NamedTuple):
    """The rescuer was noticed to be lost at mission time `at_ms`."""

    at_ms: int


class Astray(NamedTuple):
    """The rescuer made a misstep at mission time `at_ms`, for which the goal may be `given_up`."""

    at_ms: int
    given_up: bool


class Asked(NamedTuple):
    """The rescuer asked for other words at mission time `at_ms`."""

    at_ms: int
    want: LevelWish


class GoalEnd(NamedTuple):
    """A goal ended at mission time `at_ms`, by a rescue or because it was given up; the level stays
    then, and earlier verdicts are forgotten."""

    at_ms: int
    rescued: bool


def rule_of(
    name: str, *, lower_below: float | None = None, raise_above: float | None = None
) -> Preset:
    """A shipped preset, with other thresholds if given.

    Raises ValueError for an unknown preset, for thresholds that make no sense, and for a preset
    whose rule needs more than comprehension.
    """
    found = preset(name)
    if found.rule != "step" or found.certain_in_goal_room:
        raise ValueError(f"the rule of {name} needs to know where the rescuer is")
    low = found.lower_below if lower_below is None else lower_below
    below = found.prior_mass is None or found.prior_mass < low
    return msgspec.structs.replace(
        found,
        lower_below=low,
        raise_above=found.raise_above if raise_above is None else raise_above,
        prior_below_threshold=below,
    )


def with_prior_mass(comprehension: float, recorded: float, other: float) -> float:
    """What comprehension would be if the instructed prior had put the mass `other` on the goal's
    room instead of `recorded`: the same likelihoods with other prior odds (Bayes' rule)."""
    odds = (other / (1 - other)) / (recorded / (1 - recorded))
    return odds * comprehension / (odds * comprehension + 1 - comprehension)


Happened = Judged | Lost | Astray | Asked | GoalEnd
"""What Algorithm 1 takes account of."""


def levels_under(rule: Preset, happened: Iterable[Happened]) -> Iterator[tuple[int, LevelName]]:
    """When each level came into force, beginning with the first at 0 ms. At a tie the end of a goal
    goes first, and being lost or astray last, as in a mission."""
    state = LevelState.first(rule)
    yield 0, level_name(state.level)
    for what in sorted(happened, key=lambda it: (it.at_ms, _TIES.index(type(it)))):
        before = state.level
        state = _after(state, rule, what)
        if state.level is not before:
            yield what.at_ms, level_name(state.level)


_TIES = (GoalEnd, Asked, Judged, Lost, Astray)


def _after(state: LevelState, rule: Preset, what: Happened) -> LevelState:
    match what:
        case GoalEnd(rescued=rescued):
            return state.rescued(rule) if rescued else state.given_up()
        case Judged(comprehension=comprehension):
            return state.evaluated(rule, comprehension)
        case Asked(want=want):
            return state.asked(want)
        case Lost():
            return state.lowered() if rule.lowers_when_lost else state
        case Astray(given_up=given_up):
            if rule.lowers_when_lost and state.level is Level.C3:
                state = state.lowered()
            return state.given_up() if given_up else state
