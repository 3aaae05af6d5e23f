"""Where the lines of a journal go: to a file, without buffering, or into memory."""

from __future__ import annotations

import fcntl
import os
import threading
from contextlib import suppress
from pathlib import Path
from typing import Protocol, Self

from game.journal.journal_error import JournalError, cannot_write

SYNC_AFTER_S = 0.5
"""The delay between writing lines and asking the system to put them on disk."""


class Sink(Protocol):
    """Takes whole lines. Every method raises JournalError if the journal cannot be written."""

    def write(self, lines: bytes) -> None:
        """Hand over `lines`; once this returns, they survive a crash of this process."""
        ...

    def flush_durably(self) -> None:
        """Wait until everything written would survive a power cut."""
        ...

    def close(self) -> None:
        """Flush durably and release the journal."""
        ...


class FileSink:
    """A journal's file, locked against other processes; each batch is one system call.

    A thread calls fsync within a second of a write. After a failure nothing more is written, and
    every later call raises the same JournalError: after a torn line, only a new segment may
    follow.
    """

    def __init__(self, path: Path, *, create: bool = True) -> None:
        """Open and lock the file; with `create`, make it if it is missing (mode 0600, and missing
        folders 0700)."""
        self.path = path
        self._failure: JournalError | None = None
        self._new_name = not path.exists()
        try:
            if create:
                make_folders(path.parent)
            flags = os.O_RDWR | os.O_APPEND | (os.O_CREAT if create else 0)
            self._descriptor = os.open(path, flags, 0o600)
        except OSError as error:
            raise cannot_write(path, error) from error
        try:
            fcntl.flock(self._descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError as error:
            os.close(self._descriptor)
            raise _locked_out(path, error) from error
        self._open = threading.Lock()
        self._written = threading.Event()
        self._closing = threading.Event()
        self._syncer: threading.Thread | None = None

    def contents(self) -> bytes:
        """Everything in the file."""
        try:
            size = os.fstat(self._descriptor).st_size
            return os.pread(self._descriptor, size, 0)
        except OSError as error:
            raise cannot_write(self.path, error) from error

    @classmethod
    def begin(cls, path: Path) -> Self:
        """The sink of a new journal. A file without one complete line is emptied; if there is a
        journal already, JournalError is raised."""
        sink = cls(path)
        try:
            contents = sink.contents()
            if b"\n" in contents:
                raise JournalError(
                    "there is already a journal",
                    place=str(path),
                    hint="Choose another folder: --log DIR.",
                )
            if contents:
                sink._empty()
        except BaseException:
            sink.close()
            raise
        return sink

    def _empty(self) -> None:
        try:
            os.ftruncate(self._descriptor, 0)
        except OSError as error:
            raise cannot_write(self.path, error) from error

    def write(self, lines: bytes) -> None:
        self._check()
        rest = memoryview(lines)
        try:
            while rest:
                rest = rest[os.write(self._descriptor, rest) :]
        except OSError as error:
            raise self._failed(error) from error
        self._ask_for_sync()

    def flush_durably(self) -> None:
        self._check()
        with self._open:
            self._sync()
        self._check()

    def close(self) -> None:
        self._closing.set()
        self._written.set()
        with self._open:
            if self._descriptor < 0:
                return
            self._sync()
            os.close(self._descriptor)
            self._descriptor = -1
        self._check()

    def _check(self) -> None:
        if self._failure is not None:
            raise self._failure

    def _failed(self, error: OSError) -> JournalError:
        self._failure = self._failure or cannot_write(self.path, error)
        return self._failure

    def _ask_for_sync(self) -> None:
        if self._syncer is None:
            self._syncer = threading.Thread(target=self._keep_syncing, daemon=True)
            self._syncer.start()
        self._written.set()

    def _keep_syncing(self) -> None:
        while not self._closing.is_set():
            self._written.wait()
            self._closing.wait(SYNC_AFTER_S)
            self._written.clear()
            with self._open:
                self._sync()

    def _sync(self) -> None:
        if self._descriptor < 0 or self._failure is not None:
            return
        try:
            os.fsync(self._descriptor)
            if self._new_name:
                sync_folder(self.path.parent)
                self._new_name = False
        except OSError as error:
            self._failed(error)


class MemorySink:
    """Lines kept in memory; if there is a `path`, closing writes them there all at once."""

    def __init__(self, path: Path | None = None) -> None:
        self.path = path
        self.data = bytearray()

    def write(self, lines: bytes) -> None:
        self.data += lines

    def flush_durably(self) -> None:
        """Nothing to wait for: a simulated session is written whole or not at all."""

    def close(self) -> None:
        if self.path is None:
            return
        sink = FileSink.begin(self.path)
        try:
            sink.write(bytes(self.data))
        finally:
            sink.close()
        self.path = None


def _locked_out(path: Path, error: OSError) -> JournalError:
    if isinstance(error, BlockingIOError):
        return JournalError(
            "another process is writing this journal",
            place=str(path),
            hint="Close the other one, or wait until it has finished.",
        )
    return cannot_write(path, error)


def make_folders(folder: Path) -> None:
    """Make the folder and any missing parents, readable by their owner only (0700)."""
    missing = [parent for parent in (folder, *folder.parents) if not parent.exists()]
    for parent in reversed(missing):
        parent.mkdir(mode=0o700, exist_ok=True)


def sync_folder(folder: Path) -> None:
    """Make the name of a new file durable, if the file system can sync a folder."""
    descriptor = os.open(folder, os.O_RDONLY)
    try:
        with suppress(OSError):
            os.fsync(descriptor)
    finally:
        os.close(descriptor)
