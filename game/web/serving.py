"""Running the web server until it is told to stop."""

from __future__ import annotations

import asyncio
import ipaddress
import logging
import signal
from collections.abc import Callable
from urllib.parse import urlsplit

from aiohttp import web

from game.errors import AnaError
from game.web.doors import Door
from game.web.hosted import Limits, Room
from game.web.server import WebServer


def serve(
    door: Door,
    host: str,
    port: int,
    *,
    url: str = "",
    limits: Limits | None = None,
    ready: Callable[[str], None] = lambda _: None,
) -> None:
    """Serve until SIGINT, SIGTERM or, unless that is ignored, SIGHUP; every program is hung up on
    before this returns.

    `url` is the address that people reach the server at, where that is another; `ready` is called
    with the address once it listens. Raises AnaError where it cannot listen.
    """
    asyncio.run(_serve(door, host, port, url, limits or Limits(), ready))


async def _serve(
    door: Door, host: str, port: int, url: str, limits: Limits, ready: Callable[[str], None]
) -> None:
    names = frozenset({host.lower(), (urlsplit(url).hostname or host).lower()})
    server = WebServer(door, Room(limits), names, loopback=is_loopback(host))
    runner = web.AppRunner(
        server.application(),
        access_log=None,
        logger=_nameless(),
        handle_signals=False,
        shutdown_timeout=1.0,
    )
    await runner.setup()
    stop = asyncio.Event()
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        if number is signal.SIGHUP and signal.getsignal(number) is signal.SIG_IGN:
            continue  # nohup: it is to go on without its terminal
        asyncio.get_running_loop().add_signal_handler(number, stop.set)
    try:
        try:
            await web.TCPSite(runner, host, port).start()
        except OSError as error:
            raise AnaError(
                f"this address cannot be listened on ({error.strerror or error})",
                place=f"{host}, port {port}",
                hint="Choose another with --port",
            ) from error
        number = runner.addresses[0][1]
        ready(url or f"http://{'localhost' if is_loopback(host) else _bracketed(host)}:{number}/")
        await stop.wait()
    finally:
        await runner.cleanup()


def _nameless() -> logging.Logger:
    """What aiohttp would log names the address of whoever asked."""
    logger = logging.Logger("nowhere")
    logger.addHandler(logging.NullHandler())
    return logger


def is_loopback(host: str) -> bool:
    """Whether only this computer can reach `host`."""
    try:
        return ipaddress.ip_address(host).is_loopback
    except ValueError:
        return host == "localhost"


def _bracketed(host: str) -> str:
    return f"[{host}]" if ":" in host else host
