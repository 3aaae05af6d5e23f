"""Algorithm 1 run again on recorded evaluations, under another preset: pure.

The rescuer's behaviour stays as it was under the levels that were actually shown. So this tells how
a rule judges given behaviour, not what people would have done under that rule.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from typing import NamedTuple

import msgspec

from game.coach.levels import LevelState
from game.coach.presets import Preset, preset
from game.tables.mission_tables import level_name
from game.tables.rows import LevelName

Rule = Preset
"""The choices that Algorithm 1 leaves open, as the analysis knows them."""


class Judged(NamedTuple):
    """An evaluation at mission time `at_ms` that carries evidence, and its comprehension."""

    at_ms: int
    comprehension: float


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


def levels_under(
    rule: Preset, judged: Sequence[Judged], ends: Sequence[GoalEnd]
) -> Iterator[tuple[int, LevelName]]:
    """When each level came into force, beginning with the first at 0 ms. At a tie the end of a goal
    goes first, as in a mission."""
    state = LevelState.first(rule)
    yield 0, level_name(state.level)
    for at_ms, what in _in_order(judged, ends):
        before = state.level
        if isinstance(what, GoalEnd):
            state = state.rescued(rule) if what.rescued else state.given_up()
        else:
            state = state.evaluated(rule, what.comprehension)
        if state.level is not before:
            yield at_ms, level_name(state.level)


def _in_order(
    judged: Iterable[Judged], ends: Iterable[GoalEnd]
) -> list[tuple[int, Judged | GoalEnd]]:
    both: list[Judged | GoalEnd] = [*ends, *judged]
    return sorted(((what.at_ms, what) for what in both), key=lambda timed: timed[0])
