"""The web server: one page, what it is made of, and a line to a program for each visitor."""

from __future__ import annotations

import asyncio
import html
import ipaddress
import logging
import re
import socket
from collections.abc import Awaitable, Callable
from hashlib import sha256
from importlib import resources
from importlib.resources.abc import Traversable
from string import Template
from urllib.parse import urlsplit

import msgspec
from aiohttp import WSCloseCode, WSMsgType, web

from game.errors import AnaError
from game.study.texts import BrowserPage
from game.web.doors import Door
from game.web.hosted import MOST_MESSAGE_BYTES, Goodbye, Hosted, Line, NoRoom, Room

HEARTBEAT_S = 15.0
CLOSING_S = 2.0
REPAINT_KEYS = 20
"""To paint everything costs about as much as so many keys."""
_TAB = re.compile(r"[A-Za-z0-9]{8,40}")
_OURS, _THEIRS = resources.files("game.web") / "page", "textual_serve"
_TYPES = {
    "js": "text/javascript",
    "css": "text/css",
    "ttf": "font/ttf",
    "svg": "image/svg+xml",
}
_HEADERS = {
    "Cache-Control": "no-store",
    "Cross-Origin-Opener-Policy": "same-origin",
    "Cross-Origin-Resource-Policy": "same-origin",
    "Referrer-Policy": "no-referrer",
    "X-Content-Type-Options": "nosniff",
    "X-Frame-Options": "DENY",
    "Content-Security-Policy": (
        "default-src 'none'; script-src 'self'; style-src 'self' 'unsafe-inline'; "
        "font-src 'self'; img-src 'self' data:; connect-src 'self'; base-uri 'none'; "
        "form-action 'none'; frame-ancestors 'none'"
    ),
}
_LOGGER = logging.getLogger(__name__)
_Handler = Callable[[web.Request], Awaitable[web.StreamResponse]]


