"""A rectangle of cells, and the grid that walls, floor and doors are drawn on."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import NamedTuple

from game.world.geometry import Cell, Heading
from game.world.plan import Plan, Tile


class Area(NamedTuple):
    """The cells from (left, top) to (right, bottom), both included."""

    left: int
    top: int
    right: int
    bottom: int

    @property
    def width(self) -> int:
        return self.right - self.left + 1

    @property
    def height(self) -> int:
        return self.bottom - self.top + 1

    @property
    def size(self) -> int:
        return self.width * self.height

    @property
    def middle(self) -> Cell:
        return (self.left + self.right) // 2, (self.top + self.bottom) // 2

    def cells(self) -> Iterator[Cell]:
        """Row by row."""
        for y in range(self.top, self.bottom + 1):
            for x in range(self.left, self.right + 1):
                yield x, y

    def turned(self) -> Area:
        """The area with x and y exchanged."""
        return Area(self.top, self.left, self.bottom, self.right)

    def wall(self, side: Heading) -> Area:
        """The line of cells just outside on one side, without the corners."""
        match side:
            case Heading.NORTH:
                return Area(self.left, self.top - 1, self.right, self.top - 1)
            case Heading.EAST:
                return Area(self.right + 1, self.top, self.right + 1, self.bottom)
            case Heading.SOUTH:
                return Area(self.left, self.bottom + 1, self.right, self.bottom + 1)
            case Heading.WEST:
                return Area(self.left - 1, self.top, self.left - 1, self.bottom)


class Grid:
    """A plan while it is drawn: solid wall at first."""

    def __init__(self, width: int, height: int) -> None:
        self.width = width
        self.height = height
        self._tiles = bytearray([Tile.WALL]) * (width * height)

    def draw(self, cells: Iterable[Cell], tile: Tile) -> None:
        for x, y in cells:
            self._tiles[y * self.width + x] = tile

    def tile(self, cell: Cell) -> int:
        return self._tiles[cell[1] * self.width + cell[0]]

    def plan(self) -> Plan:
        return Plan(self.width, self.height, bytes(self._tiles))
