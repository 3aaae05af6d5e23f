"""Pages to be read: plain, or with something to look at below."""

from __future__ import annotations

from typing import ClassVar

from textual.binding import Binding, BindingType
from textual.widget import Widget

from game.screens.study.base import Frame, StudyScreen, TextColumn
from game.screens.widgets.canvas import BLANK, Canvas
from game.screens.widgets.glyphs import PLAIN, SOLID, STYLES
from game.screens.widgets.howto import sign_rows, walking_rows
from game.screens.widgets.keyline import KeyLine
from game.study.texts import Page
from game.world.settings import MissionSettings


class PageScreen(StudyScreen[bool]):
    """A page, until Enter is pressed; `below` stand under its text."""

    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("enter", "go_on", id="page.go_on"),
    ]
    DEAF_S = 0.3

    def __init__(self, frame: Frame, page: Page, *below: Widget) -> None:
        super().__init__(frame, [TextColumn(page, *below), KeyLine(id="keys")])

    def on_mount(self) -> None:
        self.call_after_refresh(self.show_keys, ("Enter", self.frame.words.go_on))

    def action_go_on(self) -> None:
        self.finish(True)


class Signs(Canvas):
    """The keys of a mission and what stands on its screen, drawn as it draws them."""

    COMPONENT_CLASSES: ClassVar[set[str]] = {*STYLES, "key"}

    def __init__(self, rules: MissionSettings) -> None:
        super().__init__(classes="signs")
        self._rules = rules

    def on_mount(self) -> None:
        glyphs = PLAIN if self.app.native_ansi_color else SOLID
        turning = self._rules.controls == "turn"
        self.draw([*walking_rows(turning=turning), BLANK, *sign_rows(glyphs, self._rules)])
