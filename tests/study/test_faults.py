"""What a session survives: a kill, a full disk, a clock set back, a torn journal."""

from __future__ import annotations

import signal
import subprocess
import sys
from pathlib import Path
from random import Random

import pytest

from game.errors import AnaError
from game.journal.clock import Reading, VirtualClock
from game.journal.history import Step, history_of
from game.journal.reader import Entry
from game.journal.records import (
    Interruption,
    PhaseEnded,
    QuestionnaireAnswer,
    QuizAnswer,
    Resumed,
    SessionEnded,
)
from game.session.verification import verify
from game.study.folder import Study
from game.study.lab.attendance import Attendance
from game.study.ledger import LedgerError
from game.study.protocol.timeline import next_point
from tests.disks import files_no_longer_than
from tests.study.people import P01, journal_of, small_study, take_part

ROOT = Path(__file__).resolve().parents[2]
HOUR_MS = 3_600_000
QUICK_KILLS = 4
KILLS = 200
MOMENTS = 372
"""How many things a participant does in a session of `small_study`."""

TAKER = """
import sys
from pathlib import Path
from game.study.folder import open_study
from tests.study.people import QuickSink, take_part

lines = 0

class Counting(QuickSink):
    def write(self, data):
        global lines
        super().write(data)
        lines += data.count(b"\\n")

def shown(_):
    print(lines, flush=True)

take_part(open_study(Path(sys.argv[1])), sink=Counting.begin, moment=shown)
"""
"""Reports, before each thing the participant does, how many lines were written before it:
everything they then see or have answered is in these lines."""


def killed_after(study: Study, moments: int) -> int:
    """Kill a session with SIGKILL once its participant has done `moments` things; returns how many
    lines of its journal had been reported by then."""
    process = subprocess.Popen(
        [sys.executable, "-c", TAKER, str(study.folder)], stdout=subprocess.PIPE, cwd=ROOT
    )
    assert process.stdout is not None
    told = [process.stdout.readline() for _ in range(moments)]
    process.kill()
    told += process.stdout.readlines()
    process.stdout.close()
    assert process.wait() in (-signal.SIGKILL, 0)
    return max((int(line) for line in told if line.endswith(b"\n")), default=0)


def survived(study: Study) -> tuple[Entry, ...]:
    """The entries of the journal; none if the session had not reached consent."""
    path = study.home(P01) / "journal.jsonl"
    return journal_of(study).entries if path.exists() and b"\n" in path.read_bytes() else ()


def comes_back(study: Study, before: tuple[Entry, ...]) -> None:
    """Continue after a fault that left `before`: at the right place, losing nothing, to the end."""
    expected = next_point(
        history_of((entry.envelope, entry.record) for entry in before),
        study.settings,
        study.course,
    )
    assert take_part(study)[0] == "over"
    entries = journal_of(study).entries
    assert entries[: len(before)] == before
    assert entries[-1].record == SessionEnded("finished")
    ended = [
        Step(entry.envelope.phase, entry.envelope.round)
        for entry in entries
        if isinstance(entry.record, PhaseEnded)
    ]
    assert ended == list(study.course)
    if before and not isinstance(before[-1].record, SessionEnded):
        assert isinstance(entries[len(before)].record, Resumed)
        following = [e for e in entries[len(before) :] if e.envelope.phase != "session"]
        settled = [step for step, _ in expected.settle]
        if expected.step is not None:
            after = next(
                step
                for entry in following
                if (step := Step(entry.envelope.phase, entry.envelope.round)) not in settled
                and not isinstance(entry.record, Resumed)
            )
            assert after == expected.step
    assert not repeated_answers(entries)
    assert verify(study.home(P01) / "journal.jsonl").difference is None


def repeated_answers(entries: tuple[Entry, ...]) -> list[tuple[Step, str]]:
    """Questions and rooms that were asked again although they had been answered."""
    asked = [
        (Step(entry.envelope.phase, entry.envelope.round), name)
        for entry in entries
        if (name := _asked(entry)) is not None
    ]
    return [question for number, question in enumerate(asked) if question in asked[:number]]


def _asked(entry: Entry) -> str | None:
    match entry.record:
        case QuestionnaireAnswer(item=item):
            return item
        case QuizAnswer(room=room):
            return None if entry.envelope.segment else room
        case _:
            return None


def kill_and_come_back(folder: Path, number: int) -> None:
    study = small_study(folder / "study")
    told = killed_after(study, Random(number).randint(1, MOMENTS))
    before = survived(study)
    assert len(before) >= told
    comes_back(study, before)


