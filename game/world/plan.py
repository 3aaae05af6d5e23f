"""The plan of a building: its walls, floor and doors, and nothing about who or what is inside.

Sets of cells are held as integers with bit `y * width + x` set (a *mask*): union, intersection and
counting over a whole floor are then single machine-level operations.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from enum import IntEnum
from functools import cached_property
from itertools import compress

from game.world.geometry import Cell


class Tile(IntEnum):
    """What a cell is made of; the numbers are those of the CSV grids."""

    FLOOR = 0
    WALL = 1
    DOOR = 2


_TILES = tuple(Tile)

_DIGITS = bytes(code & 1 for code in range(256))
"""Translates the digits `0` and `1` of a text to the bytes 0 and 1."""


_FEW = 200
"""So many cells of a mask are sooner found one by one than by looking at all."""


@dataclass(frozen=True)
class Plan:
    """A grid of `height` rows of `width` tiles, row by row in `tiles`."""

    width: int
    height: int
    tiles: bytes

    def __post_init__(self) -> None:
        if len(self.tiles) != self.width * self.height:
            raise ValueError("a plan needs width x height tiles")

    def __contains__(self, cell: Cell) -> bool:
        return 0 <= cell[0] < self.width and 0 <= cell[1] < self.height

    def tile(self, cell: Cell) -> Tile:
        """The tile at `cell`; everything outside the plan is wall."""
        return _TILES[self.tiles[cell[1] * self.width + cell[0]]] if cell in self else Tile.WALL

    def walkable(self, cell: Cell) -> bool:
        return cell in self and self.tiles[cell[1] * self.width + cell[0]] != Tile.WALL

    def is_door(self, cell: Cell) -> bool:
        return cell in self and self.tiles[cell[1] * self.width + cell[0]] == Tile.DOOR

    def index(self, cell: Cell) -> int:
        return cell[1] * self.width + cell[0]

    def bit(self, cell: Cell) -> int:
        """The mask with `cell` alone set."""
        return 1 << self.index(cell)

    def cell(self, index: int) -> Cell:
        y, x = divmod(index, self.width)
        return x, y

    def mask(self, cells: Iterable[Cell]) -> int:
        """The mask with exactly `cells` set."""
        mask = 0
        for x, y in cells:
            mask |= 1 << (y * self.width + x)
        return mask

    def mask_of(self, *tiles: Tile) -> int:
        """The mask of the cells that are one of these."""
        digits = bytes(b"01"[value in tiles] for value in range(256))
        return int(self.tiles[::-1].translate(digits), 2)

    def cells(self, mask: int) -> Iterator[Cell]:
        """The cells of `mask`, row by row."""
        if mask.bit_count() > _FEW:
            yield from compress(self._every_cell, self.flags(mask))
            return
        while mask:
            lowest = mask & -mask
            yield self.cell(lowest.bit_length() - 1)
            mask ^= lowest

    def flags(self, mask: int) -> bytes:
        """One byte a cell, row by row: 1 where `mask` has it, else 0."""
        return f"{mask:0{len(self.tiles)}b}".encode()[::-1].translate(_DIGITS)

    def around(self, mask: int) -> int:
        """The mask of the four-neighbours of a mask's cells, walls included."""
        east, west = self._not_at_the_side
        width = self.width
        return (mask & east) << 1 | (mask & west) >> 1 | mask << width | mask >> width

    @cached_property
    def _every_cell(self) -> tuple[Cell, ...]:
        """All cells, by index."""
        return tuple((x, y) for y in range(self.height) for x in range(self.width))

    @cached_property
    def _not_at_the_side(self) -> tuple[int, int]:
        """The masks of all cells but the last, and all but the first, of each row."""
        row = (1 << (self.width - 1)) - 1
        east = sum(row << y * self.width for y in range(self.height))
        return east, east << 1

    @cached_property
    def walkable_mask(self) -> int:
        return self.mask_of(Tile.FLOOR, Tile.DOOR)

    @cached_property
    def neighbours(self) -> tuple[tuple[int, ...], ...]:
        """For every index the indices of its walkable four-neighbours (clockwise from north);
        empty for a wall."""
        width, size = self.width, len(self.tiles)
        free = [tile != Tile.WALL for tile in self.tiles]
        table: list[tuple[int, ...]] = []
        for index in range(size):
            near: list[int] = []
            if free[index]:
                x = index % width
                if index >= width and free[index - width]:
                    near.append(index - width)
                if x + 1 < width and free[index + 1]:
                    near.append(index + 1)
                if index + width < size and free[index + width]:
                    near.append(index + width)
                if x and free[index - 1]:
                    near.append(index - 1)
            table.append(tuple(near))
        return tuple(table)
