"""A program in a pseudo-terminal: keys in, what its screen shows out, and when."""

from __future__ import annotations

import contextlib
import fcntl
import os
import pty
import re
import select
import signal
import struct
import termios
import time
from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import pyte
from PIL import Image

KEYS = {
    "up": "\x1b[A",
    "down": "\x1b[B",
    "right": "\x1b[C",
    "left": "\x1b[D",
    "enter": "\r",
    "escape": "\x1b",
    "space": " ",
    "tab": "\t",
    "backspace": "\x7f",
}

_QUERIES = {
    b"\x1b[?2026$p": b"\x1b[?2026;0$y",
    b"\x1b[?2048$p": b"\x1b[?2048;0$y",
    b"\x1b[6n": b"\x1b[1;1R",
    b"\x1b[c": b"\x1b[?62;22c",
}
_UNKNOWN_TO_PYTE = re.compile(
    rb"\x1b\[[<>=][0-9;]*u|\x1b\[\?[0-9;]*\$p|\x1b\[[0-9;]*\$[a-z]|\x1b\[\?2026[hl]"
)


class Chunk(NamedTuple):
    """Output as it came, with the `time.perf_counter` of its arrival."""

    at: float
    data: bytes


class Shown(ABC):
    """What a program shows, wherever it runs: its output, emulated."""

    def __init__(self, columns: int, rows: int) -> None:
        self.chunks: list[Chunk] = []
        self._screen = pyte.Screen(columns, rows)
        self._stream = pyte.ByteStream(self._screen)
        self._fed = 0
        self._shown: str | None = None

    @abstractmethod
    def press(self, *keys: str) -> None:
        """Type keys by name, or text as it is."""

    @abstractmethod
    def read_for(self, seconds: float) -> bool:
        """Collect output for a while. False once the program has ended."""

    def wait_for(self, text: str, seconds: float = 15) -> str:
        """Read until `text` is on the screen, and return the screen. Raises TimeoutError."""
        end = time.perf_counter() + seconds
        while text not in (shown := self.text()):
            if time.perf_counter() > end or not self.read_for(0.05):
                raise TimeoutError(f"{text!r} did not come up; the screen:\n{shown}")
        return shown

    def text(self) -> str:
        """What the screen shows now."""
        new, self._fed = self.chunks[self._fed :], len(self.chunks)
        for chunk in new:
            self.feed(self._stream, chunk.data)
        if new or self._shown is None:
            self._shown = "\n".join(line.rstrip() for line in self._screen.display)
        return self._shown

    def image(self) -> Image.Image:
        """The screen as it looks now."""
        from tests.recording import picture

        self.text()
        return picture(self._screen)

    def forget(self) -> None:
        """Begin with an empty screen, as if nothing had come yet."""
        self.chunks.clear()
        self._screen.reset()
        self._fed, self._shown = 0, None

    @staticmethod
    def answer(data: bytes) -> bytes:
        """What a terminal says to the questions in a program's output."""
        return b"".join(said for query, said in _QUERIES.items() if query in data)

    @staticmethod
    def feed(stream: Any, data: bytes) -> None:
        """Give output to an emulator without the few sequences it would print as text."""
        stream.feed(_UNKNOWN_TO_PYTE.sub(b"", data))


class Watched(Shown):
    """A terminal that `select` can wait on."""

    @abstractmethod
    def fileno(self) -> int:
        """What `select` waits on for output."""

    @abstractmethod
    def take(self) -> bool:
        """Collect the output that is there, or wait for some. False once the program has ended."""


class Ending(Shown):
    """What a program shows until it ends, which can be waited for."""

    @abstractmethod
    def wait(self, seconds: float = 10) -> int:
        """Read until the program ends, and return its exit status. Raises TimeoutError."""


class Terminal(Watched, Ending):
    """`command` running in a terminal of its own, 256 colours unless `env` says otherwise.

    Use as a context manager: on leaving, the program is hung up on and reaped.
    """

    def __init__(
        self,
        command: Sequence[str | Path],
        *,
        columns: int = 80,
        rows: int = 24,
        env: Mapping[str, str] | None = None,
    ) -> None:
        super().__init__(columns, rows)
        self.status: int | None = None
        inherited = {
            name: value
            for name, value in os.environ.items()
            if name not in ("COLORTERM", "NO_COLOR", "LINES", "COLUMNS")
        }
        environment = {**inherited, "TERM": "xterm-256color", "LANG": "C.UTF-8", **(env or {})}
        argv = [str(part) for part in command]
        self.started = time.perf_counter()
        self.pid, self._descriptor = pty.fork()
        if self.pid == 0:
            fcntl.ioctl(0, termios.TIOCSWINSZ, struct.pack("HHHH", rows, columns, 0, 0))
            os.execvpe(argv[0], argv, environment)
        self.resize(columns, rows)

    def __enter__(self) -> Terminal:
        return self

    def __exit__(self, *_: object) -> None:
        self.hang_up()

    def resize(self, columns: int, rows: int) -> None:
        fcntl.ioctl(self._descriptor, termios.TIOCSWINSZ, struct.pack("HHHH", rows, columns, 0, 0))
        self._screen.resize(rows, columns)
        self._shown = None

    def press(self, *keys: str) -> None:
        for key in keys:
            self.write(KEYS.get(key, key).encode())

    def write(self, data: bytes) -> None:
        os.write(self._descriptor, data)

    def read_for(self, seconds: float) -> bool:
        end = time.perf_counter() + seconds
        while (left := end - time.perf_counter()) > 0:
            if not select.select([self], [], [], left)[0]:
                return True
            if not self.take():
                return False
        return True

    def fileno(self) -> int:
        return self._descriptor

    def take(self) -> bool:
        try:
            data = os.read(self._descriptor, 65536)
        except OSError:
            return False
        if not data:
            return False
        self.chunks.append(Chunk(time.perf_counter(), data))
        self.write(self.answer(data))
        return True

    def wait(self, seconds: float = 10) -> int:
        """Read until the program ends, and return its exit status (negative: a signal's number).

        Raises TimeoutError.
        """
        end = time.perf_counter() + seconds
        while self.status is None:
            self.read_for(0.02)
            pid, status = os.waitpid(self.pid, os.WNOHANG)
            if pid:
                self.status = os.waitstatus_to_exitcode(status)
            elif time.perf_counter() > end:
                raise TimeoutError(f"the program still runs; the screen:\n{self.text()}")
        return self.status

    def kill(self, number: signal.Signals) -> None:
        os.kill(self.pid, number)

    def hang_up(self) -> None:
        """Close the terminal and reap the program, killing it if it does not leave by itself."""
        if self.status is None:
            with contextlib.suppress(ProcessLookupError):
                self.kill(signal.SIGHUP)
            try:
                self.wait(3)
            except TimeoutError:
                self.kill(signal.SIGKILL)
                self.wait(3)
        os.close(self._descriptor)
