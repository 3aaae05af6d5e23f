"""What the tests that press keys on screens share."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from contextlib import AbstractAsyncContextManager
from typing import Any

from textual import events
from textual.pilot import Pilot
from textual.screen import Screen

from game.screens.play.app import AnaApp
from game.screens.widgets.canvas import Canvas, plain

Open = Callable[..., AbstractAsyncContextManager[tuple[AnaApp, Pilot[None]]]]
"""The fixture `open_app`."""
PATIENCE_S = 20.0
_POLL_S = 0.02


async def until(pilot: Pilot[Any], kind: type[Screen[Any]]) -> Any:
    """Wait until a screen of this kind is on top, and give it."""
    for _ in range(round(PATIENCE_S / _POLL_S)):
        if isinstance(pilot.app.screen, kind):
            await pilot.pause()
            return pilot.app.screen
        await asyncio.sleep(_POLL_S)
    raise AssertionError(f"{pilot.app.screen} is shown, not {kind.__name__}")


def painted(screen: Screen[Any]) -> str:
    """All that stands in the window."""
    lines = screen._compositor.render_strips(screen.app.size)
    return "\n".join(strip.text for strip in lines)


async def press(pilot: Pilot[None], *keys: str) -> None:
    """Press keys as the terminal would send them: quicker than `pilot.press`."""
    for key in keys:
        character = " " if key == "space" else key if len(key) == 1 else None
        pilot.app.post_message(events.Key(key, character))
        await pilot.pause()


def shown(screen: Screen[Any]) -> str:
    """All that the canvases of a screen show."""
    return "\n".join(line for canvas in screen.query(Canvas) for line in plain(canvas.rows))
