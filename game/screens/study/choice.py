"""One of several answers: nothing is chosen beforehand."""

from __future__ import annotations

from collections.abc import Awaitable, Callable, Sequence
from typing import ClassVar

from rich.cells import cell_len
from textual.binding import Binding, BindingType
from textual.widgets import Static

from game.screens.study.base import Frame, StudyScreen, TextColumn
from game.screens.widgets.canvas import BLANK, Canvas, Row, wrapped
from game.screens.widgets.dialogs import Question
from game.screens.widgets.keyline import KeyLine
from game.study.texts import Page

INDENT = 6


def option_rows(option: str, picked: bool, columns: int) -> list[Row]:
    """An option, wrapped; a chosen one is marked."""
    style = "chosen" if picked else "option"
    lines = wrapped(option, max(10, columns - INDENT - 1)) or [""]
    rows: list[Row] = []
    for place, line in enumerate(lines):
        mark = (" (•)  " if picked else " ( )  ") if place == 0 else " " * INDENT
        text = f"{mark}{line} "
        rows.append(((text + " " * (columns - cell_len(text)), style),))
    return rows


class Choice(Canvas):
    """The options one below the other, and which is chosen: at first, none."""

    COMPONENT_CLASSES: ClassVar[set[str]] = {"option", "chosen"}

    def __init__(self, options: Sequence[str]) -> None:
        super().__init__(classes="choice")
        self.options = options
        self.chosen: int | None = None
        self.spans: list[range] = []
        """The rows of each option."""

    def choose(self, number: int) -> None:
        """Mark option `number`, from 0."""
        self.chosen = number
        self._draw()

    def move(self, way: int) -> None:
        """Mark the next option, and stay at the first and last. While none is marked, down marks
        the first and up does nothing."""
        before = -1 if self.chosen is None else self.chosen
        after = min(len(self.options) - 1, before + way)
        if after >= 0:
            self.choose(after)

    def get_content_height(self, container: object, viewport: object, width: int) -> int:
        self._fill(self._wrapped(width))
        return super().get_content_height(container, viewport, width)

    def _draw(self) -> None:
        self.draw(self._wrapped(self.size.width))

    def _wrapped(self, columns: int) -> list[Row]:
        """The options, so wide; where each of them stands is noted."""
        rows: list[Row] = []
        self.spans = []
        for number, option in enumerate(self.options):
            block = option_rows(option, number == self.chosen, columns)
            self.spans.append(range(len(rows), len(rows) + len(block)))
            rows += [*block, BLANK]
        return rows[:-1]


class ChoiceScreen(StudyScreen[int]):
    """A page with options; dismissed with the index of the one chosen.

    `save` is called with it first, and waited for. Every option must have been in view.
    """

    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("up,k", "move(-1)", id="choice.up", priority=True),
        Binding("down,j", "move(1)", id="choice.down", priority=True),
        *(Binding(str(number), f"pick({number})", priority=True) for number in range(1, 10)),
        Binding("enter", "confirm", id="choice.confirm", priority=True),
        Binding("pageup", "page(-1)", id="choice.page_up", priority=True),
        Binding("pagedown", "page(1)", id="choice.page_down", priority=True),
    ]
    DEAF_S = 0.3

    def __init__(
        self,
        frame: Frame,
        page: Page,
        options: Sequence[str],
        *,
        question: str = "",
        save: Callable[[int], Awaitable[None]] | None = None,
        sure: tuple[int, Question] | None = None,
    ) -> None:
        """`sure` is an option that is only taken after this further question."""
        self._choice = Choice(options)
        asked = [Static(question, classes="question", markup=False)] if question else []
        self._column = TextColumn(page, *asked, self._choice)
        super().__init__(frame, [self._column, KeyLine(id="keys")])
        self._save = save
        self._sure = sure
        self._seen: set[int] = set()

    def on_mount(self) -> None:
        self.watch(self._column, "scroll_y", self._look, init=False)
        self.call_after_refresh(self._look)

    def on_resize(self) -> None:
        self.call_after_refresh(self._look)

    def _look(self) -> None:
        """Note which options have been in view, and name the keys."""
        words, spans = self.frame.words, self._choice.spans
        self._seen |= {n for n, span in enumerate(spans) if self._column.holds(self._choice, span)}
        end = self._column.rows_in_view.stop
        below = sum(self._column.span(self._choice, span).stop > end for span in spans)
        go_on = ((self.frame.keys.enter, words.go_on),) if self._choice.chosen is not None else ()
        remark = words.more_below.replace("{count}", str(below)) if below else ""
        self.show_keys(("↑ ↓", words.choose), *go_on, remark=remark)

    def action_page(self, way: int) -> None:
        self._column.page(way)

    def action_move(self, way: int) -> None:
        self._choice.move(way)
        if self._choice.chosen is not None:
            self._chosen()

    def action_pick(self, number: int) -> None:
        if number <= len(self._choice.options):
            self._choice.choose(number - 1)
            self._chosen()

    def _chosen(self) -> None:
        choice = self._choice
        assert choice.chosen is not None
        self._column.bring(choice, range(len(choice.rows)))
        self._column.bring(choice, choice.spans[choice.chosen])
        self._look()

    async def action_confirm(self) -> None:
        chosen, spans = self._choice.chosen, self._choice.spans
        if chosen is None:
            return
        unseen = [number for number in range(len(spans)) if number not in self._seen]
        if unseen:
            self._column.bring(self._choice, spans[unseen[0]])
        elif not self._column.holds(self._choice, spans[chosen]):
            self._chosen()
        elif self._sure is not None and self._sure[0] == chosen:
            self.app.push_screen(self._sure[1], self._was_sure)
        else:
            await self._take(chosen)

    def _was_sure(self, sure: bool | None) -> None:
        if sure and self._sure is not None:
            self.finish(self._sure[0])

    async def _take(self, chosen: int) -> None:
        with self.kept():
            if self._save is not None:
                await self._save(chosen)
            self.finish(chosen)
