"""The history of a journal: how each mission ends, its levels, and what belongs to none."""

from __future__ import annotations

from game.coach.acts import Level, LevelChanged
from game.coach.spec import CoachSpec
from game.journal.history import History, LevelSpan
from game.journal.records import (
    Envelope,
    MissionAbandoned,
    Record,
    Resumed,
    SessionEnded,
    Versions,
)
from game.session.playing import mission_started
from game.world.events import MissionEnded
from tests.session.toy import HUT, SETTINGS

STARTED = mission_started(HUT, SETTINGS, CoachSpec("static", level=Level.C1), 7)
RESUMED = Resumed(torn_bytes=0, versions=Versions("0.1.0", 1, "3.11"), terminal=None)
DOWN = LevelChanged(500, Level.C3, Level.C2)
ENDED = MissionEnded(1_000, rescued=0)
UP = LevelChanged(900, Level.C2, Level.C3, 0.9)


def told(*records: Record) -> History:
    history = History()
    for line, record in enumerate(records, start=1):
        history.note(Envelope(line, 0, 0, "", "mission", 1), record, line)
    return history


def test_each_way_a_mission_can_end_is_distinguished() -> None:
    history = told(
        *(STARTED, DOWN, ENDED, STARTED, DOWN, MissionAbandoned(700, "quit")),
        *(STARTED, DOWN, RESUMED, STARTED, DOWN, SessionEnded("quit"), STARTED),
    )
    assert [(mission.end, mission.until_ms) for mission in history.missions] == [
        *(("ended", 1_000), ("abandoned", 700), ("cut", 500), ("dropped", 500), ("cut", 0)),
    ]
    assert [mission.line for mission in history.missions] == [1, 4, 7, 10, 13]


def test_a_record_outside_every_mission_is_a_stray() -> None:
    history = told(DOWN, STARTED, RESUMED, UP)
    assert [(stray.line, stray.record) for stray in history.strays] == [(1, DOWN), (4, UP)]


def test_a_level_can_change_without_comprehension() -> None:
    mission = told(STARTED, DOWN, UP, ENDED).missions[0]
    assert list(mission.levels()) == [
        LevelSpan(Level.C2, 500, 900, None),
        LevelSpan(Level.C3, 900, 1_000, 0.9),
    ]
