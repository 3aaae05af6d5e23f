"""The line over a timed task: what it is, and how much time is left."""

from __future__ import annotations

from typing import ClassVar

from rich.cells import cell_len

from game.screens.widgets.canvas import Canvas
from game.screens.widgets.statuspanel import clock_text

TICK_S = 0.2
"""How often a timed task looks at the clock."""
BAR_COLUMNS = 30


class TimeLine(Canvas):
    """A title on the left, the time left on the right; repainted only when it changes."""

    COMPONENT_CLASSES: ClassVar[set[str]] = {"title", "clock", "time", "faint", "quiet"}

    def __init__(self, title: str, left: str, limit_ms: int) -> None:
        super().__init__([()], classes="timeline")
        self._title = title
        self._left = left
        self._limit_ms = limit_ms

    def show(self, left_ms: int) -> None:
        """Draw the time left."""
        gone = BAR_COLUMNS - BAR_COLUMNS * left_ms // self._limit_ms
        bar = ("━" * (BAR_COLUMNS - gone), "time"), ("─" * gone, "faint")
        clock = f" {clock_text(left_ms)} "
        right = BAR_COLUMNS + 2 + len(clock) + 1 + cell_len(self._left)
        gap = " " * max(1, self.size.width - cell_len(self._title) - right)
        title = (self._title, "title"), (gap, "title")
        self.draw([(*title, *bar, ("  ", "faint"), (clock, "clock"), (f" {self._left}", "quiet"))])
