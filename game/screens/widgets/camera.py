"""Which part of the office the view shows: it moves only when the rescuer leaves its middle."""

from __future__ import annotations

from dataclasses import dataclass

from game.world.geometry import Cell

MARGIN = 6
"""Cells kept in view beside the rescuer: more than the radius of sight."""
STRIDE = 5
"""Cells by which the view moves at once; moving by one would repaint everything at every step."""


@dataclass(frozen=True)
class Camera:
    """A window of `columns` x `rows` cells whose top left cell is `left`, `top`.

    A plan smaller than the window is centred: `left` or `top` is then negative.
    """

    columns: int
    rows: int
    left: int
    top: int

    @classmethod
    def centred(cls, columns: int, rows: int, position: Cell, plan_size: tuple[int, int]) -> Camera:
        """A window with `position` in its middle, as far as the plan reaches."""
        return cls(
            columns,
            rows,
            _centre(position[0], columns, plan_size[0]),
            _centre(position[1], rows, plan_size[1]),
        )

    def follow(self, position: Cell, plan_size: tuple[int, int]) -> Camera:
        """This window, moved if `position` is no longer well inside it."""
        left = _follow(self.left, position[0], self.columns, plan_size[0])
        top = _follow(self.top, position[1], self.rows, plan_size[1])
        if (left, top) == (self.left, self.top):
            return self
        return Camera(self.columns, self.rows, left, top)


def _centre(position: int, window: int, size: int) -> int:
    if size <= window:
        return (size - window) // 2
    return max(0, min(position - window // 2, size - window))


def _follow(start: int, position: int, window: int, size: int) -> int:
    if size <= window:
        return (size - window) // 2
    margin = min(MARGIN, (window - 1) // 2)
    stride = min(STRIDE, window - 2 * margin)
    if position < start + margin:
        start = min(start - stride, position - margin)
    elif position >= start + window - margin:
        start = max(start + stride, position + margin + 1 - window)
    return max(0, min(start, size - window))
