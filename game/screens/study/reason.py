"""A few words of the participant's own."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from textual import events
from textual.binding import Binding, BindingType
from textual.message import Message
from textual.widgets import TextArea

from game.screens.study.base import Frame, StudyScreen, TextColumn
from game.screens.widgets.keyline import KeyLine
from game.study.texts import Page

MOST_LETTERS = 2_000


class Words(TextArea):
    """Leaves Enter to its screen, after the letters before it, and takes no paste that does not
    fit: nobody could shorten a megabyte, and to lay it out would take seconds."""

    @dataclass
    class Refused(Message):
        """What was pasted was left out: `too_many` letters did not fit."""

        too_many: int

    def on_paste(self, event: events.Paste) -> None:
        too_many = len(self.text) + len(event.text) - MOST_LETTERS
        if too_many > 0:
            event.prevent_default()
            self.post_message(self.Refused(too_many))

    def on_key(self, event: events.Key) -> None:
        if event.key == "enter":
            event.prevent_default()


class ReasonScreen(StudyScreen[str]):
    """Dismissed with what was written; Enter ends it, so it is one paragraph. Too long a text stays
    until it is shortened: nothing of it is left out but a paste that does not fit, and it says so.
    """

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
            self._keys.set_keys(remark=_counted(words.too_long, self._too_many))
        else:
            self._keys.set_keys((self.frame.keys.enter, words.go_on))

    def on_words_refused(self, message: Words.Refused) -> None:
        words = self.frame.words
        self._keys.set_keys(
            (self.frame.keys.enter, words.go_on),
            remark=_counted(words.paste_too_long, message.too_many),
        )

    def action_go_on(self) -> None:
        if not self._too_many:
            self.finish(self._text)


def _counted(remark: str, too_many: int) -> str:
    return remark.replace("{most}", f"{MOST_LETTERS:,}").replace("{count}", f"{too_many:,}")
