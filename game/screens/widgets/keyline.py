"""A line of keys."""

from __future__ import annotations

from collections.abc import Sequence
from typing import ClassVar

from game.screens.widgets.canvas import Canvas, Row, width


class KeyLine(Canvas):
    """Keys and what they do, and then a remark: on one line, or more where they do not fit."""

    COMPONENT_CLASSES: ClassVar[set[str]] = {"key", "quiet"}

    def __init__(self, *keys: tuple[str, str], id: str | None = None) -> None:
        super().__init__([()], id=id)
        self._keys: Sequence[tuple[str, str]] = ()
        self._remark = ""
        self.set_keys(*keys)

    def set_keys(self, *keys: tuple[str, str], remark: str = "") -> None:
        """Show these keys, each with what it does."""
        self._keys, self._remark = keys, remark
        self._draw()

    def on_resize(self) -> None:
        self._draw()

    def _draw(self) -> None:
        columns = self.size.width
        rows: list[Row] = [()]
        parts: list[Row] = [
            ((f" {key} ", "key"), (f" {does}   ", "quiet")) for key, does in self._keys
        ]
        if self._remark:
            parts.append(((f" {self._remark}   ", "quiet"),))
        for part in parts:
            if rows[-1] and columns and width((*rows[-1], *part)) - 2 > columns:
                rows.append(())
            rows[-1] = (*rows[-1], *part)
        self.draw(rows)
