from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import msgspec
import pytest
from hypothesis import given
from hypothesis import strategies as st
from msgspec.structs import replace

from game.coach.acts import Level
from game.coach.levels import LevelState
from game.coach.presets import CALIBRATED, FIG10, LITERAL, PRESETS, RELEASED, Preset, preset

VECTORS = Path(__file__).resolve().parents[1] / "reference" / "goal_inference.json"
LEVELS = st.sampled_from(Level)
PROBABILITIES = st.floats(0, 1).filter(lambda p: min(abs(p - 0.3), abs(p - 0.8)) > 1e-9)


def stepped(level: Level, comprehension: float, low: float = 0.3, high: float = 0.8) -> Level:
    """The level after one evaluation by Algorithm 1."""
    rule = replace(LITERAL, lower_below=low, raise_above=high)
    return LevelState(level).evaluated(rule, comprehension).level


def test_algorithm_1_on_the_worked_case() -> None:
    case = json.loads(VECTORS.read_text())["level_case"]
    level, levels = Level(case["start"]), []
    for comprehension in case["P"]:
        level = stepped(level, comprehension, case["tau_B"], case["tau_G"])
        levels.append(level)
    assert levels == case["levels_after"]


@given(LEVELS, PROBABILITIES)
def test_algorithm_1_moves_at_most_one_level(level: Level, p: float) -> None:
    assert abs(stepped(level, p) - level) <= 1
    assert stepped(level, p) in Level


@pytest.mark.parametrize("p", [0.3 - 1e-12, 0.8 + 1e-12])
def test_the_last_bits_decide_nothing(p: float) -> None:
    assert stepped(Level.C2, p) is Level.C2


def _levels(chosen: Preset, *comprehensions: float) -> list[int]:
    state = LevelState.first(chosen)
    levels = []
    for comprehension in comprehensions:
        state = state.evaluated(chosen, comprehension)
        levels.append(int(state.level))
    return levels


@given(st.lists(PROBABILITIES, max_size=12))
def test_literal_is_algorithm_1(comprehensions: list[float]) -> None:
    level, expected = int(Level.C2), []
    for comprehension in comprehensions:
        if comprehension < 0.3:
            level = max(Level.C1, level - 1)
        elif comprehension > 0.8:
            level = min(Level.C3, level + 1)
        expected.append(int(level))
    assert _levels(LITERAL, *comprehensions) == expected


def test_calibrated_goes_up_only_at_a_goals_end() -> None:
    state = LevelState.first(CALIBRATED).evaluated(CALIBRATED, 0.9).evaluated(CALIBRATED, 0.9)
    assert state.level is Level.C2
    assert state.rescued(CALIBRATED) == LevelState(Level.C3)


def test_calibrated_stays_down_when_something_went_down_within_the_goal() -> None:
    state = LevelState(Level.C3).evaluated(CALIBRATED, 0.1)
    assert state.level is Level.C2
    state = state.evaluated(CALIBRATED, 0.9).rescued(CALIBRATED)
    assert state == LevelState(Level.C2)
    assert state.evaluated(CALIBRATED, 0.9).rescued(CALIBRATED).level is Level.C3


def test_a_verdict_that_cannot_go_lower_still_bars_the_rise() -> None:
    state = LevelState(Level.C1).evaluated(CALIBRATED, 0.1).evaluated(CALIBRATED, 0.9)
    assert state.rescued(CALIBRATED).level is Level.C1


def test_calibrated_rises_on_what_was_said_last() -> None:
    state = LevelState(Level.C2).evaluated(CALIBRATED, 0.9).evaluated(CALIBRATED, 0.5)
    assert state.rescued(CALIBRATED).level is Level.C2
    assert LevelState(Level.C2).rescued(CALIBRATED).level is Level.C2


def test_agreement_counts_at_a_goals_end_too() -> None:
    chosen = msgspec.structs.replace(CALIBRATED, agreement=2)
    once = LevelState(Level.C2).evaluated(chosen, 0.9)
    assert once.rescued(chosen).level is Level.C2
    assert once.evaluated(chosen, 0.9).rescued(chosen).level is Level.C3


