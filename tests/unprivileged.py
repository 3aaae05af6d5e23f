"""Runs `ana` as an account that file permissions hold for, though the tests may run as root."""

from __future__ import annotations

import ctypes
import os
import subprocess
import sys
from pathlib import Path

import pytest

_PR_CAPBSET_DROP = 24
_ABOVE_PERMISSIONS = (1, 2)
"""CAP_DAC_OVERRIDE and CAP_DAC_READ_SEARCH of Linux: without them root is an owner like others."""


def ana(*arguments: str | Path) -> subprocess.CompletedProcess[str]:
    """What the command prints, and its exit status. Skips the test where root cannot be bound."""
    if os.geteuid() == 0 and sys.platform != "linux":
        pytest.skip("root may read everything")
    return subprocess.run(
        [sys.executable, "-m", "game", *map(str, arguments)],
        preexec_fn=_bind_root if os.geteuid() == 0 else None,
        capture_output=True,
        text=True,
        check=False,
    )


def _bind_root() -> None:
    library = ctypes.CDLL(None)
    for capability in _ABOVE_PERMISSIONS:
        library.prctl(_PR_CAPBSET_DROP, capability, 0, 0, 0)
