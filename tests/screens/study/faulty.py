"""`ana study run` at a terminal, in which something of ours fails at a random moment."""

from __future__ import annotations

import os
import pty
import select
import signal
import struct
import sys
import time
from collections import Counter
from contextlib import suppress
from fcntl import ioctl
from inspect import CO_COROUTINE, CO_GENERATOR
from pathlib import Path
from random import Random
from termios import TIOCSWINSZ
from types import CodeType, FrameType
from typing import Any, NamedTuple

import game
from game.study.folder import Study
from tests.study.people import P01

HOME = str(Path(game.__file__).parent)
COUNTED = ("/screens/", "/study/", "/journal/", "/session/")
"""Where faults are raised: not in what is called a thousand times a second, and is called by this.
"""
SPARED = ("/program.py", "/fault.py", "/sink.py")
"""What handles faults, and what writes down that there was one."""
OFTEN = 4
"""How many calls of one function count."""
KEYS = (
    b"\r",
    b"\r",
    b"\r",
    b"1",
    b"3",
    b"7",
    b"\x1b[A",
    b"\x1b[B",
    b"\x1b[C",
    b" ",
    b"x",
    b"\x1b[6~",
)
PATIENCE_S = 5.0
"""Random keys may never lead to the fault."""


class Outcome(NamedTuple):
    """What came of it. `place` is where the fault was raised, empty if that was not reached in
    time; then the program was killed."""

    place: str
    status: int
    output: bytes


def fail_after(calls: int, tell: int) -> None:
    """Raise an error at the beginning of the `calls`-th function of ours that is called from now
    on, and write its name to the descriptor `tell`."""
    left, often, begun = calls, Counter[CodeType](), set[int]()

    def watch(frame: FrameType, event: str, _: Any) -> None:
        nonlocal left
        path = frame.f_code.co_filename
        if event != "call" or not path.startswith(HOME) or frame.f_code.co_flags & CO_GENERATOR:
            return  # a generator may be called by its own end, where nothing can be raised
        if frame.f_code.co_flags & CO_COROUTINE:
            if id(frame) in begun:
                return  # it goes on, and what it waits for would be left behind
            begun.add(id(frame))
        if path.endswith(SPARED) or not path.removeprefix(HOME).startswith(COUNTED):
            return
        often[frame.f_code] += 1
        left -= often[frame.f_code] <= OFTEN
        if left == 0:
            sys.setprofile(None)
            os.write(tell, f"{path.removeprefix(HOME)} {frame.f_code.co_qualname}".encode())
            raise ZeroDivisionError("a fault")

    sys.setprofile(watch)


def run_with_fault(study: Study, calls: int, seed: int) -> Outcome:
    """Take part with random keys, until the program has ended."""
    told, tell = os.pipe()
    pid, terminal = pty.fork()
    if pid == 0:
        _take_part(study, calls, tell)
    os.close(tell)
    ioctl(terminal, TIOCSWINSZ, struct.pack("HHHH", 40, 120, 0, 0))
    random, output, end = Random(seed), b"", time.monotonic() + PATIENCE_S
    status, place = None, ""
    while status is None and time.monotonic() < end:
        if not place and select.select([told], [], [], 0)[0]:
            place, end = os.read(told, 1_000).decode(), time.monotonic() + 2 * PATIENCE_S
        if select.select([terminal], [], [], 0.02)[0]:
            with suppress(OSError):
                output += os.read(terminal, 1 << 16)
        else:
            with suppress(OSError):
                os.write(terminal, random.choice(KEYS))
        ended, code = os.waitpid(pid, os.WNOHANG)
        status = os.waitstatus_to_exitcode(code) if ended else None
    if status is None:
        os.kill(pid, signal.SIGKILL)
        os.waitpid(pid, 0)
    else:
        with suppress(OSError):
            while select.select([terminal], [], [], 0.1)[0]:
                output += os.read(terminal, 1 << 16)
    place = place or os.read(told, 1_000).decode()
    os.close(told)
    os.close(terminal)
    return Outcome(place, -signal.SIGKILL if status is None else status, output)


def _take_part(study: Study, calls: int, tell: int) -> None:
    from game.cli import main

    sys.stdin, sys.stdout, sys.stderr = sys.__stdin__, sys.__stdout__, sys.__stderr__
    os.environ["TERM"] = "xterm-256color"
    for name in ("LINES", "COLUMNS"):
        os.environ.pop(name, None)
    status = 99
    try:
        time.sleep(0.05)
        fail_after(calls, tell)
        status = main(
            ["study", "run", str(study.folder), "--participant", P01.participant, "--pilot"]
        )
    finally:
        os._exit(status)
