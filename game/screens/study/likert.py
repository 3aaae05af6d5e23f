"""Statements to be agreed or disagreed with, on five named points."""

from __future__ import annotations

from typing import ClassVar

from textual.binding import Binding, BindingType

from game.screens.study.base import Frame
from game.screens.study.sheet import SheetScreen
from game.screens.widgets.canvas import Row, Run
from game.study.protocol.tasks import Asked, Sheet
from game.study.texts import Page


def statement_rows(asked: Asked, value: int | None, _columns: int, *, active: bool) -> list[Row]:
    """The statement, and its points with their names side by side."""
    mark, style = ("▸ ", "active") if active else ("  ", "text")
    points: list[Run] = [("  ", "")]
    for number, name in enumerate(asked.anchors, start=1):
        picked = number == value
        points.append((f" {'●' if picked else '○'} {name} ", "chosen" if picked else "option"))
        points.append(("  ", ""))
    return [((mark, style), (asked.text, style)), tuple(points)]


class LikertScreen(SheetScreen):
    """Every answer is recorded before it is shown."""

    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("right,l", "slide(1)", id="likert.more", priority=True),
        Binding("left,h", "slide(-1)", id="likert.less", priority=True),
        Binding("up,k,shift+tab", "turn(-1)", id="likert.previous", priority=True),
        Binding("down,j,tab", "turn(1)", id="likert.next", priority=True),
        *(Binding(str(digit), f"pick({digit})", priority=True) for digit in range(1, 10)),
        Binding("enter", "go_on", id="likert.go_on", priority=True),
    ]
    DEAF_S = 0.5

    def __init__(self, frame: Frame, page: Page, sheet: Sheet) -> None:
        answer = frame.words.answer
        digits = f"1-{sheet.asked[0].high}"
        super().__init__(frame, page, sheet, statement_rows, ("← →", answer), (digits, answer))

    async def action_slide(self, way: int) -> None:
        asked = self.asked
        value = self._sheet.value(asked)
        middle = (asked.low + asked.high) // 2
        await self._answer(
            middle if value is None else max(asked.low, min(asked.high, value + way))
        )

    async def action_pick(self, value: int) -> None:
        if value <= self.asked.high:
            await self._answer(value)

    async def _answer(self, value: int) -> None:
        with self.kept():
            await self._sheet.answer(self.asked, value)
            self.show()
