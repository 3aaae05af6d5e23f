"""The floor of the benchmarks: an otherwise empty Textual app that repaints one cell a key."""

from __future__ import annotations

import os

os.environ.setdefault("TEXTUAL_FPS", "120")

from rich.segment import Segment
from textual.app import App, ComposeResult
from textual.events import Key
from textual.geometry import Region
from textual.strip import Strip
from textual.widget import Widget


class Cell(Widget):
    """One cell that is on or off."""

    lit = False

    def render_line(self, y: int) -> Strip:
        mark = "x" if self.lit and y == 0 else " "
        return Strip([Segment(mark.ljust(self.size.width))])


class Floor(App[None]):
    """Repaints its first cell at every key."""

    def compose(self) -> ComposeResult:
        yield Cell()

    def on_key(self, event: Key) -> None:
        event.stop()
        cell = self.query_one(Cell)
        cell.lit = not cell.lit
        cell.refresh(Region(0, 0, 1, 1))


if __name__ == "__main__":
    Floor().run(mouse=False)