def test_fig10_needs_two_in_a_row_for_every_change() -> None:
    assert _levels(FIG10, 0.1, 0.5, 0.1, 0.9) == [2, 2, 2, 2]
    assert _levels(FIG10, 0.9, 0.9, 0.1, 0.1, 0.1, 0.1) == [2, 3, 3, 2, 2, 1]


def test_fig10_counts_afresh_at_each_goal() -> None:
    state = LevelState(Level.C2).evaluated(FIG10, 0.9).rescued(FIG10)
    state = state.evaluated(FIG10, 0.9)
    assert state.level is Level.C2
    assert state.evaluated(FIG10, 0.9).level is Level.C3


@given(st.lists(st.tuples(PROBABILITIES, st.booleans()), min_size=1))
def test_released_depends_on_the_latest_evaluation_alone(
    evaluations: list[tuple[float, bool]],
) -> None:
    state = LevelState.first(RELEASED)
    for p, inside in evaluations:
        state = state.evaluated(RELEASED, p, in_goal_room=inside)
    p, inside = evaluations[-1]
    fresh = LevelState.first(RELEASED).evaluated(RELEASED, p, in_goal_room=inside)
    assert state.level is fresh.level
    assert (state.level is Level.C3) == (inside and round(p, 9) > 0.8)
    assert state.rescued(RELEASED).level is Level.C2
    assert state.given_up().level is state.level


@given(
    st.sampled_from(sorted(PRESETS)),
    st.lists(st.one_of(PROBABILITIES, st.none()), max_size=20),
)
def test_no_step_preset_moves_more_than_one_level_at_once(
    name: str, stream: list[float | None]
) -> None:
    chosen = preset(name)
    state = LevelState.first(chosen)
    for p in stream:
        after = (
            state.rescued(chosen) if p is None else state.evaluated(chosen, p, in_goal_room=True)
        )
        if chosen.rule == "step":
            assert abs(after.level - state.level) <= 1
        state = after


@pytest.mark.parametrize("name", sorted(PRESETS))
def test_the_journal_can_hold_a_preset_whole(name: str) -> None:
    chosen = preset(name)
    assert chosen.name == name
    assert chosen.first_level is Level.C2
    assert msgspec.json.decode(msgspec.json.encode(chosen), type=Preset) == chosen


def test_an_unknown_preset_is_met_with_the_known_ones() -> None:
    with pytest.raises(ValueError, match="calibrated, literal, fig10, released"):
        preset("best")


@pytest.mark.parametrize(
    ("base", "change", "field"),
    [
        ("calibrated", {"beta": -1.0}, "beta"),
        ("calibrated", {"beta": float("nan")}, "beta"),
        ("calibrated", {"lower_below": 0.0}, "lower_below"),
        ("calibrated", {"raise_above": 0.2}, "raise_above"),
        ("calibrated", {"prior_mass": None}, "prior_mass"),
        ("calibrated", {"prior_mass": 1.0}, "prior_mass"),
        ("literal", {"prior_mass": 0.5}, "prior_mass"),
        ("calibrated", {"window_moves": 2}, "window_moves"),
        ("calibrated", {"minimum_moves": -1}, "minimum_moves"),
        ("calibrated", {"every_ms": None}, "every_ms"),
        ("literal", {"every_ms": 1000}, "every_ms"),
        ("calibrated", {"agreement": 0}, "agreement"),
        ("released", {"raise_only_at_goal_end": True}, "raise_only_at_goal_end"),
        ("calibrated", {"highest_only_in_goal_room": True}, "highest_only_in_goal_room"),
        ("fig10", {"prior_below_threshold": False}, "prior_below_threshold"),
        ("literal", {"prior_below_threshold": False}, "prior_below_threshold"),
        ("calibrated", {"prior_below_threshold": True}, "prior_below_threshold"),
        ("calibrated", {"prior_mass": 0.25}, "prior_below_threshold"),
    ],
)
def test_a_bad_preset_names_its_field(base: str, change: dict[str, Any], field: str) -> None:
    with pytest.raises(ValueError, match=f"preset field {field} "):
        msgspec.structs.replace(preset(base), **change)
