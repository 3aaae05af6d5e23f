"""Full disks, forbidden folders, failing disks, and processes killed at any moment."""

import errno
import os
import select
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from functools import partial
from pathlib import Path
from random import Random

import pytest

from game.journal import sink as sink_module
from game.journal.journal_error import JournalError
from game.journal.reader import first_discontinuity, parse_journal, read_journal
from game.journal.records import Paused, Resumed
from game.journal.writer import Journal
from game.session.playing import begin_mission, end_free_play, start_free_play
from game.session.verification import verify
from game.world.events import Acted, Action
from tests.disks import files_no_longer_than
from tests.session.toy import HUT, SETTINGS, SPEC, opening, toy

ROOT = Path(__file__).resolve().parents[2]


def failing(code: int) -> Callable[..., int]:
    def fail(*_: object) -> int:
        raise OSError(code, os.strerror(code))

    return fail


@pytest.mark.parametrize("room", [0, 1, 150, 400])
def test_a_full_disk_stops_the_mission_and_loses_nothing_painted(tmp_path: Path, room: int) -> None:
    path = tmp_path / "journal.jsonl"
    journal = Journal.create(path, opening())
    run = begin_mission(journal, HUT, SETTINGS, SPEC, 7, build=toy)
    painted = 0

    def play_on() -> None:
        nonlocal painted
        for at_ms in range(100, 5_000, 300):
            run.press(Action.EAST, at_ms)
            painted += 1

    told = pytest.raises(JournalError, match=f"{path}: the disk is full. Free some space")
    with files_no_longer_than(path.stat().st_size + room), told:
        play_on()
    for attempt in (partial(journal.append, Paused(1)), journal.flush_durably, journal.close):
        with pytest.raises(JournalError, match="the disk is full"):
            attempt()
    kept = path.read_bytes()
    acted = sum(isinstance(entry.record, Acted) for entry in parse_journal(kept, "").entries)
    assert painted <= acted <= painted + 1
    later = Journal.resume(path, None)
    later.append(Paused(2))
    later.close()
    *_, resumed, paused = read_journal(path).entries
    assert isinstance(resumed.record, Resumed)
    assert resumed.record.torn_bytes == len(kept) - (kept.rindex(b"\n") + 1)
    assert paused.record == Paused(2)
    assert verify(path, build=toy).reproduced


@pytest.mark.parametrize(
    ("code", "says"),
    [
        (errno.ENOSPC, "the disk is full"),
        (errno.EDQUOT, "the disk is full"),
        (errno.EIO, r"cannot be written \(Input/output error\)"),
    ],
)
def test_a_failing_write_names_the_file_and_a_hint(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, code: int, says: str
) -> None:
    path = tmp_path / "journal.jsonl"
    journal = Journal.create(path, opening())
    monkeypatch.setattr(os, "write", failing(code))
    with pytest.raises(JournalError, match=f"{path}: .*{says}"):
        journal.append(Paused(1))


def test_a_failing_disk_raises_an_error_at_the_next_record(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(sink_module, "SYNC_AFTER_S", 0.01)
    monkeypatch.setattr(os, "fsync", failing(errno.EIO))
    journal = Journal.create(tmp_path / "journal.jsonl", opening())

    def until_it_fails() -> None:
        for _ in range(500):
            journal.append(Paused(1))
            time.sleep(0.01)

    with pytest.raises(JournalError, match="Input/output error"):
        until_it_fails()
    with pytest.raises(JournalError, match="Input/output error"):
        journal.flush_durably()


@pytest.mark.parametrize("code", [errno.EACCES, errno.EROFS])
def test_an_unwritable_folder_is_reported_before_the_mission(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, code: int
) -> None:
    monkeypatch.setattr(os, "open", failing(code))
    with pytest.raises(JournalError, match=r"no permission to write .*choose another: --log DIR"):
        start_free_play(HUT, SETTINGS, SPEC, 7, tmp_path, None, build=toy)


def test_a_file_in_place_of_a_folder_is_reported_before_the_mission(tmp_path: Path) -> None:
    blocked = tmp_path / "log"
    blocked.write_text("no folder")
    with pytest.raises(JournalError, match="choose another: --log DIR"):
        start_free_play(HUT, SETTINGS, SPEC, 7, blocked, None, build=toy)


def test_a_refused_journal_is_released(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "journal.jsonl"
    with monkeypatch.context() as patch:
        patch.setattr(os, "write", failing(errno.ENOSPC))
        with pytest.raises(JournalError, match="the disk is full"):
            Journal.create(path, opening())
    Journal.create(path, opening()).close()


def test_the_end_of_a_session_on_a_full_disk_is_an_error_too(tmp_path: Path) -> None:
    run, journal = start_free_play(HUT, SETTINGS, SPEC, 7, tmp_path, None, build=toy)
    with files_no_longer_than(10), pytest.raises(JournalError, match="the disk is full"):
        end_free_play(run, journal, 100)


PLAYER = """
import os, sys
from pathlib import Path
from random import Random
from game.journal.writer import Journal
from game.session.playing import begin_mission
from game.world.events import Action
from game.world.settings import MissionSettings
from tests.session.toy import COMPASS, HUT, SPEC, opening, toy

settings = MissionSettings(duration_ms=3_000_000, red_expiry_ms=1_000_000, moves_per_second=100)
path, random = Path(sys.argv[1]), Random(int(sys.argv[2]))
journal = Journal.resume(path, None) if path.exists() else Journal.create(path, opening())
run = begin_mission(journal, HUT, settings, SPEC, 7, build=toy)
for number in range(250_000):
    run.press(random.choice(COMPASS), 10 * number)
    os.write(1, b".")
"""


def killed_after(path: Path, seed: int, wait_s: float) -> int:
    """Let a process play as fast as it can, kill it, and count the actions it acknowledged."""
    command = [sys.executable, "-c", PLAYER, str(path), str(seed)]
    acknowledged = 0
    with subprocess.Popen(command, cwd=ROOT, stdout=subprocess.PIPE) as process:
        assert process.stdout is not None
        pipe = process.stdout.fileno()
        deadline = None
        while deadline is None or time.monotonic() < deadline:
            select.select([pipe], [], [], 30)
            acknowledged += len(os.read(pipe, 1 << 16))
            deadline = deadline or time.monotonic() + wait_s
        process.send_signal(signal.SIGKILL)
        acknowledged += len(process.stdout.read())
    return acknowledged


def check_kills(folder: Path, seed: int, kills: int) -> None:
    random = Random(seed)
    path = folder / "journal.jsonl"
    kept = 0
    for kill in range(kills):
        kept += killed_after(path, seed + kill, random.uniform(0, 0.05))
        entries = parse_journal(path.read_bytes(), str(path)).entries
        assert first_discontinuity(entries) is None
        acted = sum(isinstance(entry.record, Acted) for entry in entries)
        assert kept <= acted <= kept + kill + 1, "at most the one being written is unacknowledged"
        kept = acted
    assert verify(path, build=toy).reproduced
    assert verify(path, build=toy).missions == kills


def test_what_was_acknowledged_before_a_kill_is_in_the_journal(tmp_path: Path) -> None:
    check_kills(tmp_path, seed=1, kills=4)


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(10))
def test_what_was_acknowledged_is_kept_at_two_hundred_moments(tmp_path: Path, seed: int) -> None:
    check_kills(tmp_path, seed=100 * seed, kills=20)
