"""A visitor's running program, with a browser on the line or not, and the room for all of them."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Awaitable, Callable, Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass, field
from enum import IntEnum

import msgspec
from aiohttp import web

from game.study.study_settings import ScreenSize
from game.web.bucket import TokenBucket
from game.web.modes import Modes
from game.web.pseudoterminal import PseudoTerminal

COVERED = (20, 4)
"""The size of the terminal while nobody sees it: the program covers itself as in a window that is
too small, and paints everything again afterwards."""
MOST_MESSAGE_BYTES = 4096


@dataclass(frozen=True)
class Limits:
    """How many visitors there may be, and for how long each may keep what is theirs."""

    sessions: int = 40
    away_s: float = 15.0
    """A program without a line waits so long for it to come back."""
    idle_s: float = 1800.0
    """A program ends when no key was pressed for so long."""
    send_s: float = 10.0
    """A browser that takes nothing for so long has lost its line."""
    keys_a_second: float = 60.0
    bytes_a_second: float = 2000.0
    burst_s: float = 4.0
    """So many seconds' worth of keys may come at once, after a line that stalled."""


class Goodbye(IntEnum):
    """Why the server closes a line: the codes that page.js knows."""

    ENDED = 4000
    ELSEWHERE = 4001
    FULL = 4002
    IDLE = 4003
    STOPPING = 4004


class Ending(msgspec.Struct, frozen=True, kw_only=True):
    """What a page is told when the program has ended: its exit status, and the completion code and
    the address to go to, where there are any."""

    status: int
    code: str = ""
    url: str = ""


@dataclass(frozen=True)
class Visitor:
    """Who comes, and what runs for them; `name` is the same for all windows of one visitor."""

    name: str
    command: tuple[str, ...]
    env: Mapping[str, str]
    size: ScreenSize
    ending: Callable[[int], Awaitable[Ending]]


class NoRoom(Exception):
    """As many visitors as may be are there."""


@dataclass(eq=False)
class Line:
    """A browser's websocket, and how much it may still send."""

    socket: web.WebSocketResponse
    transport: asyncio.Transport | None
    keys: TokenBucket
    data: TokenBucket

    why: Goodbye | None = None
    closing: asyncio.Event = field(default_factory=asyncio.Event)
    """Set when its own handler is to close it."""

    def close(self, why: Goodbye) -> None:
        """Have it closed."""
        self.why = why
        self.closing.set()


