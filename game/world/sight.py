"""Sight: a square field of view by restrictive shadowcasting.

The algorithm is restrictive precise-angle shadowcasting (Mingos, 2008): a cell is seen only if the
ray to its centre is free and a cell in front of it is seen. Angles are kept as exact integer
fractions, so that the result is the same on every machine.
"""

from __future__ import annotations

from functools import cache
from itertools import product
from math import lcm
from typing import NamedTuple

from game.world.geometry import Cell, Heading
from game.world.plan import Plan, Tile


class Sight:
    """Fields of view in one plan, each computed when first asked for."""

    def __init__(self, plan: Plan, radius: int) -> None:
        self.plan = plan
        self.radius = radius
        self._fields: dict[Cell, int] = {}

    def field(self, position: Cell) -> int:
        """The mask of all cells, walls included, that are in view from `position`."""
        field = self._fields.get(position)
        if field is None:
            field = self._fields[position] = field_of_view(self.plan, position, self.radius)
        return field


def field_of_view(plan: Plan, viewer: Cell, radius: int) -> int:
    """The mask of cells within `radius` (Chebyshev) that `viewer` sees.

    Walls block the view, and so do doors unless the viewer stands in the door or right beside it.
    """
    passing = {_HERE}
    mask = 1 << plan.index(viewer)
    for octant in _octants(radius):
        mask |= _scan(octant, plan, viewer, passing)
    return mask


class _Place(NamedTuple):
    """A place of an octant: where it lies from the viewer, the two places before it (straight and
    diagonally towards the viewer), and the angles it spans."""

    offset: Cell
    straight: Cell
    diagonal: Cell
    start: int
    end: int


_Octant = tuple[tuple[_Place, ...], ...]
"""The eighth of the view between straight ahead and a diagonal: its rows, nearest first."""

_HERE: Cell = (0, 0)


@cache
def _octants(radius: int) -> tuple[_Octant, ...]:
    """Row d of an octant has the places 0..d, counted from straight ahead; place k spans the
    angles from k / (d + 1) to (k + 1) / (d + 1), scaled to integers."""
    unit = 2 * lcm(*range(1, radius + 2))
    sides = product((Heading.NORTH, Heading.SOUTH), (Heading.EAST, Heading.WEST))
    return tuple(
        tuple(
            tuple(_place(ahead, aside, d, k, unit // (d + 1)) for k in range(d + 1))
            for d in range(1, radius + 1)
        )
        for upright, level in sides
        for ahead, aside in ((upright, level), (level, upright))
    )


def _place(ahead: Heading, aside: Heading, distance: int, number: int, width: int) -> _Place:
    behind = ahead.from_cell(_HERE, distance - 1)
    return _Place(
        offset=aside.from_cell(ahead.from_cell(_HERE, distance), number),
        straight=aside.from_cell(behind, number),
        diagonal=aside.from_cell(behind, number - 1),
        start=number * width,
        end=(number + 1) * width,
    )


def _scan(octant: _Octant, plan: Plan, viewer: Cell, passing: set[Cell]) -> int:
    """The mask of what is seen in one octant, row by row, keeping the shadows that walls cast.

    `passing` are the offsets of what is seen and does not block, in all octants so far.
    """
    left, top = viewer
    width, height, tiles = plan.width, plan.height, plan.tiles
    mask = 0
    nearest_free = 0
    shadows: list[tuple[int, int]] = []
    for row in octant:
        cast_before = tuple(shadows)
        anything_seen = False
        for place in row:
            offset, straight, diagonal, start, end = place
            x, y = left + offset[0], top + offset[1]
            if end <= nearest_free or not (0 <= x < width and 0 <= y < height):
                continue
            tile = tiles[y * width + x]
            blocks = tile == Tile.WALL or (tile == Tile.DOOR and straight != _HERE)
            if cast_before and (
                not (straight in passing or diagonal in passing)
                or _shaded(start, end, blocks, cast_before)
            ):
                continue
            mask |= 1 << (y * width + x)
            anything_seen = True
            if not blocks:
                passing.add(offset)
            elif start > nearest_free:
                shadows.append((start, end))
            elif place is row[-1]:
                return mask
            else:
                nearest_free = end
        if not anything_seen:
            break
    return mask


def _shaded(start: int, end: int, blocks: bool, shadows: tuple[tuple[int, int], ...]) -> bool:
    """Whether a shadow hides a place: a wall when it is covered, a free cell when its centre is."""
    if blocks:
        return any(shadow[0] <= start and end <= shadow[1] for shadow in shadows)
    centre = start + end
    return any(2 * shadow[0] < centre < 2 * shadow[1] for shadow in shadows)
