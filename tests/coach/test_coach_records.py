"""What holds for the records of every coach, whatever the rescuer does."""

from __future__ import annotations

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from game.coach.acts import Disobeyed, InstructionIssued, Misstep
from game.coach.spec import CoachSpec
from game.rescuers.driver import drive
from game.rescuers.literal import LiteralReader
from game.world import load_building
from game.world.building import Building
from game.world.events import Action
from game.world.settings import Controls, MissionSettings
from tests.coach.scripted import (
    BOX,
    EVERY,
    PRACTICE,
    STATIC,
    E,
    Game,
    N,
    S,
    T,
    W,
    check_records,
    only,
)


@settings(max_examples=60)
@given(
    st.sampled_from(EVERY),
    st.sampled_from(["compass", "turn"]),
    st.sampled_from([BOX, PRACTICE]),
    st.lists(st.tuples(st.integers(0, 7), st.integers(0, 1_500)), max_size=120),
)
def test_whatever_the_rescuer_does_the_bar_and_the_records_agree(
    spec: CoachSpec,
    controls: Controls,
    building: Building,
    keys: list[tuple[int, int]],
) -> None:
    first, again = (_played(spec, controls, building, keys) for _ in range(2))
    assert first.records == again.records
    check_records(first, spec)


def _played(
    spec: CoachSpec, controls: Controls, building: Building, keys: list[tuple[int, int]]
) -> Game:
    compass = (N, E, S, W, N, E, S, T)
    turning = (Action.FORWARD,) * 4 + (Action.TURN_LEFT, Action.TURN_RIGHT, Action.FORWARD, T)
    chosen = MissionSettings(controls=controls, red_expiry_ms=30_000, duration_ms=60_000)
    game = Game(spec, building, chosen)
    for key, pause_ms in keys:
        game.act((compass if controls == "compass" else turning)[key])
        game.wait(pause_ms)
    game.wait(60_000)
    return game


@pytest.mark.parametrize("name", ["foundry", "harbour"])
@pytest.mark.parametrize("spec", STATIC[:2], ids=["C1", "C2"])
def test_a_literal_follower_saves_nearly_everybody_without_a_misstep(
    name: str, spec: CoachSpec
) -> None:
    game = Game(spec, load_building(name))
    drive(game.run, LiteralReader("compass"))
    assert game.mission.rescued in (18, 19)
    assert not only(Misstep, game.records)
    assert not [r for r in only(InstructionIssued, game.records) if r.reason == "off_path"]
    check_records(game, spec)


@pytest.mark.slow
@pytest.mark.parametrize("controls", ["compass", "turn"])
@pytest.mark.parametrize("name", ["foundry", "harbour", "practice"])
@pytest.mark.parametrize("spec", EVERY, ids=lambda spec: str(spec.preset or spec.level))
def test_nobody_gets_stuck(name: str, spec: CoachSpec, controls: Controls) -> None:
    building = load_building(name)
    game = Game(spec, building, MissionSettings(controls=controls))
    drive(game.run, LiteralReader(controls, {room.name: room.label for room in building.rooms}))
    assert game.mission.rescued >= min(16, len(building.victims))
    assert not only(Disobeyed, game.records)
    check_records(game, spec)
