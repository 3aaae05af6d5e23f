"""Sliders from 1 to 100, which stand nowhere until they are moved."""

from __future__ import annotations

from itertools import zip_longest
from time import monotonic
from typing import ClassVar

from rich.cells import cell_len
from textual.binding import Binding, BindingType
from textual.timer import Timer

from game.screens.study.base import Frame
from game.screens.study.sheet import SheetScreen
from game.screens.widgets.canvas import Row, wrapped
from game.study.protocol.tasks import Asked, Sheet
from game.study.texts import Page

MIDDLE = 50
STEP = 10
CURSOR = "▏"
TYPED_S = 1.5
"""Digits typed within so long of each other are one number."""


def moved(value: int | None, by: int, asked: Asked) -> int:
    """The value after a step; the first step leads to the middle."""
    return MIDDLE if value is None else max(asked.low, min(asked.high, value + by))


def slider_rows(
    asked: Asked, value: int | None, columns: int, *, active: bool, typing: bool = False
) -> list[Row]:
    """The question, the track with its knob, and the two anchors."""
    mark, style = ("▸ ", "active") if active else ("  ", "text")
    lines = wrapped(asked.text, max(10, columns - 2))
    rows: list[Row] = [
        ((mark if number == 0 else "  ", style), (line, style)) for number, line in enumerate(lines)
    ]
    track = max(2, columns - 8)
    shown = "–" if value is None else str(value)
    number = f"{shown:>5}{CURSOR if typing else ' '}"
    if value is None:
        rows.append((("  ", ""), ("─" * track, "faint"), (number, "faint")))
    else:
        at = round((value - asked.low) / (asked.high - asked.low) * (track - 1))
        knob = "knob" if active else "set"
        rows.append(
            (
                ("  ", ""),
                ("━" * at, knob),
                ("●", knob),
                ("─" * (track - 1 - at), "faint"),
                (number, "active" if active else "text"),
            )
        )
    return [*rows, *anchor_rows(asked.anchors[0], asked.anchors[1], track)]


def anchor_rows(low: str, high: str, columns: int) -> list[Row]:
    """The names of the ends, each under its own: on a line where they fit, else wrapped."""
    half = columns if cell_len(low) + cell_len(high) + 2 <= columns else max(4, columns // 2 - 2)
    rows: list[Row] = []
    for left, right in zip_longest(wrapped(low, half), wrapped(high, half), fillvalue=""):
        gap = " " * max(0, columns - cell_len(left) - cell_len(right))
        rows.append((("  ", ""), (left + gap + right, "quiet")))
    return rows


class SlidersScreen(SheetScreen):
    """Each place a slider is moved to is recorded before it is shown there."""

    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("right,l", "slide(1)", id="sliders.more", priority=True),
        Binding("left,h", "slide(-1)", id="sliders.less", priority=True),
        Binding("pageup", "leap(-1)", id="sliders.much_more", priority=True),
        Binding("pagedown", "leap(1)", id="sliders.much_less", priority=True),
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
        super().__init__(
            frame, page, sheet, slider_rows, ("← →", words.move), ("0-9", words.number)
        )
        self._typed_at: float | None = None
        self._settling: Timer | None = None

    @property
    def typing(self) -> bool:
        return self._typed_at is not None and monotonic() - self._typed_at < TYPED_S

    def show_keys(self, *keys: tuple[str, str], remark: str = "") -> None:
        leap = () if self.scrolls else ((self.frame.keys.page, f"±{STEP}"),)
        super().show_keys(*keys, *leap, remark=remark)

    async def action_slide(self, by: int) -> None:
        self._typed_at = None
        await self.answer(moved(self._sheet.value(self.asked), by, self.asked))

    async def action_leap(self, way: int) -> None:
        """Scroll; where there is nothing to scroll, move the slider a long way."""
        if self.scrolls:
            self.action_page(way)
        else:
            await self.action_slide(-way * STEP)

    async def action_put(self, end: str) -> None:
        self._typed_at = None
        await self.answer(self.asked.low if end == "low" else self.asked.high)

    async def action_digit(self, digit: int) -> None:
        """Digits make a number: 4 and then 2 is 42."""
        asked, before = self.asked, self._sheet.value(self.asked)
        number = digit
        if self.typing and before is not None:
            number = 10 * before + digit if 10 * before + digit <= asked.high else digit
        if not asked.low <= number <= asked.high:
            return
        typed_at, self._typed_at = self._typed_at, monotonic()
        if not await self.answer(number):
            self._typed_at = typed_at
            return
        if self._settling is not None:
            self._settling.stop()
        self._settling = self.set_timer(TYPED_S, self.show)

    def turn_to(self, number: int) -> None:
        self._typed_at = None
        super().turn_to(number)

    def action_page(self, way: int) -> None:
        self._typed_at = None
        super().action_page(way)
