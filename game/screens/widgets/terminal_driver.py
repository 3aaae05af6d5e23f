"""Textual's driver of a terminal, with our own reader of keys, and a wheel that is not the arrow
keys."""

from __future__ import annotations

import os
import selectors
import signal
import sys
from contextlib import suppress
from time import monotonic

from textual.drivers.linux_driver import LinuxDriver

from game.screens.widgets.keyboard import Keyboard

WHEEL_IS_NO_KEY = "\x1b[?1007l"
"""Alternate scroll off: it sends arrow keys for the wheel where a program fills the window."""
CLICKS_ON, CLICKS_OFF = "\x1b[?1000h\x1b[?1006h", "\x1b[?1006l\x1b[?1000l"
"""Reports of the mouse's buttons, and not of its motion."""
WHEEL_AS_BEFORE = "\x1b[?1007h"
_READ_BYTES = 1 << 16
_GLANCE_S = 0.1


class TerminalDriver(LinuxDriver):
    """What `Keyboard` believes is all that reaches the program; whatever the locale says, the
    terminal is sent UTF-8."""

    _pointing = False

    def point(self, wanted: bool) -> None:
        """From now on believe clicks of the mouse, and ask for them; or no longer."""
        if wanted is not self._pointing:
            self._pointing = wanted
            self.write(CLICKS_ON if wanted else CLICKS_OFF)
            self.flush()

    def start_application_mode(self) -> None:
        assert sys.__stderr__ is not None
        output = sys.__stderr__.fileno()
        self._file = open(  # noqa: SIM115
            output, "w", encoding="utf-8", errors="replace", closefd=False
        )
        try:
            super().start_application_mode()  # type: ignore[no-untyped-call]
            self.write(WHEEL_IS_NO_KEY + (CLICKS_ON if self._pointing else ""))
            self.flush()
        except Exception:
            with suppress(Exception):
                self.stop_application_mode()
                self.close()
            raise

    def stop_application_mode(self) -> None:
        self.write((CLICKS_OFF if self._pointing else "") + WHEEL_AS_BEFORE)
        super().stop_application_mode()

    def _query_in_band_window_resize(self) -> None:
        """The size comes from the operating system; a report of it could be forged by any bytes."""

    def _run_input_thread(self) -> None:
        try:
            self.run_input_thread()
        except Exception as error:
            self._loop.call_soon_threadsafe(self._app._handle_exception, error)

    def run_input_thread(self) -> None:
        """Read until the program is about to leave; a terminal that is gone is a hang-up."""
        keyboard = Keyboard()
        with selectors.SelectSelector() as selector:
            selector.register(self.fileno, selectors.EVENT_READ)
            while not self.exit_event.is_set():
                if selector.select(_GLANCE_S):
                    data = self._read()
                    if not data:
                        os.kill(os.getpid(), signal.SIGHUP)
                        return
                    keyboard.pointing = self._pointing
                    for message in keyboard.feed(data, monotonic()):
                        self.process_message(message)
                for message in keyboard.tick(monotonic()):
                    self.process_message(message)

    def _read(self) -> bytes:
        try:
            return os.read(self.fileno, _READ_BYTES)
        except OSError:
            return b""