@dataclass(eq=False)
class Hosted:
    """One program. At most one line at a time is on it: the newest."""

    visitor: Visitor
    terminal: PseudoTerminal
    limits: Limits
    line: Line | None = None
    status: int | None = None
    _modes: Modes = field(default_factory=Modes)
    _alone_since: float = field(default_factory=time.monotonic)
    _pressed: float = field(default_factory=time.monotonic)
    _why: Goodbye = Goodbye.ENDED
    leaving: bool = False
    """Whether it was hung up on."""
    over: asyncio.Event = field(default_factory=asyncio.Event)
    """Set once it has ended, and another may be started for the same visitor."""

    async def attach(self, line: Line) -> None:
        """Put a line on, in place of another, and have everything painted on it."""
        before, self.line = self.line, line
        if before is not None:
            before.close(Goodbye.ELSEWHERE)
        await self.repaint(line)

    def detach(self, line: Line) -> None:
        """A line is gone; the program is covered until another comes."""
        if self.line is line:
            self.line = None
            self._alone_since = time.monotonic()
            self.cover()

    def cover(self) -> None:
        """Nobody sees the program."""
        self.terminal.resize(COVERED)

    async def repaint(self, line: Line) -> None:
        """Have everything painted on a line whose terminal is new."""
        await self._send(line, self._modes.prelude())
        self.terminal.resize(self.visitor.size)

    def press(self, line: Line, keys: str) -> None:
        """Type keys, unless they come faster than anyone types."""
        data = keys.encode("utf-8", "replace")
        if self.line is line and line.keys.take(1) and line.data.take(len(data)):
            self._pressed = time.monotonic()
            self.terminal.write(data)

    async def run(self) -> None:
        """Carry output to whatever line there is, until the program ends."""
        watch = asyncio.create_task(self._watch())
        try:
            while data := await self.terminal.read():
                self._modes.feed(data)
                if self.line is not None:
                    await self._send(self.line, data)
        finally:
            watch.cancel()
            self.leaving = True
            self.status = await self.terminal.end()
            await self._say_goodbye()

    async def stop(self, why: Goodbye) -> None:
        """Hang the program up, and wait until it has ended."""
        await self._hang_up(why)
        await self.over.wait()

    async def _hang_up(self, why: Goodbye) -> None:
        self.leaving, self._why = True, why
        await self.terminal.end()

    async def _send(self, line: Line, data: bytes) -> None:
        try:
            async with asyncio.timeout(self.limits.send_s):
                await line.socket.send_bytes(data)
        except (TimeoutError, ConnectionError, RuntimeError):
            self.detach(line)
            if line.transport is not None:
                line.transport.abort()

    async def _watch(self) -> None:
        """Hang up once nobody has come back, or pressed a key, for long enough."""
        while True:
            await asyncio.sleep(min(1.0, self.limits.away_s / 4))
            now = time.monotonic()
            if self.line is None and now - self._alone_since > self.limits.away_s:
                return await self._hang_up(Goodbye.STOPPING)
            if now - self._pressed > self.limits.idle_s:
                return await self._hang_up(Goodbye.IDLE)

    async def _say_goodbye(self) -> None:
        line, self.line = self.line, None
        if line is None or self.status is None:
            return
        if self._why is Goodbye.ENDED:
            ending = await self.visitor.ending(self.status)
            with suppress(TimeoutError, ConnectionError, RuntimeError):
                async with asyncio.timeout(self.limits.send_s):
                    await line.socket.send_str(msgspec.json.encode(ending).decode())
        line.close(self._why)


class Room:
    """All programs that run now, by the visitor's name."""

    def __init__(self, limits: Limits) -> None:
        self.limits = limits
        self._hosted: dict[str, Hosted] = {}
        self._door = asyncio.Lock()
        self._tasks: set[asyncio.Task[None]] = set()
        self._closing = False

    def __len__(self) -> int:
        return len(self._hosted)

    def __iter__(self) -> Iterator[Hosted]:
        return iter(list(self._hosted.values()))

    async def enter(self, visitor: Visitor) -> Hosted:
        """The visitor's program, running already or started now.

        Raises NoRoom where too many run, and OSError where it cannot be started.
        """
        while True:
            async with self._door:
                hosted = self._hosted.get(visitor.name)
                if hosted is None:
                    return await self._start(visitor)
            if not hosted.leaving:
                return hosted
            await hosted.over.wait()

    async def _start(self, visitor: Visitor) -> Hosted:
        if self._closing or len(self._hosted) >= self.limits.sessions:
            raise NoRoom
        terminal = await PseudoTerminal.start(visitor.command, visitor.env, visitor.size)
        hosted = self._hosted[visitor.name] = Hosted(visitor, terminal, self.limits)
        task = asyncio.create_task(self._host(hosted))
        self._tasks.add(task)
        task.add_done_callback(self._tasks.discard)
        return hosted

    def line(self, socket: web.WebSocketResponse, transport: asyncio.Transport | None) -> Line:
        """A line with what it may send."""
        limits = self.limits
        keys, data = limits.keys_a_second, limits.bytes_a_second
        return Line(
            socket,
            transport,
            TokenBucket(keys, keys * limits.burst_s),
            TokenBucket(data, data * limits.burst_s),
        )

    async def close(self) -> None:
        """Hang up on everyone, all at once; every program is reaped."""
        self._closing = True
        await asyncio.gather(*(hosted.stop(Goodbye.STOPPING) for hosted in self))

    async def _host(self, hosted: Hosted) -> None:
        try:
            await hosted.run()
        finally:
            del self._hosted[hosted.visitor.name]
            hosted.over.set()
