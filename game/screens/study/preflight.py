"""Before anything begins: is the window large enough, and do its keys arrive?"""

from __future__ import annotations

import os
from typing import ClassVar

from textual import events
from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.screen import ModalScreen
from textual.widgets import Static

from game.journal.records import Preflighted
from game.screens.study.base import Frame, StudyScreen, TextColumn
from game.screens.widgets.canvas import BLANK, Canvas, Run, wrapped
from game.screens.widgets.keyline import KeyLine
from game.screens.widgets.terminal import colours, this_terminal
from game.study.study_settings import ScreenSize

ARROWS = {"up": "↑", "down": "↓", "left": "←", "right": "→", "space": "␣"}
"""The keys that must arrive, and how each is shown."""

COLUMNS = 74
INDENT = 4


def fits(columns: int, rows: int, needed: ScreenSize) -> bool:
    """Whether a window shows the whole stage."""
    return columns >= needed.columns and rows >= needed.rows


def size_text(frame: Frame, columns: int, rows: int) -> str:
    """What is said of a window that is too small."""
    needed = frame.size
    return frame.words.too_small.replace("{size}", f"{columns} x {rows}").replace(
        "{needed}", f"{needed.columns} x {needed.rows}"
    )


class PreflightScreen(StudyScreen[Preflighted]):
    """Goes on by itself to ask for Enter once all is well."""

    def __init__(self, frame: Frame) -> None:
        checks, keys = Checks(), KeyLine(id="keys")
        super().__init__(frame, [TextColumn(frame.words.preflight, checks), keys])
        self._pressed: set[str] = set()
        self._checks = checks
        self._keys = keys

    def on_resize(self, event: events.Resize) -> None:
        self._show()

    def on_mount(self) -> None:
        self._show()

    @property
    def _enough(self) -> bool:
        return fits(*self.app.size, self.frame.size)

    @property
    def _ready(self) -> bool:
        return self._enough and self._keys_work

    @property
    def _keys_work(self) -> bool:
        return self._pressed >= ARROWS.keys()

    def _show(self) -> None:
        words, size = self.frame.words, self.app.size
        enough, all_keys = self._enough, self._keys_work
        window = f"{words.size_fine}." if enough else size_text(self.frame, size.width, size.height)
        first, *more = wrapped(window, max(20, min(size.width, COLUMNS) - INDENT))
        keys: list[Run] = [
            (f" {sign} ", "arrived" if key in self._pressed else "awaited")
            for key, sign in ARROWS.items()
        ]
        spaced = [run for key in keys for run in (key, (" ", ""))]
        self._checks.draw(
            [
                (mark(enough), (first, "text")),
                *(((" " * INDENT, ""), (line, "text")) for line in more),
                BLANK,
                (mark(all_keys), (words.keys_fine if all_keys else words.press_keys, "text")),
                BLANK,
                ((" " * INDENT, ""), *spaced),
            ]
        )
        self._keys.set_keys(*(((self.frame.keys.enter, words.go_on),) if self._ready else ()))

    def on_key(self, event: events.Key) -> None:
        if event.key in ARROWS:
            self._pressed.add(event.key)
            self._show()
        elif event.key == "enter" and self._ready:
            terminal = this_terminal(*self.app.size)
            self.finish(Preflighted(terminal, colours(os.environ), keys_work=True, enough=True))


def mark(good: bool) -> Run:
    """Before a check: done, or still to be done."""
    return (" ✓  ", "good") if good else (" ·  ", "quiet")


class Checks(Canvas):
    """What was looked at."""

    COMPONENT_CLASSES: ClassVar[set[str]] = {"text", "good", "quiet", "arrived", "awaited"}


class WindowTooSmall(ModalScreen[None]):
    """Covers everything while the window is smaller than the study's screen; `clock` says what
    becomes of the time meanwhile. It can be left."""

    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("q,Q,ctrl+c,ctrl+q", "app.leave_small", id="study.small.leave", priority=True),
    ]

    def __init__(self, frame: Frame, clock: str) -> None:
        super().__init__()
        self._frame = frame
        self._clock = clock
        self._text = Static(markup=False)

    def compose(self) -> ComposeResult:
        yield self._text

    def on_resize(self, event: events.Resize) -> None:
        size = size_text(self._frame, event.size.width, event.size.height)
        parts = size, self._clock, self._frame.words.leave_now
        self._text.update("\n\n".join(part for part in parts if part))
