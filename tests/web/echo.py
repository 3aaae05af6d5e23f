"""A door behind which a small program runs that shows the keys it gets."""

from __future__ import annotations

import sys
from collections.abc import AsyncIterator, Mapping
from contextlib import asynccontextmanager

from aiohttp import ClientWebSocketResponse, WSMsgType
from aiohttp.test_utils import TestClient, TestServer

from game.study.links import LinkError
from game.study.study_settings import ScreenSize
from game.study.texts import shipped_texts
from game.web.doors import environment
from game.web.hosted import Ending, Limits, Room, Visitor
from game.web.server import WebServer

PROGRAM = r"""
import os, signal, sys, tty
tty.setraw(0)
def show_size(*_):
    size = os.get_terminal_size()
    os.write(1, b"<%d x %d>" % (size.columns, size.lines))
signal.signal(signal.SIGWINCH, show_size)
if "deaf" in sys.argv:
    signal.signal(signal.SIGHUP, signal.SIG_IGN)
os.write(1, b"\x1b[?1049h\x1b[?25l")
show_size()
while True:
    try:
        keys = os.read(0, 4096)
    except OSError:
        if "deaf" in sys.argv:
            signal.pause()
        break
    if b"Q" in keys:
        sys.exit(7)
    if b"F" in keys:
        for _ in range(400):
            os.write(1, b"x" * 65536)
    os.write(1, keys)
"""
SIZE = ScreenSize(columns=120, rows=40)


class EchoDoor:
    """Everybody's ticket is their name."""

    title = "Echo <&> study"
    language = "de"
    size = SIZE

    def __init__(self, *options: str) -> None:
        self.words = shipped_texts().browser
        self._options = options

    def ticket(self, query: Mapping[str, str]) -> str:
        if "link" not in query:
            raise LinkError("nobody's link")
        return query["link"]

    def visitor(self, ticket: str, tab: str) -> Visitor:
        if not ticket.isalnum():
            raise LinkError("nobody's link")

        async def ending(status: int) -> Ending:
            return Ending(status=status, code="ABCD", url="https://panel.example/?cc=ABCD")

        command = (sys.executable, "-c", PROGRAM, *self._options)
        return Visitor(ticket, command, environment(), SIZE, ending)


class Visit:
    """A line to an echo, and what came over it."""

    def __init__(self, socket: ClientWebSocketResponse) -> None:
        self.socket = socket
        self.output = b""
        self.told: list[str] = []

    async def press(self, keys: str) -> None:
        await self.socket.send_str(f"k{keys}")

    async def until(self, text: bytes, seconds: float = 20) -> None:
        """Read until `text` has come. Raises ConnectionError when the line closes first."""
        while text not in self.output:
            await self._take(seconds)

    async def closed(self, seconds: float = 20) -> int | None:
        """Read until the line closes; the code."""
        try:
            while True:
                await self._take(seconds)
        except ConnectionError:
            return self.socket.close_code

    async def _take(self, seconds: float) -> None:
        message = await self.socket.receive(seconds)
        if message.type is WSMsgType.BINARY:
            self.output += message.data
        elif message.type is WSMsgType.TEXT:
            self.told.append(message.data)
        else:
            raise ConnectionError(f"{message.type.name}, {self.socket.close_code}: {self.output!r}")


class Echoes:
    """A server in this process, and a client of it."""

    def __init__(self, room: Room, client: TestClient) -> None:  # type: ignore[type-arg]
        self.room, self.client = room, client
        self.origin = str(client.make_url("/")).rstrip("/")

    async def visit(self, name: str = "P01", tab: str = "abcdefgh") -> Visit:
        return Visit(
            await self.client.ws_connect(
                "/line", params={"ticket": name, "tab": tab}, headers={"Origin": self.origin}
            )
        )

    async def refused(self, query: Mapping[str, str], headers: Mapping[str, str]) -> int:
        """Ask for a line; the status of the answer that is none."""
        asked = {"Upgrade": "websocket", "Connection": "Upgrade", "Sec-WebSocket-Version": "13",
                 "Sec-WebSocket-Key": "dGhlIHNhbXBsZSBub25jZQ==", **headers}  # fmt: skip
        answer = await self.client.get("/line", params=query, headers=asked)
        return answer.status


@asynccontextmanager
async def echoes(limits: Limits | None = None, *options: str) -> AsyncIterator[Echoes]:
    """A running server; every program is gone afterwards."""
    room = Room(limits or Limits())
    server = WebServer(EchoDoor(*options), room, frozenset(), loopback=True)
    async with TestClient(TestServer(server.application())) as client:
        yield Echoes(room, client)
