"""A real Chromium, driven by its keys; what its terminal shows is read off the line."""

from __future__ import annotations

import asyncio
import json
import shutil
import time
from pathlib import Path
from typing import TYPE_CHECKING, Any, Self

from tests.terminal import Chunk, Ending
from tests.web.client import COLUMNS, ROWS
from tests.web.own_loop import own_loop

if TYPE_CHECKING:
    from playwright.async_api import Browser as PlaywrightBrowser
    from playwright.async_api import BrowserContext, Dialog, Page, Route, WebSocket

CHROMIUM = next(filter(None, map(shutil.which, ("chromium", "chromium-browser"))), None)
WINDOW = (1366, 768)
_KEYS = {
    "up": "ArrowUp",
    "down": "ArrowDown",
    "left": "ArrowLeft",
    "right": "ArrowRight",
    "enter": "Enter",
    "escape": "Escape",
    "space": "Space",
    "tab": "Tab",
    "backspace": "Backspace",
}


class Tab(Ending):
    """A tab of the browser. Its terminal is what the latest websocket brought."""

    def __init__(self, page: Page) -> None:
        super().__init__(COLUMNS, ROWS)
        self.page = page
        self.asked: list[str] = []
        """The addresses that the page has asked for."""
        self.complaints: list[str] = []
        """What the browser's console had to complain of."""
        self.sent: list[str] = []
        self.told: list[dict[str, Any]] = []
        self.lines = 0
        """How many websockets the page has opened."""
        self.dialogs = 0
        page.on("request", lambda request: self.asked.append(request.url))
        page.on("console", self._note_console)
        page.on("pageerror", lambda error: self.complaints.append(str(error)))
        page.on("websocket", self._note_line)
        page.on("dialog", self._note_dialog)

    def _note_console(self, message: Any) -> None:
        if message.type == "error":
            self.complaints.append(message.text)

    def _note_line(self, socket: WebSocket) -> None:
        self.lines += 1
        self.asked.append(socket.url.replace("ws", "http", 1))
        socket.on("framereceived", self._note_received)
        socket.on("framesent", lambda data: self.sent.append(str(data)))

    def _note_received(self, data: bytes | str) -> None:
        if isinstance(data, bytes):
            self.chunks.append(Chunk(time.perf_counter(), data))
        elif data != "!":
            self.told.append(json.loads(data))

    async def _note_dialog(self, dialog: Dialog) -> None:
        self.dialogs += 1
        await dialog.accept()

    @property
    def keys(self) -> list[str]:
        """What was typed into the line, without reports of the focus."""
        return [it[1:] for it in self.sent if it[0] == "k" and it[1:] not in ("\x1b[I", "\x1b[O")]

    # --- a terminal -----------------------------------------------------------------------------

    def press(self, *keys: str) -> None:
        for key in keys:
            if key in _KEYS:
                own_loop.run(self.page.keyboard.press(_KEYS[key]))
            else:
                own_loop.run(self.page.keyboard.type(key))

    def read_for(self, seconds: float) -> bool:
        time.sleep(seconds)
        return True

    def wait(self, seconds: float = 10) -> int:
        end = time.monotonic() + seconds
        while not self.told:
            if time.monotonic() > end:
                raise TimeoutError(f"the program still runs; the screen:\n{self.text()}")
            time.sleep(0.02)
        status: int = self.told[-1]["status"]
        return status

    # --- a page ---------------------------------------------------------------------------------

    def open(self, address: str) -> int:
        """Go to a page; the status of the answer, 0 where nobody was asked."""
        answer = own_loop.run(self.page.goto(address))
        return answer.status if answer is not None else 0

    def stand_in(self, address: str, says: str) -> None:
        """Answer for another site."""

        async def answer(route: Route) -> None:
            await route.fulfill(body=says, content_type="text/plain")

        own_loop.run(self.page.route(f"{address}**", answer))

    def before_each_page(self, script: str) -> None:
        """Run a script before any of a page's own."""
        own_loop.run(self.page.add_init_script(script))

    def reload(self) -> None:
        """Press the browser's own key for it, and agree to leave."""
        own_loop.run(self.page.reload())

    def notice(self) -> str:
        """The heading of what lies over the terminal; empty where nothing does."""
        found = self.evaluate(
            "document.querySelector('#notice:not([hidden]) h1')?.textContent ?? ''"
        )
        return str(found)

    def wait_for_notice(self, heading: str, seconds: float = 30) -> None:
        """Wait for a notice, or with "" until there is none. Raises TimeoutError."""
        end = time.monotonic() + seconds
        while (shown := self.notice()) != heading:
            if time.monotonic() > end:
                raise TimeoutError(f"{heading!r} did not come up, but {shown!r}")
            time.sleep(0.05)

    def evaluate(self, script: str) -> Any:
        return own_loop.run(self.page.evaluate(script))

    def click(self, what: str) -> None:
        own_loop.run(self.page.click(what))

    def resize(self, width: int, height: int) -> None:
        own_loop.run(self.page.set_viewport_size({"width": width, "height": height}))

    def picture(self, path: Path) -> None:
        own_loop.run(self.page.screenshot(path=path))

    def wheel(self, pixels: int) -> None:
        """Turn the wheel over the middle of the page."""
        own_loop.run(self.page.mouse.move(400, 300))
        own_loop.run(self.page.mouse.wheel(0, pixels))

    def close(self) -> None:
        own_loop.run(self.page.close())


