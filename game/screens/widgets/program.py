"""A program that fills the terminal: how it begins, and that it ends cleanly whatever happens."""

from __future__ import annotations

import asyncio
import os
import signal
import sys
import threading
import time
from collections.abc import Mapping
from errno import EIO
from traceback import format_exception
from typing import ClassVar

import click
from rich.console import RenderableType
from textual.app import App
from textual.worker import WorkerFailed

from game import __version__
from game.errors import STATUS_DEFECT, AnaError, where
from game.places import reports_folder
from game.screens.widgets.keymap import USUAL_KEYS
from game.screens.widgets.preferences import Cells, Ground
from game.screens.widgets.terminal_driver import TerminalDriver
from game.screens.widgets.theme import LOOK, THEMES, Look, theme_name


class Program(App[None], inherit_bindings=False):
    """Nobody ever sees a traceback: whatever fails unexpectedly ends the program, which leaves the
    terminal as it was, and is raised by `perform`."""

    ENABLE_COMMAND_PALETTE: ClassVar[bool] = False

    def __init__(
        self,
        wanted: Ground | None = None,
        look: Look = LOOK,
        cells: Cells = "auto",
        environ: Mapping[str, str] = os.environ,
    ) -> None:
        theme = theme_name(environ, wanted, look)
        self.look = look
        self.cells = cells
        super().__init__(
            driver_class=TerminalDriver, ansi_color=True if theme == "ana-terminal" else None
        )
        for known in THEMES:
            self.register_theme(known)
        self.theme = theme
        self.keys = USUAL_KEYS
        """The keys of missions."""
        self.failure: AnaError | None = None
        """What the user can fix, and ended the program."""
        self.defect: Exception | None = None
        """The first thing that failed unexpectedly, and ended it."""

    def perform(self) -> int:
        """Run it on this terminal; the exit status. Raises `failure` or `defect`."""
        try:
            self.run(mouse=False)
        except Exception as error:
            self.defect = self.defect or error
        if self.defect is not None:
            raise self.defect
        if self.failure is not None:
            raise self.failure
        return self.return_code or 0

    def perform_or_report(self) -> int:
        """The same, but say briefly that something failed unexpectedly, and where its report is."""
        try:
            return self.perform()
        except AnaError:
            raise
        except Exception as error:
            return report(error)

    def note_defect(self, error: Exception) -> None:
        """Called once, when something failed unexpectedly and before the program ends."""

    def on_load(self) -> None:
        loop = asyncio.get_running_loop()
        loop.set_exception_handler(lambda _, context: self._heard(context))
        threading.excepthook = lambda told: loop.call_soon_threadsafe(
            self._heard, {"exception": told.exc_value}
        )
        sys.unraisablehook = lambda _: None

    def _heard(self, context: Mapping[str, object]) -> None:
        error = context.get("exception")
        if isinstance(error, OSError) and error.errno == EIO:
            signal.raise_signal(signal.SIGHUP)  # the terminal is gone, and nobody has said so yet
        elif isinstance(error, Exception):
            self._handle_exception(error)

    def _handle_exception(self, error: Exception) -> None:
        """Instead of Textual's own, which shows a traceback with the values of all variables."""
        cause = error.error if isinstance(error, WorkerFailed) else error
        if self.defect is None and isinstance(cause, Exception):
            self.defect = cause
            self.note_defect(cause)
        self._return_code = STATUS_DEFECT
        if self._exception is None:
            self._exception = error
            self._exception_event.set()
        self._close_messages_no_wait()

    def panic(self, *renderables: RenderableType) -> None:
        """Instead of Textual's own, which prints."""
        self._handle_exception(RuntimeError("the screen failed"))


def report(error: Exception) -> int:
    """Write the traceback to a file and tell the user where; the exit status."""
    told = "".join([f"ana {__version__}\n", *format_exception(error)])
    path = reports_folder() / f"fault-{time.strftime('%Y%m%dT%H%M%S')}-{os.getpid()}.txt"
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(told, encoding="utf-8")
        written = f"The report is in {path}"
    except OSError as refused:
        written = f"The report could not be written to {path} ({refused.strerror})"
    if isinstance(error, ImportError):
        what = "ana was changed while it ran, by an upgrade for instance. Start it again"
    else:
        what = f"something went wrong in ana itself ({where(error)})"
    click.echo(f"ana: {what}. What you played up to then is saved. {written}", err=True)
    return STATUS_DEFECT
