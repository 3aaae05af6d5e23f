"""Settings that hold from one mission to the next, over any screen."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any, ClassVar

from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.containers import Vertical
from textual.screen import ModalScreen
from textual.widgets import Static

from game.places import shortened
from game.screens.play.home import CONTROLS
from game.screens.play.menu import Item, after, menu_rows
from game.screens.widgets.keyline import KeyLine
from game.screens.widgets.pointing import ClickCanvas, Pointed, RowClicked
from game.screens.widgets.preferences import Preferences

_THEMES = {None: "as the terminal says", "dark": "dark", "light": "light"}
_CELLS = {"auto": "large where there is room", "normal": "normal", "large": "large"}
_BELL = {False: "off", True: "rings at new words"}
_MOTION = {False: "new words flash", True: "reduced"}
_CHOICES: dict[str, dict[Any, str]] = {
    "ground": _THEMES,
    "controls": CONTROLS,
    "cells": _CELLS,
    "bell": _BELL,
    "still": _MOTION,
}
_NAMES = {
    "ground": "Theme",
    "controls": "Controls",
    "cells": "Cells",
    "bell": "Bell",
    "still": "Motion",
}


def settings_items(preferences: Preferences) -> list[Item]:
    """A line for each setting, with what is chosen."""
    return [
        Item(name, _NAMES[name], choices[getattr(preferences, name)])
        for name, choices in _CHOICES.items()
    ]


class SettingsList(ClickCanvas):
    """The settings as a widget."""

    COMPONENT_CLASSES: ClassVar[set[str]] = {"item", "selected"}


class SettingsScreen(Pointed, ModalScreen[None]):
    """Each change holds at once: `changed` is given the new preferences."""

    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("up,k,w,shift+tab", "move(-1)", id="settings.up"),
        Binding("down,j,s,tab", "move(1)", id="settings.down"),
        Binding("left,h,a", "change(-1)", id="settings.left"),
        Binding("right,l,d,enter,space", "change(1)", id="settings.right"),
        Binding("escape,q,Q,f2,ctrl+q,ctrl+c", "close", id="settings.close"),
    ]

    def __init__(
        self,
        preferences: Preferences,
        changed: Callable[[Preferences], None],
        keys_file: Path,
        log_dir: Path,
    ) -> None:
        super().__init__()
        self._preferences = preferences
        self._changed = changed
        self._keys_file, self._log_dir = keys_file, log_dir
        self._selected = 0
        self._list = SettingsList()

    def compose(self) -> ComposeResult:
        with Vertical(classes="dialog"):
            yield Static("Settings", classes="title", markup=False)
            yield self._list
            yield Static(self._remark(), classes="remark", markup=False)
            yield KeyLine(("↑ ↓", "choose"), ("← →", "change"), ("Esc", "back"))

    def _remark(self) -> str:
        return (
            "Controls hold from the next mission on.\n"
            f"Keys are changed in {shortened(self._keys_file)}\n"
            f"Missions are kept in {shortened(self._log_dir)}"
        )

    def on_mount(self) -> None:
        self._show()

    def _show(self) -> None:
        self._list.draw(menu_rows(settings_items(self._preferences), self._selected))

    def on_row_clicked(self, message: RowClicked) -> None:
        self._selected = message.row
        self.action_change(1)

    def action_move(self, way: int) -> None:
        self._selected = (self._selected + way) % len(_CHOICES)
        self._show()

    def action_change(self, way: int) -> None:
        name = list(_CHOICES)[self._selected]
        wanted = after(list(_CHOICES[name]), getattr(self._preferences, name), way)
        self._preferences = self._preferences.replaced(**{name: wanted})
        self._changed(self._preferences)
        self._show()

    def action_close(self) -> None:
        self.dismiss()