@pytest.mark.parametrize("number", range(QUICK_KILLS))
def test_killed_at_a_random_moment(tmp_path: Path, number: int) -> None:
    kill_and_come_back(tmp_path, number)


@pytest.mark.slow
@pytest.mark.parametrize("number", range(QUICK_KILLS, KILLS))
def test_killed_at_two_hundred_random_moments(tmp_path: Path, number: int) -> None:
    kill_and_come_back(tmp_path, number)


@pytest.mark.parametrize("share", [0.1, 0.5, 0.93])
def test_a_full_disk_stops_the_session_which_continues_when_there_is_space(
    tmp_path: Path, finished: Study, share: float
) -> None:
    study = small_study(tmp_path / "study")
    size = round(share * (finished.home(P01) / "journal.jsonl").stat().st_size)
    with files_no_longer_than(size), pytest.raises(AnaError, match="the disk is full"):
        take_part(study)
    assert (study.home(P01) / "journal.jsonl").stat().st_size == size
    comes_back(study, survived(study))


def test_a_full_disk_gives_out_no_place(tmp_path: Path) -> None:
    study = small_study(tmp_path / "study")
    ledger = study.ledger
    size = ledger.path.stat().st_size
    for room in (0, 1, 40):
        with files_no_longer_than(size + room), pytest.raises(LedgerError, match="disk is full"):
            ledger.allocate("P01", "live")
        assert len(ledger.entries()) == 1
    assert ledger.allocate("P02", "live").slot == 0
    assert len(ledger.entries()) == 2


class SetBack(VirtualClock):
    """A clock whose wall time is set back an hour after `after_ms`."""

    def __init__(self, after_ms: int) -> None:
        super().__init__()
        self.after_ms = after_ms

    def read(self) -> Reading:
        now = super().read()
        set_ms = HOUR_MS if self.now_ms >= self.after_ms else 0
        return now._replace(utc_ms=now.utc_ms - set_ms)


@pytest.mark.parametrize("after_ms", [20_000, 60_000, 100_000])
def test_a_clock_set_back_an_hour_changes_no_time_that_counts(
    tmp_path: Path, finished: Study, after_ms: int
) -> None:
    study = small_study(tmp_path / "study")
    assert take_part(study, clock=SetBack(after_ms))[0] == "over"
    records = [entry.record for entry in journal_of(study).entries]
    steps = [record for record in records if isinstance(record, Interruption)]
    assert steps == [Interruption("clock_step", jump_ms=-HOUR_MS)]
    records.remove(steps[0])
    assert records[1:] == [entry.record for entry in journal_of(finished).entries][1:]
    assert verify(study.home(P01) / "journal.jsonl").difference is None
    (status,) = Attendance(study.folder).look(study.settings)
    assert (status.state, status.interruptions) == ("finished", 0)
    assert status.silent_s is not None
    assert status.silent_s >= 0


def test_a_session_can_continue_an_hour_before_it_began(tmp_path: Path) -> None:
    study = small_study(tmp_path / "study")

    class Cut(Exception):
        pass

    def cut(what: str) -> None:
        if what == "label":
            raise Cut

    with pytest.raises(Cut):
        take_part(study, moment=cut)
    before = survived(study)
    assert take_part(study, clock=SetBack(0))[0] == "over"
    entries = journal_of(study).entries
    assert entries[: len(before)] == before
    assert entries[len(before)].envelope.utc < before[-1].envelope.utc
    assert not repeated_answers(entries)
    assert verify(study.home(P01) / "journal.jsonl").difference is None


@pytest.mark.parametrize("tail", [b"\0" * 512, b'{"seq":9,"type":"pha', b"\xff\xfe"])
def test_a_torn_journal_continues_from_its_last_complete_line(
    tmp_path: Path, finished: Study, tail: bytes
) -> None:
    study = small_study(tmp_path / "study")
    lines = (finished.home(P01) / "journal.jsonl").read_bytes().splitlines(keepends=True)
    home = study.home(P01)
    home.mkdir(parents=True)
    (home / "journal.jsonl").write_bytes(b"".join(lines[: len(lines) // 2]) + tail)
    before = survived(study)
    assert len(before) == len(lines) // 2
    comes_back(study, before)
    resumed = [e.record for e in journal_of(study).entries if isinstance(e.record, Resumed)]
    assert [record.torn_bytes for record in resumed] == [len(tail)]
