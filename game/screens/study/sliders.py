"""Sliders from 1 to 100, which stand nowhere until they are moved."""

from __future__ import annotations

from time import monotonic
from typing import ClassVar

from textual import work
from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.timer import Timer

from game.screens.canvas import BLANK, Canvas, Row
from game.screens.keyline import KeyLine
from game.screens.study.base import Column, Frame, StudyScreen, body, heading
from game.study.tasks import Asked, Sheet
from game.study.texts import Page

MIDDLE = 50
PAGE = 10
ROWS = 5
"""Rows of a slider with the space below it."""
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


class Sliders(Canvas):
    """All sliders of a page, one below the other."""

    COMPONENT_CLASSES: ClassVar[set[str]] = {
        "text", "active", "knob", "set", "faint", "quiet",
    }  # fmt: skip

    def __init__(self, sheet: Sheet) -> None:
        super().__init__([BLANK] * (ROWS * len(sheet.asked)), classes="sliders")
        self._sheet = sheet

    def show(self, values: dict[str, int], active: int) -> None:
        """Draw the sliders at `values`."""
        rows: list[Row] = []
        for number, asked in enumerate(self._sheet.asked):
            value = values.get(asked.item)
            rows += slider_rows(asked, value, self.size.width, active=number == active)
            rows += [BLANK] * (ROWS - len(rows) % ROWS)
        self.draw(rows)


class SlidersScreen(StudyScreen[bool]):
    """Goes on when every slider was moved."""

    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("right,l", "slide(1)", id="sliders.more", priority=True),
        Binding("left,h", "slide(-1)", id="sliders.less", priority=True),
        Binding("pageup", f"slide({PAGE})", id="sliders.much_more", priority=True),
        Binding("pagedown", f"slide(-{PAGE})", id="sliders.much_less", priority=True),
        Binding("home", "put('low')", id="sliders.least", priority=True),
        Binding("end", "put('high')", id="sliders.most", priority=True),
        Binding("up,shift+tab", "turn(-1)", id="sliders.previous", priority=True),
        Binding("down,tab", "turn(1)", id="sliders.next", priority=True),
        *(Binding(str(digit), f"digit({digit})") for digit in range(10)),
        Binding("enter", "go_on", id="sliders.go_on", priority=True),
    ]
    DEAF_S = 1.0

    def __init__(self, frame: Frame, page: Page, sheet: Sheet) -> None:
        super().__init__(frame)
        words = frame.words
        self._page = page
        self._sheet = sheet
        self._active = 0
        self._values = {
            asked.item: value for asked in sheet.asked if (value := sheet.value(asked)) is not None
        }
        self._typed_at = 0.0
        self._settling: Timer | None = None
        self._sliders = Sliders(sheet)
        self._keys = KeyLine(
            ("← →", words.move),
            ("PgUp PgDn", f"±{PAGE}"),
            ("0-9", words.number),
            ("↑ ↓", words.next),
            id="keys",
        )

    def content(self) -> ComposeResult:
        with Column(wide=True):
            yield heading(self._page)
            yield body(self._page)
            yield self._sliders
        yield self._keys

    def on_mount(self) -> None:
        super().on_mount()
        self._sheet.begin()
        self.call_after_refresh(self._show)

    def on_resize(self) -> None:
        self.call_after_refresh(self._show)

    @property
    def _asked(self) -> Asked:
        return self._sheet.asked[self._active]

    def _show(self) -> None:
        words = self.frame.words
        self._sliders.show(self._values, self._active)
        if len(self._values) == len(self._sheet.asked):
            self._keys.set_keys(("← →", words.move), ("↑ ↓", words.next), ("Enter", words.go_on))

    def action_slide(self, by: int) -> None:
        self._put(moved(self._values.get(self._asked.item), by, self._asked))

    def action_put(self, end: str) -> None:
        self._put(self._asked.low if end == "low" else self._asked.high)

    def action_digit(self, digit: int) -> None:
        """Digits make a number: 4 and then 2 at once is 42."""
        asked, before = self._asked, self._values.get(self._asked.item)
        number = digit
        if monotonic() - self._typed_at < SETTLED_S and before is not None:
            number = 10 * before + digit if 10 * before + digit <= asked.high else digit
        if asked.low <= number <= asked.high:
            self._typed_at = monotonic()
            self._put(number)

    def _put(self, value: int) -> None:
        self._values[self._asked.item] = value
        self._show()
        if self._settling is not None:
            self._settling.stop()
        self._settling = self.set_timer(SETTLED_S, self._settle)

    @work(group="answers")
    async def _settle(self) -> None:
        with self.kept():
            await self._save()

    async def _save(self) -> None:
        """Record every slider that stands elsewhere than was recorded."""
        for asked in self._sheet.asked:
            value = self._values.get(asked.item)
            if value is not None:
                await self._sheet.answer(asked, value)

    def action_turn(self, way: int) -> None:
        self._typed_at = 0.0
        self._active = (self._active + way) % len(self._sheet.asked)
        self._show()
        self._settle()

    async def action_go_on(self) -> None:
        missing = [
            number
            for number, asked in enumerate(self._sheet.asked)
            if asked.item not in self._values
        ]
        if missing:
            later = [number for number in missing if number > self._active]
            self.action_turn((later or missing)[0] - self._active)
            return
        with self.kept():
            await self._save()
            self.finish(True)
