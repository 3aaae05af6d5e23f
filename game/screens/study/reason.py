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
    """Dismissed with what was written; Enter ends it, so it is one paragraph. Too long a text stays
    until it is shortened: nothing of it is left out."""

    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("enter", "go_on", id="reason.go_on"),
    ]
    DEAF_S = 0.5

    def __init__(self, frame: Frame, page: Page) -> None:
        area = Words(soft_wrap=True, show_line_numbers=False, tab_behavior="focus")
        keys = KeyLine(id="keys")
        super().__init__(frame, [TextColumn(page, area), keys])
        self._area = area
        self._keys = keys

    def on_mount(self) -> None:
        self._area.focus()
        self._show()

    def on_text_area_changed(self) -> None:
        self._show()

    @property
    def _text(self) -> str:
        return self._area.text.strip()

    @property
    def _too_many(self) -> int:
        return max(0, len(self._text) - MOST_LETTERS)

    def _show(self) -> None:
        words = self.frame.words
        if self._too_many:
            remark = words.too_long.replace("{most}", f"{MOST_LETTERS:,}")
            self._keys.set_keys(remark=remark.replace("{count}", f"{self._too_many:,}"))
        else:
            self._keys.set_keys((self.frame.keys.enter, words.go_on))

    def action_go_on(self) -> None:
        if not self._too_many:
            self.finish(self._text)
