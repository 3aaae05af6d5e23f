"""Pages to be read: plain, or with something to look at below."""

from __future__ import annotations

from typing import ClassVar

from textual.binding import Binding, BindingType
from textual.widget import Widget

from game.screens.study.base import Frame, StudyScreen, TextColumn
from game.screens.widgets.keyline import KeyLine
from game.study.texts import Page


class PageScreen(StudyScreen[bool]):
    """A page, until Enter is pressed at its end; `below` stand under its text."""

    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("enter", "go_on", id="page.go_on", priority=True),
        Binding("pageup", "page(-1)", id="page.up", priority=True),
        Binding("pagedown,space", "page(1)", id="page.down", priority=True),
    ]
    DEAF_S = 0.3

    def __init__(self, frame: Frame, page: Page, *below: Widget) -> None:
        self._column = TextColumn(page, *below)
        super().__init__(frame, [self._column, KeyLine(id="keys")])
        self._read_rows = 0

    def on_mount(self) -> None:
        self.watch(self._column, "scroll_y", self._note_read, init=False)
        self.call_after_refresh(self._shown)

    def on_resize(self) -> None:
        self.call_after_refresh(self._shown)

    def _shown(self) -> None:
        self._note_read()
        self.show_keys((self.frame.keys.enter, self.frame.words.go_on))

    def _note_read(self) -> None:
        self._read_rows = max(self._read_rows, self._column.rows_in_view.stop)

    def action_page(self, way: int) -> None:
        self._column.page(way)

    def action_go_on(self) -> None:
        if self._read_rows < self._column.virtual_size.height:
            self._column.page(1)
        else:
            self.finish(True)
