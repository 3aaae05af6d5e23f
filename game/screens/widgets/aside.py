"""Work that a screen does not wait for, and that nothing waits for when the program ends."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from contextvars import copy_context
from threading import Thread
from typing import Any, TypeVar

from textual.screen import Screen

Result = TypeVar("Result")


def aside(screen: Screen[Any], work: Callable[[], Result], done: Callable[[Result], None]) -> None:
    """Do `work` in a thread, and then call `done` with its result in the screen's own turn, if the
    screen is still there."""

    def run() -> None:
        result = work()
        with suppress(RuntimeError):
            screen.call_later(done, result)

    Thread(target=copy_context().run, args=(run,), daemon=True).start()