class Chromium:
    """The browser without windows. Use as a context manager."""

    def __enter__(self) -> Self:
        own_loop.run(self._start(), 60)
        return self

    async def _start(self) -> None:
        from playwright.async_api import async_playwright

        self._playwright = await async_playwright().start()
        self._browser: PlaywrightBrowser = await self._playwright.chromium.launch(
            executable_path=CHROMIUM, args=["--no-sandbox", "--disable-dev-shm-usage"]
        )

    def __exit__(self, *_: object) -> None:
        own_loop.run(self._stop())

    async def _stop(self) -> None:
        await self._browser.close()
        await self._playwright.stop()

    def person(self, size: tuple[int, int] = WINDOW) -> BrowserContext:
        """Someone's browser, which shares nothing with another's."""
        width, height = size
        return own_loop.run(self._browser.new_context(viewport={"width": width, "height": height}))

    def tab(self, person: BrowserContext | None = None, size: tuple[int, int] = WINDOW) -> Tab:
        """A new tab, in somebody's browser or in a new one."""

        async def new() -> Tab:
            return Tab(await within.new_page())

        within = person or self.person(size)
        return own_loop.run(new())


class Wire:
    """What lies between a browser and a server: it can be cut, or hold back all that is sent."""

    def __init__(self, port: int) -> None:
        self._to = port
        self._writers: set[asyncio.StreamWriter] = set()
        self._flows = asyncio.Event()
        self._cut = False

    def __enter__(self) -> Self:
        own_loop.run(self._start())
        return self

    def __exit__(self, *_: object) -> None:
        own_loop.run(self._stop())

    async def _start(self) -> None:
        self._flows.set()
        self._server = await asyncio.start_server(self._carry, "127.0.0.1", 0)
        self.port: int = self._server.sockets[0].getsockname()[1]
        self.address = f"http://localhost:{self.port}/"

    async def _stop(self) -> None:
        self._server.close()
        self._break()

    def _break(self) -> None:
        for writer in list(self._writers):
            writer.transport.abort()

    async def _carry(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        if self._cut:
            writer.transport.abort()
            return
        far_reader, far_writer = await asyncio.open_connection("127.0.0.1", self._to)
        self._writers |= {writer, far_writer}
        await asyncio.gather(self._pour(reader, far_writer), self._pour(far_reader, writer))
        self._writers -= {writer, far_writer}

    async def _pour(self, source: asyncio.StreamReader, drain: asyncio.StreamWriter) -> None:
        try:
            while data := await source.read(65536):
                await self._flows.wait()
                drain.write(data)
                await drain.drain()
        except ConnectionError:
            pass
        finally:
            drain.close()

    def cut(self) -> None:
        """Break every connection, and refuse new ones until `mend`."""

        async def cut() -> None:
            self._cut = True
            self._break()

        own_loop.run(cut())

    def mend(self) -> None:
        self._cut = False

    def hold(self, *, back: bool) -> None:
        """Hold back everything that is sent, or let it flow."""

        async def hold() -> None:
            self._flows.clear() if back else self._flows.set()

        own_loop.run(hold())
