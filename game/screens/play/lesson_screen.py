"""A page of the tutorial: a lesson, with what there is to look at below."""

from __future__ import annotations

from typing import ClassVar

from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.containers import VerticalScroll
from textual.message import Message
from textual.screen import Screen
from textual.widget import Widget

from game.screens.widgets.keyline import KeyLine
from game.screens.widgets.prose import body, heading
from game.screens.widgets.stillness import DeafAtFirst
from game.study.texts import Page


class LessonOver(Message):
    """A part of the tutorial is over; `go_on` is false where the player wants to leave it."""

    def __init__(self, *, go_on: bool) -> None:
        super().__init__()
        self.go_on = go_on


class LessonScreen(DeafAtFirst, Screen[None]):
    """Shows `page` until Enter is pressed where all of it was in view, page by page."""

    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("enter,space,pagedown", "go_on", id="lesson.go_on", priority=True),
        Binding("escape,q,Q,ctrl+q,ctrl+c", "leave", id="lesson.leave"),
    ]

    def __init__(self, page: Page, *below: Widget) -> None:
        super().__init__()
        self._page = page
        self._below = below

    def compose(self) -> ComposeResult:
        with VerticalScroll(classes="page lesson"):
            yield heading(self._page)
            yield body(self._page)
            yield from self._below
        yield KeyLine(("Enter", "continue"), ("↑ ↓", "scroll"), ("Q", "leave"), id="keys")

    def action_go_on(self) -> None:
        column = self.query_one(VerticalScroll)
        if column.scroll_y < column.max_scroll_y:
            column.scroll_page_down(animate=False)
        else:
            self.app.post_message(LessonOver(go_on=True))

    def action_leave(self) -> None:
        self.app.post_message(LessonOver(go_on=False))
