"""A browser's place taken by a plain websocket client, which a test drives step by step."""

from __future__ import annotations

import asyncio
import json
import threading
import time
from contextlib import suppress

import aiohttp

from tests.terminal import KEYS, Chunk, Ending
from tests.web.own_loop import own_loop

TAB = "abcdefgh"
COLUMNS, ROWS = 120, 40


def get(address: str, **headers: str) -> tuple[int, str, dict[str, str]]:
    """Status, text and headers of a page."""

    async def fetch() -> tuple[int, str, dict[str, str]]:
        async with (
            aiohttp.ClientSession() as session,
            session.get(address, headers=headers, allow_redirects=False) as answer,
        ):
            return answer.status, await answer.text(errors="replace"), dict(answer.headers)

    return own_loop.run(fetch())


class WebTerminal(Ending):
    """A line to a server, and the terminal at its end. Use as a context manager.

    Raises aiohttp.WSServerHandshakeError, with its status, where the server refuses it.
    """

    def __init__(
        self,
        address: str,
        ticket: str,
        *,
        tab: str = TAB,
        reads: bool = True,
        **headers: str,
    ) -> None:
        super().__init__(COLUMNS, ROWS)
        self.told: list[str] = []
        """Text messages from the server."""
        self.code: int | None = None
        """The code it was closed with; 1006 if it just broke."""
        self._news = threading.Event()
        self._headers = {"Origin": address.rstrip("/"), **headers}
        self._url = f"{address}line"
        self._query = {"ticket": ticket, "tab": tab}
        own_loop.run(self._connect(reads))

    async def _connect(self, reads: bool) -> None:
        self._session = aiohttp.ClientSession()
        try:
            self._socket = await self._session.ws_connect(
                self._url, params=self._query, headers=self._headers, max_msg_size=0, autoping=reads
            )
        except BaseException:
            await self._session.close()
            raise
        self._listening = asyncio.create_task(self._listen()) if reads else None

    async def _listen(self) -> None:
        async for message in self._socket:
            if message.type is aiohttp.WSMsgType.BINARY:
                self.chunks.append(Chunk(time.perf_counter(), message.data))
                if said := self.answer(message.data):
                    await self._socket.send_str(f"k{said.decode()}")
            elif message.type is aiohttp.WSMsgType.TEXT:
                self.told.append(message.data)
            self._news.set()
        self.code = self._socket.close_code
        self._news.set()

    def __enter__(self) -> WebTerminal:
        return self

    def __exit__(self, *_: object) -> None:
        own_loop.run(self._close())

    async def _close(self) -> None:
        with suppress(Exception):
            await asyncio.wait_for(self._socket.close(), 3)
        await self._session.close()

    def drop(self) -> None:
        """Break the line without a word."""

        async def abort() -> None:
            response = self._socket._response.connection
            if response is not None and response.transport is not None:
                response.transport.abort()

        own_loop.run(abort())

    def press(self, *keys: str) -> None:
        for key in keys:
            self.say("k" + KEYS.get(key, key))

    def say(self, message: str | bytes) -> None:
        """Send a message as it is."""
        send = self._socket.send_str if isinstance(message, str) else self._socket.send_bytes
        with suppress(ConnectionError):
            own_loop.run(send(message))  # type: ignore[arg-type]

    def read_for(self, seconds: float) -> bool:
        self._news.clear()
        if self.code is not None:
            return False
        end = time.monotonic() + seconds
        while (left := end - time.monotonic()) > 0 and self.code is None:
            if seconds > 0.01:
                time.sleep(left)
            elif self._news.wait(left):
                break
        return True

    def wait(self, seconds: float = 10) -> int:
        self.wait_closed(seconds)
        status: int = json.loads(self.told[-1])["status"]
        return status

    def wait_closed(self, seconds: float = 10) -> int:
        """Wait until the server has closed the line; the code. Raises TimeoutError."""
        end = time.monotonic() + seconds
        while self.code is None:
            if time.monotonic() > end:
                raise TimeoutError(f"the line is still there; the screen:\n{self.text()}")
            time.sleep(0.01)
        return self.code
