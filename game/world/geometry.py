"""Cells and headings: x runs to the right, y runs down, both from 0."""

from __future__ import annotations

from enum import IntEnum

Cell = tuple[int, int]
"""A position (x, y) on the plan."""


class Heading(IntEnum):
    """Where the rescuer faces, clockwise from north."""

    NORTH = 0
    EAST = 1
    SOUTH = 2
    WEST = 3

    @property
    def step(self) -> Cell:
        """The offset (dx, dy) of one step this way."""
        return _STEPS[self]

    @property
    def right(self) -> Heading:
        return HEADINGS[(self + 1) % 4]

    @property
    def back(self) -> Heading:
        return HEADINGS[(self + 2) % 4]

    @property
    def left(self) -> Heading:
        return HEADINGS[(self + 3) % 4]

    def from_cell(self, cell: Cell, steps: int = 1) -> Cell:
        """The cell `steps` steps this way from `cell`."""
        dx, dy = _STEPS[self]
        return cell[0] + dx * steps, cell[1] + dy * steps


HEADINGS = tuple(Heading)
"""Clockwise from north; quicker to go through than the class."""

_STEPS: tuple[Cell, ...] = ((0, -1), (1, 0), (0, 1), (-1, 0))


def reach(position: Cell, heading: Heading) -> tuple[Cell, ...]:
    """The cells in which triage finds a victim, first to last: one's own, the one ahead, then
    clockwise."""
    around = (heading, heading.right, heading.back, heading.left)
    return (position, *(way.from_cell(position) for way in around))
