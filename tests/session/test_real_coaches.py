"""Missions with every shipped coach are reproduced and replayed, under both control schemes."""

from collections.abc import Sequence
from random import Random
from typing import get_args

import pytest

from game.coach.acts import CoachRecord, Level
from game.coach.instructions.phrasebook import Phrasebook
from game.coach.presets import PRESETS
from game.coach.spec import CoachSpec
from game.journal.clock import VirtualClock
from game.journal.sink import MemorySink
from game.journal.writer import Journal
from game.session.playing import begin_mission, end_free_play
from game.session.replay import Replay
from game.session.verification import verify_transcript
from game.world import library
from game.world.events import Action
from game.world.observation import Observation
from game.world.settings import Controls, MissionSettings
from tests.session.toy import COMPASS, TURN, opening, transcript

SPECS = (
    *(CoachSpec("ana", preset=name) for name in PRESETS),
    *(CoachSpec("static", level=level) for level in Level),
    CoachSpec("pace", level=Level.C2),
    CoachSpec("knowledge"),
)


def wandered(
    spec: CoachSpec,
    controls: Controls,
    seconds: int,
    building: str,
    phrases: Phrasebook | None = None,
) -> tuple[bytes, list[tuple[int, Observation]]]:
    """The journal of an aimless walk, and what was seen at some moments of it."""
    random = Random(f"{spec} {controls}")
    settings = MissionSettings(
        duration_ms=1_000 * seconds, red_expiry_ms=700 * seconds, controls=controls
    )
    sink, clock = MemorySink(), VirtualClock()
    journal = Journal(sink, clock)
    journal.append(opening(settings))
    run = begin_mission(
        journal, library.load_building(building), settings, spec, 3, phrases=phrases
    )
    actions: Sequence[Action] = COMPASS if controls == "compass" else TURN
    seen = []
    action = random.choice(actions)
    while not run.ended:
        clock.now_ms += random.randrange(20, 500)
        if random.random() < 0.4:
            action = random.choice(actions)
        run.press(action, clock.now_ms)
        if random.random() < 0.1 and not run.ended:
            seen.append((clock.now_ms, run.observation()))
    end_free_play(run, journal, clock.now_ms)
    return bytes(sink.data), seen


@pytest.mark.parametrize("controls", get_args(Controls))
@pytest.mark.parametrize("spec", SPECS, ids=lambda spec: f"{spec.kind}-{spec.preset or spec.level}")
def test_a_walk_is_reproduced_and_replayed(spec: CoachSpec, controls: Controls) -> None:
    data, seen = wandered(spec, controls, 40, "practice")
    journal = transcript(data)
    outcome = verify_transcript(journal)
    assert outcome.difference is None
    assert any(isinstance(entry.record, CoachRecord) for entry in journal.entries)
    replay = Replay(journal)
    for moment, observation in [*seen, *reversed(seen)]:
        replay.seek(moment)
        assert replay.observation() == observation


@pytest.mark.slow
@pytest.mark.parametrize("building", library.shipped_buildings())
@pytest.mark.parametrize("controls", get_args(Controls))
@pytest.mark.parametrize("spec", SPECS, ids=lambda spec: f"{spec.kind}-{spec.preset or spec.level}")
def test_whole_missions_are_reproduced_and_replayed(
    spec: CoachSpec, controls: Controls, building: str
) -> None:
    data, _ = wandered(spec, controls, 240, building)
    assert verify_transcript(transcript(data)).difference is None
