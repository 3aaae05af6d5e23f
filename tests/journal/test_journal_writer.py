"""Writing a journal: what is on disk, when, and who can read it."""

import fcntl
import os
import stat
import threading
from pathlib import Path

import pytest

from game.journal import sink as sink_module
from game.journal.clock import Reading, VirtualClock
from game.journal.journal_error import JournalError
from game.journal.reader import read_journal
from game.journal.records import (
    Interruption,
    MissionAbandoned,
    MissionStarted,
    Paused,
    PhaseStarted,
    QuizAnswer,
    Resumed,
    SessionEnded,
    SessionStarted,
    Terminal,
    Unpaused,
)
from game.journal.writer import Journal
from game.session.playing import begin_mission, end_free_play, start_free_play, start_in_memory
from game.session.run import MissionRun
from game.session.verification import verify
from game.world.events import Action
from tests.session.toy import HUT, SETTINGS, SPEC, WALK, opening, played, press, toy

TERMINAL = Terminal("xterm-256color", "truecolor", 120, 40)


class FakeClock:
    def __init__(self) -> None:
        self.now = Reading(0, 0, 1_700_000_000_000)

    def read(self) -> Reading:
        return self.now


def free_play(folder: Path) -> tuple[MissionRun, Journal, Path]:
    run, journal = start_free_play(HUT, SETTINGS, SPEC, 7, folder, TERMINAL, build=toy)
    (path,) = folder.glob("*/journal.jsonl")
    return run, journal, path


def test_free_play_gets_a_folder_of_its_own_that_others_cannot_read(tmp_path: Path) -> None:
    folder = tmp_path / "deep" / "log"
    _, journal, path = free_play(folder)
    journal.close()
    assert stat.S_IMODE(path.stat().st_mode) == 0o600
    for made in (path.parent, folder, folder.parent):
        assert stat.S_IMODE(made.stat().st_mode) == 0o700


def test_the_first_records_hold_everything_that_determines_the_mission(tmp_path: Path) -> None:
    _, journal, path = free_play(tmp_path)
    journal.close()
    started, mission = (entry.record for entry in read_journal(path).entries[:2])
    assert isinstance(started, SessionStarted)
    assert started.terminal == TERMINAL
    assert started.session == path.parent.name
    assert started.versions.textual.split(".")[0].isdecimal()
    assert (started.mode, started.simulated, started.rescuer) == ("free_play", False, "person")
    assert isinstance(mission, MissionStarted)
    assert mission.building_text == HUT.text
    assert mission.building_sha256 == HUT.hash
    assert (mission.coach, mission.preset, mission.settings) == (SPEC, None, SETTINGS)


def test_the_operating_system_has_an_action_once_its_key_is_handled(
    tmp_path: Path,
) -> None:
    run, journal, path = free_play(tmp_path)
    for number, action in enumerate((Action.EAST, Action.NORTH, Action.TRIAGE), start=1):
        run.press(action, 400 * number)
        assert path.read_bytes().count(b'"type":"acted"') == number
        assert path.read_bytes().endswith(b"\n")
    journal.close()


