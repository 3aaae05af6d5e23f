"""What the tests that press keys on screens share."""

from __future__ import annotations

import asyncio
from typing import Any

from textual.pilot import Pilot
from textual.screen import Screen

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