class WebServer:
    """The pages behind one door. `hosts` are the names that it may be reached by, besides those of
    the loopback and, unless it listens there alone, the numbers and the name of this computer."""

    def __init__(self, door: Door, room: Room, hosts: frozenset[str], *, loopback: bool) -> None:
        self.door, self.room = door, room
        self._hosts, self._loopback = hosts, loopback
        self._files = _files()
        self._page = (_OURS / "page.html").read_text(encoding="utf-8")

    def application(self) -> web.Application:
        """All of it, as aiohttp runs it."""
        app = web.Application(middlewares=[self._guard], client_max_size=MOST_MESSAGE_BYTES)
        app.router.add_get("/", self._start)
        app.router.add_get("/line", self._line)
        app.router.add_get("/static/{name}", self._static)
        app.on_shutdown.append(self._close)
        return app

    # --- guarding -------------------------------------------------------------------------------

    @web.middleware
    async def _guard(self, request: web.Request, handler: _Handler) -> web.StreamResponse:
        if not self._known(request.host):
            return web.Response(status=421, text="This server has another name.", headers=_HEADERS)
        try:
            response = await handler(request)
        except web.HTTPException as error:
            return web.Response(status=error.status, text=error.reason, headers=_HEADERS)
        except Exception:
            _LOGGER.exception("a request failed")
            return web.Response(status=500, text="Something went wrong.", headers=_HEADERS)
        if not response.prepared:
            for name, value in _HEADERS.items():
                response.headers.setdefault(name, value)
        return response

    def _known(self, host: str) -> bool:
        """Whether a request's Host is a name of ours: a foreign name that was made to lead here
        would let another site's pages in."""
        try:
            name = urlsplit(f"//{host}").hostname or ""
        except ValueError:
            return False
        if name == "localhost" or name in self._hosts:
            return True
        try:
            address = ipaddress.ip_address(name)
        except ValueError:
            return not self._loopback and name == socket.gethostname().lower()
        return address.is_loopback or not self._loopback

    # --- the page -------------------------------------------------------------------------------

    async def _start(self, request: web.Request) -> web.Response:
        try:
            ticket = await asyncio.to_thread(self.door.ticket, dict(request.query))
        except AnaError:
            return self._whole_page("", self.door.words.wrong_link, 403)
        return self._whole_page(ticket)

    def _whole_page(
        self, ticket: str, notice: BrowserPage | None = None, status: int = 200
    ) -> web.Response:
        door = self.door
        told = {
            "ticket": ticket,
            "columns": door.size.columns,
            "rows": door.size.rows,
            "words": msgspec.to_builtins(door.words),
        }
        page = Template(self._page).substitute(
            title=html.escape(door.title),
            language=html.escape(door.language),
            told=html.escape(msgspec.json.encode(told).decode()) if notice is None else "",
            heading=html.escape(notice.title) if notice else "",
            body=html.escape(notice.body.strip()) if notice else "",
            shown="" if notice else "hidden",
        )
        return web.Response(text=page, content_type="text/html", status=status)

    async def _static(self, request: web.Request) -> web.Response:
        name = request.match_info["name"]
        if name not in self._files:
            raise web.HTTPNotFound
        body = self._files[name]
        mark = sha256(body).hexdigest()[:16]
        headers = _HEADERS | {"Cache-Control": "no-cache", "ETag": f'"{mark}"'}
        if any(known.value == mark for known in request.if_none_match or ()):
            return web.Response(status=304, headers=headers)
        return web.Response(
            body=body, content_type=_TYPES[name.rpartition(".")[2]], headers=headers
        )

    # --- the line -------------------------------------------------------------------------------

    async def _line(self, request: web.Request) -> web.StreamResponse:
        """Output of the program in binary messages; from the page, text: `k` and keys, `r` to be
        painted anew, `c` while nobody sees it, `?` to be answered with `!`."""
        if not _same_site(request.headers.get("Origin", ""), request.host):
            raise web.HTTPForbidden
        tab = request.query.get("tab", "")
        if not _TAB.fullmatch(tab):
            raise web.HTTPForbidden
        try:
            visitor = self.door.visitor(request.query.get("ticket", ""), tab)
        except AnaError as error:
            raise web.HTTPForbidden from error
        channel = web.WebSocketResponse(
            heartbeat=HEARTBEAT_S, max_msg_size=MOST_MESSAGE_BYTES, compress=False, timeout=1.0
        )
        await channel.prepare(request)
        try:
            hosted = await self.room.enter(visitor)
        except (NoRoom, OSError):
            await channel.close(code=Goodbye.FULL)
            return channel
        line = self.room.line(channel, request.transport)
        try:
            await hosted.attach(line)
            listening = asyncio.create_task(self._listen(channel, hosted, line))
            closing = asyncio.create_task(line.closing.wait())
            await asyncio.wait({listening, closing}, return_when=asyncio.FIRST_COMPLETED)
            for task in (listening, closing):
                task.cancel()
            await asyncio.gather(listening, closing, return_exceptions=True)
            await self._close_line(channel, line)
        finally:
            hosted.detach(line)
        return channel

    @staticmethod
    async def _close_line(channel: web.WebSocketResponse, line: Line) -> None:
        """Does not wait long for a browser that reads nothing."""
        try:
            async with asyncio.timeout(CLOSING_S):
                await channel.close(code=line.why or WSCloseCode.OK)
        except TimeoutError:
            if line.transport is not None:
                line.transport.abort()

    @staticmethod
    async def _listen(channel: web.WebSocketResponse, hosted: Hosted, line: Line) -> None:
        async for message in channel:
            if message.type is not WSMsgType.TEXT:
                break
            kind, keys = message.data[:1], message.data[1:]
            if kind == "k":
                hosted.press(line, keys)
            elif kind == "?":
                if line.keys.take(1):
                    await channel.send_str("!")
            elif hosted.line is not line or not line.keys.take(REPAINT_KEYS):
                continue
            elif kind == "r":
                await hosted.repaint(line)
            elif kind == "c":
                hosted.cover()

    async def _close(self, _: web.Application) -> None:
        await self.room.close()


def _same_site(origin: str, host: str) -> bool:
    """Whether a page came from where its request goes to."""
    scheme, _, name = origin.lower().partition("://")
    port = {"http": ":80", "https": ":443"}.get(scheme)
    return port is not None and name.removesuffix(port) == host.lower().removesuffix(port)


def _files() -> dict[str, bytes]:
    """Everything a page is made of, by name; nothing else is ever served."""
    static = resources.files(_THEIRS) / "static"
    places: dict[str, Traversable] = {
        "textual.js": static / "js" / "textual.js",
        "xterm.css": static / "css" / "xterm.css",
        "font.ttf": static / "fonts" / "RobotoMono-VariableFont_wght.ttf",
        **{name: _OURS / name for name in ("page.js", "page.css", "icon.svg")},
    }
    return {name: place.read_bytes() for name, place in places.items()}
