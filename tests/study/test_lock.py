"""One process per session, and taking over from another."""

from __future__ import annotations

import fcntl
import os
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path

import pytest

from game.study.lock import LOCK, SessionBusy, SessionLock, is_held, take_over

HOLDER = """
import signal, sys, time
from pathlib import Path
from game.study.lock import SessionLock
if sys.argv[2] == "deaf":
    signal.signal(signal.SIGTERM, signal.SIG_IGN)
lock = SessionLock(Path(sys.argv[1]))
print("held", flush=True)
time.sleep(60)
"""


def holder(home: Path, kind: str) -> subprocess.Popen[bytes]:
    process = subprocess.Popen(
        [sys.executable, "-c", HOLDER, str(home), kind], stdout=subprocess.PIPE
    )
    assert process.stdout is not None
    assert process.stdout.readline() == b"held\n"
    return process


def test_a_second_process_is_told_who_holds_the_lock(tmp_path: Path) -> None:
    process = holder(tmp_path, "polite")
    try:
        with pytest.raises(SessionBusy, match="another window") as told:
            SessionLock(tmp_path)
        assert told.value.pid == process.pid
        assert told.value.silent_ms < 60_000
    finally:
        process.kill()
        process.wait()


@pytest.mark.parametrize(
    ("kind", "ended_by"), [("polite", signal.SIGTERM), ("deaf", signal.SIGKILL)]
)
def test_taking_over_ends_the_other(
    tmp_path: Path, kind: str, ended_by: signal.Signals, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("game.study.lock.TAKEOVER_S", 0.5)
    process = holder(tmp_path, kind)
    lock = take_over(tmp_path)
    assert process.wait(5) == -ended_by
    with pytest.raises(SessionBusy) as told:
        SessionLock(tmp_path)
    assert told.value.pid == os.getpid()
    lock.release()


def test_the_lock_file_of_a_dead_process_blocks_nobody(tmp_path: Path) -> None:
    process = holder(tmp_path, "polite")
    process.kill()
    process.wait()
    assert (tmp_path / LOCK).read_text().strip() == str(process.pid)
    began = time.monotonic()
    take_over(tmp_path).release()
    SessionLock(tmp_path).release()
    assert time.monotonic() - began < 1


def test_a_pid_in_a_lock_that_nobody_holds_is_not_touched(tmp_path: Path) -> None:
    bystander = subprocess.Popen([sys.executable, "-c", "input()"], stdin=subprocess.PIPE)
    (tmp_path / LOCK).write_text(f"{bystander.pid}\n")
    take_over(tmp_path).release()
    assert bystander.poll() is None
    bystander.communicate(b"\n")
    assert bystander.returncode == 0


def test_the_kernel_decides_whether_a_session_is_open(tmp_path: Path) -> None:
    assert not is_held(tmp_path)
    process = holder(tmp_path, "polite")
    (tmp_path / LOCK).write_text("")
    assert is_held(tmp_path)
    process.kill()
    process.wait()
    (tmp_path / LOCK).write_text(f"{os.getpid()}\n")
    assert not is_held(tmp_path)


def test_a_look_at_the_lock_keeps_nobody_out(tmp_path: Path) -> None:
    SessionLock(tmp_path).release()
    with (tmp_path / LOCK).open("rb") as file:
        fcntl.flock(file, fcntl.LOCK_SH)
        threading.Timer(0.03, fcntl.flock, (file.fileno(), fcntl.LOCK_UN)).start()
        SessionLock(tmp_path).release()


def test_every_folder_made_for_a_session_is_private(tmp_path: Path) -> None:
    before = os.umask(0)
    try:
        SessionLock(tmp_path / "sessions" / "live" / "P01").release()
    finally:
        os.umask(before)
    made = [path for path in tmp_path.rglob("*") if path.is_dir()]
    assert [path.stat().st_mode & 0o777 for path in made] == [0o700] * 3
    lock = tmp_path / "sessions" / "live" / "P01" / LOCK
    assert lock.stat().st_mode & 0o777 == 0o600
