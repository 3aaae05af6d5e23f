"""Screens that come up by themselves, while keys are still pressed that were meant for another."""

from __future__ import annotations

from time import monotonic

from textual import events
from textual.message_pump import MessagePump

STILL_S = 0.5
"""Keys do nothing until there were none for so long."""


class DeafAtFirst(MessagePump):
    """Makes a screen deaf until the keys have been still. Stands before the kind of screen among
    the bases."""

    _heard_s = 0.0
    _awake = False

    def on_mount(self) -> None:
        self._heard_s = monotonic()

    @property
    def _listens(self) -> bool:
        return self._awake or monotonic() - self._heard_s >= STILL_S

    def check_action(self, action: str, parameters: tuple[object, ...]) -> bool | None:
        return self._listens

    def on_key(self, _event: events.Key) -> None:
        """A key comes by here before it acts, or where it was not let act."""
        self._awake = self._listens
        self._heard_s = monotonic()
