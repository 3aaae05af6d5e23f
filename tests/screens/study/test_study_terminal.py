"""The real program in a real terminal: killed, hung up, and asked for things it must not do."""

from __future__ import annotations

import contextlib
import fcntl
import os
import pty
import select
import signal
import struct
import subprocess
import sys
import termios
import time
from collections.abc import Callable, Iterator

import pytest

from game.journal.history import Step
from game.journal.reader import Entry
from game.journal.records import (
    Exposed,
    Interruption,
    PhaseEnded,
    PhaseStarted,
    Resumed,
    SessionEnded,
)
from game.study.folder import Study
from tests.study.people import journal_of, rewind

FROM_THE_KEYBOARD = b"\x03n\x04\x1a\x1c\x10\x11n"
"""Ctrl+C and no, Ctrl+D, Ctrl+Z, Ctrl+backslash, Ctrl+P, Ctrl+Q and no."""

AT_ITS_OWN_TERMINAL = (
    "import fcntl, os, sys, termios; fcntl.ioctl(0, termios.TIOCSCTTY, 0);"
    "os.execv(sys.executable, [sys.executable, *sys.argv[1:]])"
)


class Terminal:
    """`ana study run` in a pty of the study's size."""

    def __init__(self, study: Study) -> None:
        self.master, slave = pty.openpty()
        fcntl.ioctl(slave, termios.TIOCSWINSZ, struct.pack("HHHH", 40, 120, 0, 0))
        command = ["study", "run", str(study.folder), "--participant", "P01", "--pilot"]
        told = {name: os.environ[name] for name in os.environ if name not in ("LINES", "COLUMNS")}
        self.process = subprocess.Popen(
            [sys.executable, "-c", AT_ITS_OWN_TERMINAL, "-m", "game", *command],
            stdin=slave,
            stdout=slave,
            stderr=slave,
            env={**told, "TERM": "xterm-256color"},
            start_new_session=True,
        )
        os.close(slave)
        self.output = b""

    def press(self, keys: bytes) -> None:
        os.write(self.master, keys)

    def read_for(self, seconds: float) -> None:
        until = time.monotonic() + seconds
        while (left := until - time.monotonic()) > 0:
            if not select.select([self.master], [], [], left)[0]:
                return
            try:
                self.output += os.read(self.master, 65536)
            except OSError:
                return

    def until(self, ready: Callable[[], bool], limit_s: float = 30) -> None:
        end = time.monotonic() + limit_s
        while not ready():
            assert time.monotonic() < end, self.output[-3000:].decode(errors="replace")
            self.read_for(0.05)

    def enter_until(self, ready: Callable[[], bool]) -> None:
        """Press Enter repeatedly until `ready`: a new page ignores keys for a moment."""

        def pressed() -> bool:
            self.press(b"\r")
            self.read_for(0.2)
            return ready()

        self.until(pressed)

    def close(self) -> None:
        with contextlib.suppress(ProcessLookupError):
            self.process.kill()
        self.process.wait()
        os.close(self.master)


@pytest.fixture
def opened(study: Study) -> Iterator[Callable[[], Terminal]]:
    terminals: list[Terminal] = []

    def open_one() -> Terminal:
        terminals.append(Terminal(study))
        return terminals[-1]

    yield open_one
    for terminal in terminals:
        terminal.close()


def newest(study: Study, kind: type, segment: int) -> list[Entry]:
    return [
        entry
        for entry in journal_of(study).entries
        if isinstance(entry.record, kind) and entry.envelope.segment == segment
    ]


@pytest.mark.long
def test_killed_while_memorising_and_back(study: Study, opened: Callable[[], Terminal]) -> None:
    rewind(study, Step("memorise", 1))
    first = opened()
    first.until(lambda: b"Memorise the map" in first.output)
    first.enter_until(lambda: bool(newest(study, Exposed, 1)))
    first.press(FROM_THE_KEYBOARD)
    first.read_for(0.3)
    assert first.process.poll() is None
    first.process.kill()
    first.process.wait()
    seen = newest(study, Exposed, 1)[-1].record
    assert isinstance(seen, Exposed)
    second = opened()
    second.until(lambda: b"Memorise the map" in second.output)
    second.enter_until(lambda: bool(newest(study, PhaseEnded, 2)))
    started = newest(study, PhaseStarted, 2)[0].record
    assert started == PhaseStarted(5_000 - seen.exposure_ms, continued=True)
    ended = newest(study, PhaseEnded, 2)[0]
    assert ended.record == PhaseEnded("completed", 5_000)
    assert isinstance(newest(study, Resumed, 2)[0].record, Resumed)


def test_hung_up_in_mid_mission_and_back(study: Study, opened: Callable[[], Terminal]) -> None:
    rewind(study, Step("mission", 1))
    first = opened()
    first.until(lambda: b"Your mission" in first.output)
    first.enter_until(lambda: bool(newest(study, Exposed, 1)))
    first.process.send_signal(signal.SIGHUP)
    first.read_for(1)
    assert first.process.wait(5) == 128 + signal.SIGHUP
    (interruption,) = newest(study, Interruption, 1)
    assert interruption.record == Interruption("hang_up", signal="SIGHUP")
    second = opened()
    second.until(lambda: bool(newest(study, PhaseStarted, 2)))
    (ended,) = newest(study, PhaseEnded, 2)
    assert isinstance(ended.record, PhaseEnded)
    assert ended.record.ending == "interrupted"
    assert ended.record.exposure_ms >= 1000
    assert newest(study, PhaseStarted, 2)[0].envelope.phase == "sliders"
    assert not newest(study, SessionEnded, 1)


def test_no_key_leads_out_before_the_screens_are_up(
    study: Study, opened: Callable[[], Terminal]
) -> None:
    rewind(study, Step("sliders", 1))
    terminal = opened()
    time.sleep(0.4)
    for _ in range(6):
        terminal.press(b"\x1a\x1c\x04")
        terminal.read_for(0.15)
    terminal.until(lambda: b"How was it?" in terminal.output)
    assert terminal.process.poll() is None


def test_without_a_terminal_it_says_so(study: Study) -> None:
    run = subprocess.run(
        [sys.executable, "-m", "game", "study", "run", str(study.folder), "--participant", "P02"],
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
        check=False,
    )
    assert run.returncode == 2
    assert "not a terminal" in run.stderr
    assert "Traceback" not in run.stderr
