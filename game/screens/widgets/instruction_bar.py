"""The yellow bar: the coach's instruction, always whole."""

from __future__ import annotations

from textwrap import wrap
from time import monotonic
from typing import ClassVar

from game.screens.widgets.canvas import Canvas, Row
from game.world.observation import Guidance

LINES = 3
"""Rows of the bar; a longer text makes it taller rather than being cut."""
FLASH_S = 0.6
"""How long a new instruction stands out."""


def bar_rows(guidance: Guidance, columns: int, *, fresh: bool = False) -> list[Row]:
    """Notice and instruction, wrapped into at least `LINES` rows of `columns`.

    The notice has rows of its own above the text, which stands where it would without one. A
    notice without an instruction, as at the end, is the text.
    """
    style = "fresh" if fresh else "text"
    if not guidance.text:
        guidance = Guidance(guidance.notice)
    wide = max(1, columns - 4)
    rows: list[Row] = [((line, style),) for line in wrap(guidance.text, wide)]
    above = max(0, LINES - len(rows) + 1) // 2
    if guidance.notice:
        notice: list[Row] = [((f" {line} ", "notice"),) for line in wrap(guidance.notice, wide - 2)]
        rows = [()] * (above - len(notice)) + notice + rows
    else:
        rows = [()] * above + rows
    rows += [()] * (LINES - len(rows))
    edge = "▌ " if fresh else "  "
    return [((edge, style), *row, (" " * columns, style)) for row in rows]


def announces(guidance: Guidance, before: Guidance) -> bool:
    """Whether something is said that was not said before, rather than only taken back."""
    return guidance.notice not in ("", before.notice) or guidance.text not in ("", before.text)


class InstructionBar(Canvas):
    """Shows a Guidance and lets a new one stand out for a moment.

    It settles with the first picture after that moment, not by a timer of its own, so that it
    never takes a paint to itself.
    """

    COMPONENT_CLASSES: ClassVar[set[str]] = {"text", "fresh", "notice"}

    def __init__(self) -> None:
        super().__init__([()] * LINES, id="bar")
        self.flashes = True
        """Whether new words stand out for a moment."""
        self._guidance = Guidance("")
        self._fresh_until = 0.0

    def show(self, guidance: Guidance | None) -> None:
        """Put `guidance` on the bar."""
        guidance = guidance or Guidance("")
        settles = self._fresh_until > 0 and monotonic() >= self._fresh_until
        if settles:
            self._fresh_until = 0.0
        if guidance != self._guidance:
            if self.flashes and announces(guidance, self._guidance):
                self._fresh_until = monotonic() + FLASH_S
            self._guidance = guidance
            self._draw()
        elif settles:
            self._draw()

    def _draw(self) -> None:
        if self.size.width:
            fresh = self._fresh_until > 0
            self.draw(bar_rows(self._guidance, self.size.width, fresh=fresh))

    def on_resize(self) -> None:
        self._draw()
