"""A few words of the participant's own."""

from __future__ import annotations

from typing import ClassVar

from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.widgets import TextArea

from game.screens.keyline import KeyLine
from game.screens.study.base import Column, Frame, StudyScreen, body, heading
from game.study.texts import Page

MOST_LETTERS = 2_000


class ReasonScreen(StudyScreen[str]):
    """Dismissed with what was written; Enter ends it, so it is one paragraph."""

    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("enter", "go_on", id="reason.go_on", priority=True),
    ]
    DEAF_S = 0.5

    def __init__(self, frame: Frame, page: Page) -> None:
        super().__init__(frame)
        self._page = page
        self._area = TextArea(soft_wrap=True, show_line_numbers=False, tab_behavior="focus")

    def content(self) -> ComposeResult:
        with Column():
            yield heading(self._page)
            yield body(self._page)
            yield self._area
        yield KeyLine(("Enter", self.frame.words.go_on), id="keys")

    def on_mount(self) -> None:
        super().on_mount()
        self._area.focus()

    def action_go_on(self) -> None:
        self.finish(self._area.text.strip()[:MOST_LETTERS])
