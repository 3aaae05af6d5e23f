"""Statements to be agreed or disagreed with, on five named points."""

from __future__ import annotations

from typing import ClassVar

from rich.cells import cell_len
from textual.binding import Binding, BindingType

from game.screens.study.base import Frame
from game.screens.study.sheet import SheetScreen
from game.screens.widgets.canvas import Row, Run, unbroken, wrapped
from game.study.protocol.tasks import Asked, Sheet
from game.study.texts import Page


def statement_rows(
    asked: Asked, value: int | None, columns: int, *, active: bool, typing: bool = False
) -> list[Row]:
    """The statement, and its points with their names: side by side, in as many columns where they
    must be wrapped, or below each other where a word would have to be broken."""
    mark, style = ("▸ ", "active") if active else ("  ", "text")
    lines = wrapped(asked.text, max(10, columns - 2))
    head: list[Row] = [
        ((mark if n == 0 else "  ", style), (line, style)) for n, line in enumerate(lines)
    ]
    styles = ["chosen" if n == value else "option" for n in range(1, len(asked.anchors) + 1)]
    signs = ["●" if n == value else "○" for n in range(1, len(asked.anchors) + 1)]
    points = [_point(sign, name) for sign, name in zip(signs, asked.anchors, strict=True)]
    if sum(cell_len(point) + 2 for point in points) <= columns:
        side: list[Run] = [("  ", "")]
        for point, look in zip(points, styles, strict=True):
            side += [(point, look), ("  ", "")]
        return [*head, tuple(side)]
    room = (columns - 2) // len(points) - 1
    longest = max(cell_len(piece) for name in asked.anchors for piece in unbroken(name))
    if room - 4 < longest:
        return [
            *head,
            *(
                row
                for point, look in zip(points, styles, strict=True)
                for row in _block(point, look, columns - 2, indent=2)
            ),
        ]
    blocks = [_block(point, look, room) for point, look in zip(points, styles, strict=True)]
    tall = max(map(len, blocks))
    rows: list[Row] = []
    for line in range(tall):
        row: list[Run] = [("  ", "")]
        for block, look in zip(blocks, styles, strict=True):
            blank: Row = ((" " * room, look),)
            row += [*(block[line] if line < len(block) else blank), (" ", "")]
        rows.append(tuple(row))
    return [*head, *rows]


def _point(sign: str, name: str) -> str:
    return f" {sign} {name} "


def _block(point: str, style: str, columns: int, *, indent: int = 0) -> list[Row]:
    """A point in lines of `columns`, of which all but the first stand under its name."""
    sign, name = point[:3], point[3:-1]
    rows: list[Row] = []
    for number, line in enumerate(wrapped(name, max(1, columns - 4)) or [""]):
        text = f"{sign if number == 0 else '   '}{line} "
        filled = text + " " * (columns - cell_len(text))
        rows.append(((" " * indent, ""), (filled, style)) if indent else ((filled, style),))
    return rows


class LikertScreen(SheetScreen):
    """Every answer is recorded before it is shown."""

    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("right,l", "slide(1)", id="likert.more", priority=True),
        Binding("left,h", "slide(-1)", id="likert.less", priority=True),
        Binding("up,k,shift+tab", "turn(-1)", id="likert.previous", priority=True),
        Binding("down,j,tab", "turn(1)", id="likert.next", priority=True),
        *(Binding(str(digit), f"pick({digit})", priority=True) for digit in range(1, 10)),
        Binding("pageup", "page(-1)", id="likert.page_up", priority=True),
        Binding("pagedown", "page(1)", id="likert.page_down", priority=True),
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
        await self.answer(middle if value is None else max(asked.low, min(asked.high, value + way)))

    async def action_pick(self, value: int) -> None:
        if value <= self.asked.high:
            await self.answer(value)
