"""A terminal that vanishes is a hang-up, whether or not the system sends the signal."""

from __future__ import annotations

import os
import pty
import subprocess
import time
from fcntl import ioctl
from pathlib import Path
from select import select
from struct import pack
from termios import TIOCSCTTY, TIOCSWINSZ

import pytest

from game.journal.reader import read_journal
from game.journal.records import Interruption
from tests.study.server import ANA

PATIENCE_S = 60


@pytest.mark.parametrize("controlling", [True, False])
def test_a_terminal_that_vanishes_is_a_hang_up(tmp_path: Path, controlling: bool) -> None:
    shown, terminal = pty.openpty()
    ioctl(terminal, TIOCSWINSZ, pack("HHHH", 24, 80, 0, 0))
    program = subprocess.Popen(
        [ANA, "play", "--now", "--log", tmp_path],
        stdin=terminal,
        stdout=terminal,
        stderr=terminal,
        start_new_session=True,
        preexec_fn=_take_terminal if controlling else None,  # noqa: PLW1509  (no threads here)
    )
    os.close(terminal)
    until, painted = time.monotonic() + PATIENCE_S, b""
    while b"rescued" not in painted and time.monotonic() < until:
        if select([shown], [], [], 0.1)[0]:
            painted += os.read(shown, 1 << 16)
    os.close(shown)
    assert program.wait(PATIENCE_S) == 129
    (journal,) = tmp_path.glob("*/journal.jsonl")
    noted = [it.record for it in read_journal(journal).entries]
    assert [it for it in noted if isinstance(it, Interruption)] == [
        Interruption("hang_up", signal="SIGHUP")
    ]


def _take_terminal() -> None:
    ioctl(0, TIOCSCTTY, 0)
