"""Statements to be agreed or disagreed with, on five named points."""

from __future__ import annotations

from typing import ClassVar

from textual.app import ComposeResult
from textual.binding import Binding, BindingType

from game.screens.canvas import BLANK, Canvas, Row, Run
from game.screens.keyline import KeyLine
from game.screens.study.base import Column, Frame, StudyScreen, body, heading
from game.study.tasks import Asked, Sheet
from game.study.texts import Page


def statement_rows(asked: Asked, value: int | None, *, active: bool) -> list[Row]:
    """The statement, and its points with their names side by side."""
    mark, style = ("▸ ", "active") if active else ("  ", "text")
    points: list[Run] = [("  ", "")]
    for number, name in enumerate(asked.anchors, start=1):
        picked = number == value
        points.append((f" {'●' if picked else '○'} {name} ", "chosen" if picked else "option"))
        points.append(("  ", ""))
    return [((mark, style), (asked.text, style)), tuple(points)]


class Statements(Canvas):
    """All statements of a page, one below the other."""

    COMPONENT_CLASSES: ClassVar[set[str]] = {"text", "active", "option", "chosen"}

    def __init__(self, sheet: Sheet) -> None:
        super().__init__(classes="statements")
        self._sheet = sheet
        self.show(0)

    def show(self, active: int) -> None:
        """Draw the answers given so far."""
        rows: list[Row] = []
        for number, asked in enumerate(self._sheet.asked):
            rows += statement_rows(asked, self._sheet.value(asked), active=number == active)
            rows += [BLANK, BLANK]
        self.draw(rows)


class LikertScreen(StudyScreen[bool]):
    """Goes on when every statement has its answer."""

    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("right,l", "slide(1)", id="likert.more", priority=True),
        Binding("left,h", "slide(-1)", id="likert.less", priority=True),
        Binding("up,k,shift+tab", "turn(-1)", id="likert.previous", priority=True),
        Binding("down,j,tab", "turn(1)", id="likert.next", priority=True),
        *(Binding(str(digit), f"pick({digit})") for digit in range(1, 10)),
        Binding("enter", "go_on", id="likert.go_on", priority=True),
    ]
    DEAF_S = 0.5

    def __init__(self, frame: Frame, page: Page, sheet: Sheet) -> None:
        super().__init__(frame)
        words = frame.words
        self._page = page
        self._sheet = sheet
        self._active = 0
        self._statements = Statements(sheet)
        self._keys = KeyLine(
            ("← →", words.answer), (f"1-{sheet.asked[0].high}", words.answer),
            ("↑ ↓", words.next), id="keys",
        )  # fmt: skip

    def content(self) -> ComposeResult:
        with Column(wide=True):
            yield heading(self._page)
            yield body(self._page)
            yield self._statements
        yield self._keys

    def on_mount(self) -> None:
        super().on_mount()
        self._sheet.begin()

    @property
    def _asked(self) -> Asked:
        return self._sheet.asked[self._active]

    async def action_slide(self, way: int) -> None:
        asked = self._asked
        value = self._sheet.value(asked)
        middle = (asked.low + asked.high) // 2
        await self._answer(
            middle if value is None else max(asked.low, min(asked.high, value + way))
        )

    async def action_pick(self, value: int) -> None:
        if value <= self._asked.high:
            await self._answer(value)

    async def _answer(self, value: int) -> None:
        with self.kept():
            await self._sheet.answer(self._asked, value)
            self._show()

    def action_turn(self, way: int) -> None:
        self._active = (self._active + way) % len(self._sheet.asked)
        self._show()

    def action_go_on(self) -> None:
        missing = [self._sheet.asked.index(asked) for asked in self._sheet.missing]
        if not missing:
            self.finish(True)
            return
        later = [number for number in missing if number > self._active]
        self.action_turn((later or missing)[0] - self._active)

    def _show(self) -> None:
        self._statements.show(self._active)
        if self._sheet.complete:
            words = self.frame.words
            self._keys.set_keys(("← →", words.answer), ("↑ ↓", words.next), ("Enter", words.go_on))
