"""Pages to be read: plain, or with something to look at below."""

from __future__ import annotations

from typing import ClassVar

from textual.binding import Binding, BindingType
from textual.widget import Widget

from game.mission_words import ENGLISH, MissionWords
from game.screens.study.base import Frame, StudyScreen, TextColumn
from game.screens.widgets.canvas import BLANK, Canvas
from game.screens.widgets.glyphs import PLAIN, SOLID, STYLES
from game.screens.widgets.howto import sign_rows, walking_rows
from game.screens.widgets.keyline import KeyLine
from game.study.texts import Page
from game.world.settings import MissionSettings


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


class Signs(Canvas):
    """The keys of a mission and what stands on its screen, drawn as it draws them."""

    COMPONENT_CLASSES: ClassVar[set[str]] = {*STYLES, "key"}

    def __init__(self, rules: MissionSettings, words: MissionWords = ENGLISH) -> None:
        super().__init__(classes="signs")
        self._rules, self._words = rules, words

    def on_mount(self) -> None:
        glyphs = PLAIN if self.app.native_ansi_color else SOLID
        turning = self._rules.controls == "turn"
        keys = walking_rows(turning=turning, words=self._words)
        self.draw([*keys, BLANK, *sign_rows(glyphs, self._rules, self._words)])
