"""A few words of the participant's own."""

from __future__ import annotations

from typing import ClassVar

from textual import events
from textual.binding import Binding, BindingType
from textual.widgets import TextArea

from game.screens.study.base import Frame, StudyScreen, TextColumn
from game.screens.widgets.keyline import KeyLine
from game.study.texts import Page

MOST_LETTERS = 2_000


class Words(TextArea):
    """Leaves Enter to its screen, after the letters before it."""

    def on_key(self, event: events.Key) -> None:
        if event.key == "enter":
            event.prevent_default()


class ReasonScreen(StudyScreen[str]):
    """Dismissed with what was written; Enter ends it, so it is one paragraph."""

    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("enter", "go_on", id="reason.go_on"),
    ]
    DEAF_S = 0.5

    def __init__(self, frame: Frame, page: Page) -> None:
        area = Words(soft_wrap=True, show_line_numbers=False, tab_behavior="focus")
        keys = KeyLine(("Enter", frame.words.go_on), id="keys")
        super().__init__(frame, [TextColumn(page, area), keys])
        self._area = area

    def on_mount(self) -> None:
        self._area.focus()

    def action_go_on(self) -> None:
        self.finish(self._area.text.strip()[:MOST_LETTERS])
