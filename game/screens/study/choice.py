"""One of several answers: nothing is chosen beforehand."""

from __future__ import annotations

from collections.abc import Awaitable, Callable, Sequence
from typing import ClassVar

from textual.binding import Binding, BindingType
from textual.widgets import Static

from game.screens.study.base import Frame, StudyScreen, TextColumn
from game.screens.widgets.canvas import BLANK, Canvas, Row, wrapped
from game.screens.widgets.keyline import KeyLine
from game.study.texts import Page

INDENT = 6


def choice_rows(options: Sequence[str], chosen: int | None, columns: int) -> list[Row]:
    """The options one below the other, wrapped; the chosen one is marked."""
    rows: list[Row] = []
    for number, option in enumerate(options):
        picked = number == chosen
        style = "chosen" if picked else "option"
        lines = wrapped(option, max(10, columns - INDENT - 1)) or [""]
        for place, line in enumerate(lines):
            mark = (" (•)  " if picked else " ( )  ") if place == 0 else " " * INDENT
            rows.append(((f"{mark}{line} ".ljust(columns), style),))
        rows.append(BLANK)
    return rows[:-1]


class Choice(Canvas):
    """The options, and which is chosen."""

    COMPONENT_CLASSES: ClassVar[set[str]] = {"option", "chosen"}

    def __init__(self, options: Sequence[str]) -> None:
        super().__init__(choice_rows(options, None, 0), classes="choice")
        self.options = options
        self.chosen: int | None = None

    def choose(self, number: int) -> None:
        """Mark option `number`, from 0."""
        self.chosen = number
        self._draw()

    def move(self, way: int) -> None:
        """Mark the next option; the first or last one if there is none yet."""
        before = self.chosen if self.chosen is not None else (-1 if way > 0 else 0)
        self.choose((before + way) % len(self.options))

    def on_resize(self) -> None:
        self._draw()

    def _draw(self) -> None:
        self.draw(choice_rows(self.options, self.chosen, self.size.width))


class ChoiceScreen(StudyScreen[int]):
    """A page with options; dismissed with the index of the one chosen.

    `save` is called with it first, and waited for.
    """

    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("up,k", "move(-1)", id="choice.up", priority=True),
        Binding("down,j", "move(1)", id="choice.down", priority=True),
        *(Binding(str(number), f"pick({number})", priority=True) for number in range(1, 10)),
        Binding("enter", "confirm", id="choice.confirm", priority=True),
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
    ) -> None:
        choice = Choice(options)
        asked = [Static(question, classes="question", markup=False)] if question else []
        super().__init__(frame, [TextColumn(page, *asked, choice), KeyLine(id="keys")])
        self._choice = choice
        self._save = save

    def on_mount(self) -> None:
        self.call_after_refresh(self.show_keys, ("↑ ↓", self.frame.words.choose))

    def action_move(self, way: int) -> None:
        self._choice.move(way)
        self._chosen()

    def action_pick(self, number: int) -> None:
        if number <= len(self._choice.options):
            self._choice.choose(number - 1)
            self._chosen()

    def _chosen(self) -> None:
        words = self.frame.words
        self.show_keys(("↑ ↓", words.choose), ("Enter", words.go_on))
        self._choice.scroll_visible(animate=False)

    async def action_confirm(self) -> None:
        chosen = self._choice.chosen
        if chosen is None:
            return
        with self.kept():
            if self._save is not None:
                await self._save(chosen)
            self.finish(chosen)
