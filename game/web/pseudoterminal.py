"""A program on a pseudo-terminal of its own: no shell in between, its own session and its own
environment."""

from __future__ import annotations

import asyncio
import fcntl
import os
import pty
import signal
import struct
import termios
from collections.abc import Mapping, Sequence
from contextlib import suppress

from game.study.study_settings import ScreenSize

READ_BYTES = 1 << 16
MOST_WAITING_BYTES = 1 << 14
"""Of keys that the program has not read; more are dropped."""
LEAVING_S = 2.0
"""How long a program that was hung up on may take to end by itself."""


class PseudoTerminal:
    """Made by `start`. Closing the terminal hangs the program up, as a lost SSH connection does,
    and so does the end of this process, however it ends."""

    def __init__(
        self,
        process: asyncio.subprocess.Process,
        output: asyncio.StreamReader,
        reading: asyncio.ReadTransport,
        keys: asyncio.WriteTransport,
        descriptor: int,
    ) -> None:
        self._process = process
        self._output = output
        self._reading = reading
        self._keys = keys
        self._descriptor = descriptor
        self._closed = False

    @classmethod
    async def start(
        cls, command: Sequence[str], env: Mapping[str, str], size: ScreenSize
    ) -> PseudoTerminal:
        """Run `command` with exactly `env`. Raises OSError where it cannot be started."""
        ours, theirs = pty.openpty()
        try:
            _set_size(ours, size)
            process = await asyncio.create_subprocess_exec(
                *command,
                stdin=theirs,
                stdout=theirs,
                stderr=theirs,
                env=dict(env),
                start_new_session=True,
                preexec_fn=_control,
            )
        except BaseException:
            os.close(ours)
            raise
        finally:
            os.close(theirs)
        loop = asyncio.get_running_loop()
        output = asyncio.StreamReader(limit=READ_BYTES)
        reading, _ = await loop.connect_read_pipe(
            lambda: _Output(output), os.fdopen(ours, "rb", buffering=0)
        )
        keys, _ = await loop.connect_write_pipe(
            asyncio.BaseProtocol, os.fdopen(os.dup(ours), "wb", buffering=0)
        )
        return cls(process, output, reading, keys, os.dup(ours))

    @property
    def pid(self) -> int:
        return self._process.pid

    async def read(self) -> bytes:
        """What the program has written; empty once it has ended."""
        return await self._output.read(READ_BYTES)

    def write(self, data: bytes) -> None:
        """Type `data`, unless the program has long stopped reading."""
        if not self._closed and self._keys.get_write_buffer_size() < MOST_WAITING_BYTES:
            self._keys.write(data)

    def resize(self, size: ScreenSize | tuple[int, int]) -> None:
        """Give the terminal a size, in columns and rows; the program paints everything again,
        whether that is another size or not."""
        if not self._closed and self._process.returncode is None:
            _set_size(self._descriptor, size)
            with suppress(ProcessLookupError):
                self._process.send_signal(signal.SIGWINCH)

    async def end(self) -> int:
        """Hang the program up, unless it has ended, and reap it; its exit status, negative for a
        signal's number."""
        if not self._closed:
            self._closed = True
            self._reading.close()
            self._keys.abort()
            os.close(self._descriptor)
        try:
            async with asyncio.timeout(LEAVING_S):
                return await self._process.wait()
        except TimeoutError:
            with suppress(ProcessLookupError):
                os.killpg(self._process.pid, signal.SIGKILL)
            return await self._process.wait()


class _Output(asyncio.StreamReaderProtocol):
    """A terminal whose program has ended gives an error where a pipe just ends."""

    def connection_lost(self, exc: Exception | None) -> None:
        super().connection_lost(None)


def _control() -> None:
    """In the new program's process: its terminal is the one that controls it."""
    fcntl.ioctl(0, termios.TIOCSCTTY, 0)


def _set_size(descriptor: int, size: ScreenSize | tuple[int, int]) -> None:
    columns, rows = (size.columns, size.rows) if isinstance(size, ScreenSize) else size
    fcntl.ioctl(descriptor, termios.TIOCSWINSZ, struct.pack("HHHH", rows, columns, 0, 0))
