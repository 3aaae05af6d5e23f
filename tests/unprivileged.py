"""Runs `ana` as an account that file permissions hold for, though the tests may run as root."""

from __future__ import annotations

import ctypes
import os
import subprocess
import sys
import tempfile
import traceback
from contextlib import redirect_stderr, redirect_stdout
from pathlib import Path

import pytest

from game.cli import main

_VERSION_3 = 0x20080522
_ABOVE_PERMISSIONS = (1, 2)
"""CAP_DAC_OVERRIDE and CAP_DAC_READ_SEARCH of Linux: without them root is an owner like others."""
_CRASHED = 70


def ana(*arguments: str | Path) -> subprocess.CompletedProcess[str]:
    """What the command prints, and its exit status, in a process forked from this one, which has
    imported everything. Skips the test where root cannot be bound."""
    if os.geteuid() == 0 and sys.platform != "linux":
        pytest.skip("root may read everything")
    command = [*map(str, arguments)]
    with tempfile.TemporaryFile() as out, tempfile.TemporaryFile() as err:
        child = os.fork()
        if child == 0:
            os._exit(_run(command, out.fileno(), err.fileno()))
        status = os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
        texts = []
        for file in (out, err):
            file.seek(0)
            texts.append(file.read().decode())
    return subprocess.CompletedProcess(command, status, *texts)


def _run(command: list[str], out: int, err: int) -> int:
    with (
        open(out, "w", encoding="utf-8", closefd=False) as told,
        open(err, "w", encoding="utf-8", closefd=False) as wrong,
        redirect_stdout(told),
        redirect_stderr(wrong),
    ):
        try:
            if os.geteuid() == 0:
                _bind_root()
            return main(command)
        except BaseException:
            traceback.print_exc()
            return _CRASHED


def _bind_root() -> None:
    """Give up reading and writing whatever permissions say."""
    library = ctypes.CDLL(None, use_errno=True)
    header = (ctypes.c_uint32 * 2)(_VERSION_3, 0)
    # two halves of 32 bits, each effective, permitted, inheritable
    sets = (ctypes.c_uint32 * 6)()
    if library.capget(header, sets):
        raise OSError(ctypes.get_errno(), "capget")
    kept = ~sum(1 << capability for capability in _ABOVE_PERMISSIONS) & 0xFFFFFFFF
    for place in range(3):
        sets[place] &= kept
    if library.capset(header, sets):
        raise OSError(ctypes.get_errno(), "capset")
