"""The yellow bar: the coach's instruction, always whole."""

from __future__ import annotations

from textwrap import wrap
from time import monotonic
from typing import ClassVar

from game.screens.canvas import Canvas, Row
from game.world.observation import Guidance

LINES = 3
"""Rows of the bar; a longer text makes it taller rather than being cut."""
FLASH_S = 0.6
"""How long a new instruction stands out."""
_EDGE = "\x1f"
"""Stands for the blank at both ends of the notice while lines are broken."""


def bar_rows(guidance: Guidance, columns: int, *, fresh: bool = False) -> list[Row]:
    """Notice and instruction, wrapped into at least `LINES` rows of `columns`.

    A notice without an instruction, as at the end, is the text.
    """
    style = "fresh" if fresh else "text"
    if not guidance.text:
        guidance = Guidance(guidance.notice)
    badge = f"{_EDGE}{guidance.notice}{_EDGE} " if guidance.notice else ""
    rows: list[Row] = []
    edges = badge.count(_EDGE)
    for line in wrap(badge + guidance.text, max(1, columns - 4)):
        noticing, edges = edges > 0, edges - line.count(_EDGE)
        end = len(line) if edges else line.rfind(_EDGE) + 1 if noticing else 0
        noticed = line[:end].replace(_EDGE, " ")
        rows.append(tuple(run for run in ((noticed, "notice"), (line[end:], style)) if run[0]))
    missing = max(0, LINES - len(rows))
    rows = [()] * (missing // 2) + rows + [()] * (missing - missing // 2)
    edge = "▌ " if fresh else "  "
    return [((edge, style), *row, (" " * columns, style)) for row in rows]


class InstructionBar(Canvas):
    """Shows a Guidance and lets a new one stand out for a moment.

    It settles with the first picture after that moment, not by a timer of its own, so that it
    never takes a paint to itself.
    """

    COMPONENT_CLASSES: ClassVar[set[str]] = {"text", "fresh", "notice"}

    def __init__(self) -> None:
        super().__init__([()] * LINES, id="bar")
        self._guidance = Guidance("")
        self._fresh_until = 0.0

    def show(self, guidance: Guidance | None) -> None:
        """Put `guidance` on the bar."""
        guidance = guidance or Guidance("")
        if guidance != self._guidance:
            self._guidance = guidance
            self._fresh_until = monotonic() + FLASH_S
            self._draw()
        elif self._fresh_until and monotonic() >= self._fresh_until:
            self._fresh_until = 0.0
            self._draw()

    def _draw(self) -> None:
        if self.size.width:
            fresh = self._fresh_until > 0
            self.draw(bar_rows(self._guidance, self.size.width, fresh=fresh))

    def on_resize(self) -> None:
        self._draw()