def test_another_thread_syncs_the_disk_within_a_second(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    synced = threading.Event()
    threads = []

    def fsync(_: int) -> None:
        threads.append(threading.current_thread())
        synced.set()

    monkeypatch.setattr(os, "fsync", fsync)
    run, journal, _ = free_play(tmp_path)
    run.press(Action.EAST, 100)
    assert synced.wait(1.0)
    assert threading.current_thread() not in threads
    journal.close()


async def test_waiting_for_the_disk_happens_off_the_event_loop(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    threads = []
    monkeypatch.setattr(os, "fsync", lambda _: threads.append(threading.get_ident()))
    monkeypatch.setattr(sink_module, "SYNC_AFTER_S", 60)
    _, journal, _ = free_play(tmp_path)
    assert not journal.awaits_disk
    journal.append(QuizAnswer("Stube", "Küche", correct=False, response_ms=900))
    assert journal.awaits_disk
    assert not threads
    await journal.wait_durable()
    assert threads
    assert threading.get_ident() not in threads
    assert not journal.awaits_disk
    journal.close()


def test_a_rescue_waits_for_the_disk_and_a_step_does_not(tmp_path: Path) -> None:
    run, journal, _ = free_play(tmp_path)
    run.press(Action.TRIAGE, 0)
    run.advance(2_999)
    assert not journal.awaits_disk
    run.advance(3_000)
    assert journal.awaits_disk
    journal.flush_durably()
    assert not journal.awaits_disk
    journal.close()


def test_the_end_of_a_session_records_its_reason(tmp_path: Path) -> None:
    run, journal, path = free_play(tmp_path)
    run.press(Action.EAST, 100)
    journal.append(Paused(150))
    journal.append(Unpaused(150))
    journal.interrupt("SIGHUP")
    end_free_play(run, journal, 250)
    journal.close()
    *_, abandoned, ended = (entry.record for entry in read_journal(path).entries)
    assert abandoned == MissionAbandoned(250, "quit")
    assert ended == SessionEnded("quit")
    assert verify(path, build=toy).reproduced


def test_a_mission_played_to_its_end_is_finished(tmp_path: Path) -> None:
    run, journal, path = free_play(tmp_path)
    end_free_play(run, journal, SETTINGS.duration_ms)
    assert read_journal(path).entries[-1].record == SessionEnded("finished")
    assert verify(path, build=toy).reproduced


def test_two_processes_cannot_write_one_journal(tmp_path: Path) -> None:
    path = tmp_path / "journal.jsonl"
    journal = Journal.create(path, opening())
    with pytest.raises(JournalError, match="another process is writing this journal"):
        Journal.resume(path, None)
    journal.close()
    Journal.resume(path, None).close()


def test_a_journal_is_never_begun_twice(tmp_path: Path) -> None:
    path = tmp_path / "journal.jsonl"
    Journal.create(path, opening()).close()
    with pytest.raises(JournalError, match="there is already a journal"):
        Journal.create(path, opening())
    with path.open("rb") as file:
        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)


def test_a_file_without_a_complete_line_is_overwritten(tmp_path: Path) -> None:
    path = tmp_path / "journal.jsonl"
    path.write_bytes(b'{"seq":0,"segm')
    Journal.create(path, opening()).close()
    assert [entry.record for entry in read_journal(path).entries] == [opening()]


def test_resuming_continues_where_the_session_broke_off(tmp_path: Path) -> None:
    path = tmp_path / "journal.jsonl"
    journal = Journal.create(path, opening())
    journal.enter("label", 2)
    journal.append(PhaseStarted(left_ms=240_000))
    journal.close()
    with path.open("ab") as file:
        file.write('{"seq":2,"text":"Kü'.encode()[:-1])
    torn = len('{"seq":2,"text":"Kü'.encode()) - 1
    journal = Journal.resume(path, TERMINAL)
    journal.append(PhaseStarted(left_ms=90_000, continued=True))
    journal.close()
    *_, resumed, last = read_journal(path).entries
    assert isinstance(resumed.record, Resumed)
    assert resumed.record.torn_bytes == torn
    assert resumed.record.terminal == TERMINAL
    assert [entry.envelope.seq for entry in (resumed, last)] == [2, 3]
    assert (last.envelope.segment, last.envelope.phase, last.envelope.round) == (1, "label", 2)
    assert resumed.envelope.t_ms < 1_000


def test_a_missing_journal_cannot_be_resumed(tmp_path: Path) -> None:
    path = tmp_path / "journal.jsonl"
    with pytest.raises(JournalError, match="No such file"):
        Journal.resume(path, None)
    assert not path.exists()


def test_a_clean_end_is_resumed_without_a_torn_line(tmp_path: Path) -> None:
    path = tmp_path / "journal.jsonl"
    Journal.create(path, opening()).close()
    Journal.resume(path, None).close()
    last = read_journal(path).entries[-1].record
    assert isinstance(last, Resumed)
    assert last.torn_bytes == 0
    assert path.read_bytes().count(b"\n") == 2


def test_sleep_of_the_machine_is_recorded_between_two_records(tmp_path: Path) -> None:
    clock = FakeClock()
    path = tmp_path / "journal.jsonl"
    journal = Journal.create(path, opening(), clock)
    clock.now = Reading(1_000, 90_000, 1_700_000_091_000)
    journal.append(Paused(1_000))
    journal.append(Unpaused(1_000))
    journal.close()
    records = [entry.record for entry in read_journal(path).entries[1:]]
    slept = Interruption("suspended", jump_ms=90_000)
    assert records == [slept, Paused(1_000), Unpaused(1_000)]


def test_steady_time_continues_when_the_wall_clock_is_set_back(tmp_path: Path) -> None:
    clock = FakeClock()
    path = tmp_path / "journal.jsonl"
    journal = Journal.create(path, opening(), clock)
    clock.now = Reading(5, 0, 1_700_000_000_000 - 3_600_000)
    journal.append(Paused(5))
    journal.close()
    step, paused = read_journal(path).entries[1:]
    assert step.record == Interruption("clock_step", jump_ms=-3_600_005)
    assert (paused.envelope.t_ms, paused.envelope.utc) == (5, "2023-11-14T21:13:20.000Z")


def test_a_simulated_session_is_the_same_journal_written_at_once(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    synced: list[int] = []
    monkeypatch.setattr(os, "fsync", synced.append)
    paths = [tmp_path / name / "journal.jsonl" for name in "ab"]
    for path in paths:
        clock = VirtualClock()
        journal = Journal.buffered(path, opening(), clock)
        run = begin_mission(journal, HUT, SETTINGS, SPEC, 7, build=toy)
        press(run, clock, WALK)
        clock.now_ms = SETTINGS.duration_ms
        assert not path.exists()
        end_free_play(run, journal, clock.now_ms)
        journal.close()
    assert paths[0].read_bytes() == paths[1].read_bytes() == played()
    assert len(synced) == 2 * len(paths), "one for the file and one for its name"
    with pytest.raises(JournalError, match="there is already a journal"):
        Journal.buffered(paths[0], opening(), VirtualClock()).close()


def test_a_journal_in_memory_leaves_nothing_on_the_disk(tmp_path: Path) -> None:
    os.chdir(tmp_path)
    run, journal = start_in_memory(HUT, SETTINGS, SPEC, 7, rescuer="keys", build=toy)
    end_free_play(run, journal, SETTINGS.duration_ms)
    assert list(tmp_path.iterdir()) == []
