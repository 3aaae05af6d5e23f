"""One process per session: a lock that names its holder, and taking over from a dead connection.

The lock is the kernel's (`flock`) and dies with its process: after a crash or a restart the file
is still there, but nobody holds it.
"""

from __future__ import annotations

import fcntl
import os
import signal
import time
from contextlib import suppress
from pathlib import Path

from game.errors import disk_hint
from game.journal.sink import make_folders
from game.study.folder import StudyError
from game.study.ledger import lock_whole

LOCK = "lock"
TAKEOVER_S = 3.0
"""How long the other process gets to end by itself."""
GLANCE_S = 0.1
"""The longest time for which `is_held` can keep someone from the lock."""
_POLL_S = 0.02


class SessionBusy(StudyError):
    """Another process has the session open. `pid` is its number, None if unknown."""

    def __init__(self, path: Path, pid: int | None, silent_ms: int) -> None:
        super().__init__(
            "this session is open in another window",
            place=str(path.parent),
            hint="Continue there, or close that window first",
        )
        self.pid = pid
        self.silent_ms = silent_ms


class SessionLock:
    """Held from its creation until `release` or the end of the process."""

    def __init__(self, home: Path) -> None:
        """Lock the session in `home`. Raises SessionBusy, or StudyError if it cannot be locked."""
        self.path = home / LOCK
        try:
            make_folders(home)
            self._descriptor = os.open(self.path, os.O_RDWR | os.O_CREAT, 0o600)
        except OSError as error:
            raise StudyError(
                f"the session cannot be opened ({error.strerror})",
                place=str(home),
                hint=disk_hint(error),
            ) from error
        if not _locks(self._descriptor, self.path, GLANCE_S):
            pid = _holder(self._descriptor)
            os.close(self._descriptor)
            raise SessionBusy(self.path, pid, _silent_ms(home))
        try:
            os.ftruncate(self._descriptor, 0)
            os.pwrite(self._descriptor, f"{os.getpid()}\n".encode(), 0)
        except OSError as error:
            os.close(self._descriptor)
            raise StudyError(
                f"the session cannot be opened ({error.strerror})",
                place=str(home),
                hint=disk_hint(error),
            ) from error

    def release(self) -> None:
        if self._descriptor >= 0:
            os.close(self._descriptor)
            self._descriptor = -1


def is_held(home: Path) -> bool:
    """Whether a process has the session in `home` open. Writes nothing and does not wait.

    The kernel's lock decides: the number in the file outlives its process, and in a copy of the
    study it may belong to a process that has the original open.
    """
    try:
        with (home / LOCK).open("rb") as file:
            fcntl.flock(file, fcntl.LOCK_SH | fcntl.LOCK_NB)
    except BlockingIOError:
        return True
    except OSError:
        return False
    return False


def take_over(home: Path) -> SessionLock:
    """End the process that holds the session, and lock it; takes a few seconds at most.

    Raises SessionBusy if the other process cannot be ended.
    """
    for number in (signal.SIGTERM, signal.SIGKILL):
        try:
            return SessionLock(home)
        except SessionBusy as busy:
            if busy.pid is None:
                raise
            with suppress(ProcessLookupError, PermissionError):
                os.kill(busy.pid, number)
        with (home / LOCK).open("rb") as file:
            _locks(file.fileno(), home / LOCK, TAKEOVER_S)
    return SessionLock(home)


def _locks(descriptor: int, path: Path, within_s: float) -> bool:
    """Lock the file for this process; whether that succeeded in time."""
    until = time.monotonic() + within_s
    while True:
        try:
            lock_whole(descriptor, path, wait=False)
        except BlockingIOError:
            if time.monotonic() > until:
                return False
            time.sleep(_POLL_S)
        else:
            return True


def _holder(descriptor: int) -> int | None:
    text = os.pread(descriptor, 20, 0).strip()
    return int(text) if text.isdigit() and int(text) > 1 else None


def _silent_ms(home: Path) -> int:
    """How long ago the session last wrote anything."""
    written = max((path.stat().st_mtime for path in home.iterdir()), default=time.time())
    return max(0, round((time.time() - written) * 1000))
