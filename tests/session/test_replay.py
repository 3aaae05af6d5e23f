"""A replay shows, at every moment, what there was when the mission was played."""

import json

import pytest
from hypothesis import given
from hypothesis import strategies as st

from game.coach.acts import Level, LevelChanged
from game.journal.journal_error import JournalError
from game.journal.records import RunRecord
from game.session import replay as replay_module
from game.session.playing import assemble
from game.session.replay import Replay
from game.session.run import MissionRun
from game.world.events import Acted, Expired, Rescued
from game.world.observation import Observation
from tests.session.toy import HUT, SETTINGS, SPEC, WALK, played, toy, transcript

MISSION = played()
END = SETTINGS.duration_ms


def live(until_ms: int) -> tuple[Observation, list[RunRecord]]:
    """What the player saw at `until_ms`, and everything that had happened."""
    records: list[RunRecord] = []
    run: MissionRun = assemble(HUT, SETTINGS, SPEC, 7, records.extend, build=toy)
    run.begin()
    now_ms = 0
    for wait_ms, action in WALK:
        now_ms += wait_ms
        if now_ms > until_ms:
            break
        run.press(action, now_ms)
    run.advance(until_ms)
    return run.observation(), records


@given(moments=st.lists(st.integers(-500, END + 500), min_size=1, max_size=12))
def test_a_moment_looks_the_same_however_it_is_reached(moments: list[int]) -> None:
    replay = Replay(transcript(MISSION))
    for moment in moments:
        replay.seek(moment)
        assert replay.time_ms == min(max(moment, 0), END)
        observation, records = live(replay.time_ms)
        assert replay.observation() == observation
        assert replay.records == tuple(records)


def test_checkpoints_make_no_difference(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(replay_module, "CHECKPOINT_MS", 700)
    replay = Replay(transcript(MISSION))
    for moment in (20_000, 6_999, 7_000, 7_001, 100, 12_640, 12_139, 0, 3_300):
        replay.seek(moment)
        assert (replay.observation(), list(replay.records)) == live(moment)


def test_the_coachs_thoughts_are_those_of_the_moment() -> None:
    replay = Replay(transcript(MISSION))
    assert (replay.thoughts.level, replay.thoughts.goal) == (Level.C2, "v01")
    assert replay.thoughts.evaluation is None
    replay.seek(END)
    late = replay.thoughts
    assert (late.level, late.goal, late.route) == (Level.C3, "v03", ("v03",))
    assert late.evaluation is not None
    assert late.evaluation.comprehension > late.evaluation.raise_above
    assert late.instruction is not None
    assert replay.observation().guidance == late.guidance
    replay.seek(0)
    assert replay.thoughts.level is Level.C2


def test_the_timeline_marks_rescues_expiries_and_levels() -> None:
    marks = Replay(transcript(MISSION)).highlights
    assert [(type(mark), mark.at_ms) for mark in marks] == [
        (Rescued, 3_300),
        (LevelChanged, 5_600),
        (Expired, 12_500),
        (Rescued, 12_770),
    ]


def test_an_unfinished_mission_is_replayed_as_far_as_it_goes() -> None:
    lines = MISSION.splitlines(keepends=True)[:20]
    replay = Replay(transcript(b"".join(lines)))
    replay.seek(END)
    assert replay.time_ms == replay.duration_ms == json.loads(lines[-1])["at_ms"]
    assert len(replay.records) == 18


def test_a_journal_without_a_mission_is_refused() -> None:
    first = MISSION.splitlines(keepends=True)[0]
    with pytest.raises(JournalError, match="there is no mission 1: the journal holds 0"):
        Replay(transcript(first))
    with pytest.raises(JournalError, match="there is no mission 2: the journal holds 1"):
        Replay(transcript(MISSION), 1)


def test_an_impossible_action_is_named() -> None:
    edited = MISSION.replace(b'"action":"north"', b'"action":"forward"', 1)
    line = next(
        entry.line
        for entry in transcript(edited).entries
        if isinstance(entry.record, Acted) and entry.record.action == "forward"
    )
    replay = Replay(transcript(edited))
    with pytest.raises(JournalError, match=f"line {line}: this action cannot be carried out"):
        replay.seek(END)
