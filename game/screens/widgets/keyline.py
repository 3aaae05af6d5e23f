"""A line of keys."""

from __future__ import annotations

from typing import ClassVar

from game.screens.widgets.canvas import Canvas


class KeyLine(Canvas):
    """Keys and what they do, on one line."""

    COMPONENT_CLASSES: ClassVar[set[str]] = {"key", "quiet"}

    def __init__(self, *keys: tuple[str, str], id: str | None = None) -> None:
        super().__init__([()], id=id)
        self.set_keys(*keys)

    def set_keys(self, *keys: tuple[str, str]) -> None:
        """Show these keys, each with what it does."""
        runs = []
        for key, does in keys:
            runs += [(f" {key} ", "key"), (f" {does}   ", "quiet")]
        self.draw([tuple(runs)])
