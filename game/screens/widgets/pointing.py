"""The mouse, on menus alone: elsewhere its reports do nothing, and are not asked for."""

from __future__ import annotations

from contextlib import suppress

from textual import events
from textual.app import ScreenStackError
from textual.message import Message
from textual.message_pump import MessagePump

from game.screens.widgets.canvas import Canvas
from game.screens.widgets.terminal_driver import TerminalDriver


class RowClicked(Message):
    """A row of a canvas was clicked, at a column of it."""

    def __init__(self, canvas: Canvas, row: int, column: int) -> None:
        super().__init__()
        self.canvas = canvas
        self.row = row
        self.column = column


class ClickCanvas(Canvas):
    """A canvas that says where it was clicked."""

    def on_click(self, event: events.Click) -> None:
        if event.button == 1 and event.y < len(self.rows):
            self.post_message(RowClicked(self, event.y, event.x))


class Pointed(MessagePump):
    """Makes a screen listen to the mouse while it is the one in front. Stands before the kind of
    screen among the bases; it is no widget itself, so that styles go by that kind."""

    def on_screen_resume(self) -> None:
        self._point()

    def on_screen_suspend(self) -> None:
        self._point()

    def on_unmount(self) -> None:
        self._point()

    def _point(self) -> None:
        driver = self.app._driver
        with suppress(ScreenStackError):
            if isinstance(driver, TerminalDriver):
                driver.point(isinstance(self.app.screen, Pointed))
