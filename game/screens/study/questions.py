"""The items of a form, drawn one below the other."""

from __future__ import annotations

from collections.abc import Sequence
from typing import ClassVar

from game.forms.items import HeadingItem, Item
from game.screens.study.question_rows import AnswerLook, item_rows
from game.screens.widgets.canvas import BLANK, Canvas, Row


class Questions(Canvas):
    """The items of a form, one below the other."""

    COMPONENT_CLASSES: ClassVar[set[str]] = {
        "text", "active", "quiet", "option", "chosen", "marked", "knob", "set", "faint", "field",
        "heading",
    }  # fmt: skip

    def __init__(self) -> None:
        super().__init__()
        self.spans: dict[str, range] = {}
        """The rows of each question that is shown."""
        self.headings: list[tuple[str, range]] = []
        """Each heading with its rows, from the top."""

    def show(self, items: Sequence[Item], looks: dict[str, AnswerLook]) -> None:
        """Draw the items, and each question as it looks."""
        rows: list[Row] = []
        self.spans, self.headings = {}, []
        for item in items:
            if isinstance(item, HeadingItem):
                head = item_rows(item, AnswerLook(), self.size.width)
                self.headings.append((item.text, range(len(rows), len(rows) + len(head))))
                rows += [*head, BLANK]
                continue
            block = item_rows(item, looks[item.id], self.size.width)
            self.spans[item.id] = range(len(rows), len(rows) + len(block))
            rows += [*block, BLANK, BLANK]
        while rows and not rows[-1]:
            rows.pop()
        self.draw(rows)
