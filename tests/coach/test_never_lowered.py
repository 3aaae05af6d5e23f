"""The law of the default preset: a rescuer who does just as told is never lowered."""

from __future__ import annotations

from itertools import product
from typing import get_args

import msgspec
import pytest
from hypothesis import given, settings

from game.coach.acts import Level, LevelChanged, LostNoticed, Misstep, PosteriorEvaluated
from game.coach.kinds.ana import Ana
from game.coach.presets import CALIBRATED, FLOODFILL, Preset
from game.coach.spec import CoachSpec
from game.journal.records import RunRecord
from game.rescuers.driver import Wait, drive
from game.rescuers.literal import LiteralReader
from game.session.playing import assemble
from game.world import load_building
from game.world.building import Building
from game.world.events import Action
from game.world.observation import Observation
from game.world.reading import parse_building
from game.world.settings import Controls, MissionSettings
from tests.coach.scripted import only
from tests.world.test_reading import drawn_buildings

REACTION_MS, MS_PER_LETTER = 400, 84
"""Silent reading at half the usual speed."""


class HalfSpeed:
    """A literal reader who reads every new text to its end first, and steps at half the pace."""

    def __init__(self, reader: LiteralReader, pace_ms: int) -> None:
        self._reader, self._pace_ms = reader, pace_ms
        self._text, self._ready_ms = "", 0

    def decide(self, observation: Observation) -> Action | Wait | None:
        text = observation.guidance.text if observation.guidance else ""
        if text != self._text:
            self._text = text
            reading_ms = REACTION_MS + MS_PER_LETTER * len(text)
            self._ready_ms = observation.time_ms + reading_ms
        if observation.time_ms < self._ready_ms:
            return Wait(self._ready_ms)
        action = self._reader.decide(observation)
        if action is not None:
            self._ready_ms = observation.time_ms + 2 * self._pace_ms
        return action


def played(
    building: Building, preset: Preset, first: Level, controls: Controls, *, slow: bool
) -> list[RunRecord]:
    rules = MissionSettings(controls=controls)
    rule = msgspec.structs.replace(preset, first_level=first)
    records: list[RunRecord] = []
    run = assemble(
        building,
        rules,
        CoachSpec("ana", preset=preset.name),
        1,
        records.extend,
        build=lambda _spec, briefing: Ana(briefing, rule),
    )
    run.begin()
    reader = LiteralReader(controls, {room.name: room.label for room in building.rooms})
    drive(run, HalfSpeed(reader, rules.pace_ms) if slow else reader)
    return records


def lowered(records: list[RunRecord]) -> list[LevelChanged]:
    return [it for it in only(LevelChanged, records) if it.after < it.before]


SCHEMES: tuple[Controls, ...] = get_args(Controls)
CASES = tuple(product(Level, SCHEMES, (False, True)))


@pytest.mark.parametrize(("first", "controls", "slow"), CASES)
@pytest.mark.parametrize("name", ["harbour", "foundry", "practice"])
def test_in_the_shipped_buildings(
    name: str, first: Level, controls: Controls, *, slow: bool
) -> None:
    records = played(load_building(name), FLOODFILL, first, controls, slow=slow)
    evaluated = [it for it in only(PosteriorEvaluated, records) if it.verdict != "none"]
    assert evaluated or name == "practice"
    assert FLOODFILL.prior_mass is not None
    assert all(it.comprehension >= FLOODFILL.prior_mass - 1e-9 for it in evaluated)
    assert not only(LostNoticed, records)
    assert not only(Misstep, records)
    assert not lowered(records)


@settings(max_examples=20)
@given(drawn_buildings())
def test_in_twenty_others(text: str) -> None:
    building = parse_building(text, "drawn.txt")
    for first, controls, slow in CASES:
        records = played(building, FLOODFILL, first, controls, slow=slow)
        assert not lowered(records)
        assert not only(LostNoticed, records)


def test_the_likelihood_of_single_steps_breaks_it() -> None:
    records = played(load_building("harbour"), CALIBRATED, Level.C3, "compass", slow=False)
    assert lowered(records)
