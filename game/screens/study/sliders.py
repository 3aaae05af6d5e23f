"""Sliders from 1 to 100, which stand nowhere until they are moved."""

from __future__ import annotations

from time import monotonic
from typing import ClassVar

from textual import work
from textual.binding import Binding, BindingType
from textual.timer import Timer

from game.screens.study.base import Frame
from game.screens.study.sheet import SheetScreen
from game.screens.widgets.canvas import Row
from game.study.protocol.tasks import Asked, Sheet
from game.study.texts import Page

MIDDLE = 50
PAGE = 10
SETTLED_S = 0.7
"""A slider left alone for so long is an answer; also how long a second digit is waited for."""


def moved(value: int | None, by: int, asked: Asked) -> int:
    """The value after a step; the first step leads to the middle."""
    return MIDDLE if value is None else max(asked.low, min(asked.high, value + by))


def slider_rows(asked: Asked, value: int | None, columns: int, *, active: bool) -> list[Row]:
    """The question, the track with its knob, and the two anchors."""
    low, high = asked.anchors
    shown = "–" if value is None else str(value)
    mark, style = ("▸ ", "active") if active else ("  ", "text")
    track = max(2, columns - 8)
    head: Row = ((mark, style), (asked.text, style))
    line: Row
    if value is None:
        line = (("  ", ""), ("─" * track, "faint"), (f"{shown:>5} ", "faint"))
    else:
        at = round((value - asked.low) / (asked.high - asked.low) * (track - 1))
        knob = "knob" if active else "set"
        line = (
            ("  ", ""),
            ("━" * at, knob),
            ("●", knob),
            ("─" * (track - 1 - at), "faint"),
            (f"{shown:>5} ", "active" if active else "text"),
        )
    gap = max(1, track - len(low) - len(high))
    return [head, line, (("  ", ""), (low + " " * gap + high, "quiet"))]


class SlidersScreen(SheetScreen):
    """Where a slider was left alone for a while, or another one is turned to, is recorded."""

    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("right,l", "slide(1)", id="sliders.more", priority=True),
        Binding("left,h", "slide(-1)", id="sliders.less", priority=True),
        Binding("pageup", f"slide({PAGE})", id="sliders.much_more", priority=True),
        Binding("pagedown", f"slide(-{PAGE})", id="sliders.much_less", priority=True),
        Binding("home", "put('low')", id="sliders.least", priority=True),
        Binding("end", "put('high')", id="sliders.most", priority=True),
        Binding("up,shift+tab", "turn(-1)", id="sliders.previous", priority=True),
        Binding("down,tab", "turn(1)", id="sliders.next", priority=True),
        *(Binding(str(digit), f"digit({digit})", priority=True) for digit in range(10)),
        Binding("enter", "go_on", id="sliders.go_on", priority=True),
    ]
    DEAF_S = 1.0

    def __init__(self, frame: Frame, page: Page, sheet: Sheet) -> None:
        words = frame.words
        keys = ("← →", words.move), ("PgUp PgDn", f"±{PAGE}"), ("0-9", words.number)
        super().__init__(frame, page, sheet, slider_rows, *keys)
        self._values = {
            asked.item: value for asked in sheet.asked if (value := sheet.value(asked)) is not None
        }
        self._typed_at = 0.0
        self._settling: Timer | None = None

    @property
    def values(self) -> list[int | None]:
        return [self._values.get(asked.item) for asked in self._sheet.asked]

    def action_slide(self, by: int) -> None:
        self._put(moved(self._values.get(self.asked.item), by, self.asked))

    def action_put(self, end: str) -> None:
        self._put(self.asked.low if end == "low" else self.asked.high)

    def action_digit(self, digit: int) -> None:
        """Digits make a number: 4 and then 2 at once is 42."""
        asked, before = self.asked, self._values.get(self.asked.item)
        number = digit
        if monotonic() - self._typed_at < SETTLED_S and before is not None:
            number = 10 * before + digit if 10 * before + digit <= asked.high else digit
        if asked.low <= number <= asked.high:
            self._typed_at = monotonic()
            self._put(number)

    def _put(self, value: int) -> None:
        self._values[self.asked.item] = value
        self.show()
        if self._settling is not None:
            self._settling.stop()
        self._settling = self.set_timer(SETTLED_S, self._settle)

    @work(group="answers")
    async def _settle(self) -> None:
        with self.kept():
            await self.save()

    async def save(self) -> None:
        """Record every slider that stands elsewhere than was recorded."""
        for asked in self._sheet.asked:
            value = self._values.get(asked.item)
            if value is not None:
                await self._sheet.answer(asked, value)

    def action_turn(self, way: int) -> None:
        self._typed_at = 0.0
        super().action_turn(way)
        self._settle()
