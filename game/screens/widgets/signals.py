"""What the program does when it is told to go: it records that, and leaves a clean terminal.

Output to a terminal that has stalled blocks, so the handlers do not rely on the event loop ever
running again: an alarm ends the process if leaving takes too long.
"""

from __future__ import annotations

import asyncio
import os
import signal
from collections.abc import Callable
from contextlib import suppress
from types import FrameType

PATIENCE_S = 1.5
"""How long leaving may take."""
SIGNALS = (signal.SIGHUP, signal.SIGTERM)


def lead_out(note: Callable[[str], None], leave: Callable[[int], None]) -> None:
    """From now on SIGHUP and SIGTERM end the program. Call it on the running event loop.

    `note` records the signal, given its name, once each; it runs in the handler, so at any moment.
    `leave` ends the program with an exit status; it runs on the event loop, if that still runs.
    """
    loop = asyncio.get_running_loop()
    heard: set[int] = set()

    def go(number: int, _frame: FrameType | None) -> None:
        if number in heard:
            return
        heard.add(number)
        status = 128 + number
        signal.signal(signal.SIGALRM, lambda *_: os._exit(status))
        signal.setitimer(signal.ITIMER_REAL, PATIENCE_S)
        with suppress(Exception):
            note(signal.Signals(number).name)
        loop.call_soon_threadsafe(leave, status)

    for number in SIGNALS:
        signal.signal(number, go)


def has_job_control() -> bool:
    """Whether a shell waits that can continue this program after it was stopped: it then has a
    process group of its own in the shell's session."""
    return os.getpgrp() != os.getsid(0)


def suspend_group() -> None:
    """Stop this program and what started it with it, such as make, as Ctrl+Z does elsewhere. The
    terminal is given back before, and taken again when the shell continues the program."""
    os.kill(0, signal.SIGTSTP)
