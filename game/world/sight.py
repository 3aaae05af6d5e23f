"""Sight: a square field of view by restrictive shadowcasting.

The algorithm is restrictive precise-angle shadowcasting (Mingos, 2008): a cell is seen only if the
ray to its centre is free and a cell in front of it is seen. Angles are kept as exact integer
fractions, so that the result is the same on every machine.
"""

from __future__ import annotations

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


def opaque(plan: Plan, cell: Cell, viewer: Cell) -> bool:
    """Whether `cell` blocks the view from `viewer`: walls do, and doors unless the viewer stands
    in the door or right beside it."""
    tile = plan.tile(cell)
    if tile is Tile.DOOR:
        return abs(cell[0] - viewer[0]) + abs(cell[1] - viewer[1]) > 1
    return tile is Tile.WALL


def field_of_view(plan: Plan, viewer: Cell, radius: int) -> int:
    """The mask of cells within `radius` (Chebyshev) that `viewer` sees."""
    seen = {viewer}
    for ahead in (Heading.NORTH, Heading.SOUTH):
        for aside in (Heading.EAST, Heading.WEST):
            _Octant(plan, viewer, ahead, aside).scan(radius, seen)
            _Octant(plan, viewer, aside, ahead).scan(radius, seen)
    return plan.mask(seen)


class _Octant(NamedTuple):
    """The eighth of the view between straight `ahead` and the diagonal to `aside`.

    Row `distance` has the places 0..distance, counted from straight ahead; place k spans the
    angles from k / (distance + 1) to (k + 1) / (distance + 1), scaled to integers by `unit`.
    """

    plan: Plan
    viewer: Cell
    ahead: Heading
    aside: Heading

    def scan(self, radius: int, seen: set[Cell]) -> None:
        """Add to `seen` what is in view, row by row, keeping the shadows that walls cast."""
        unit = 2 * lcm(*range(1, radius + 2))
        nearest_free = 0
        shadows: list[tuple[int, int]] = []
        for distance in range(1, radius + 1):
            width = unit // (distance + 1)
            cast_before = tuple(shadows)
            anything_seen = False
            for place in range(nearest_free // width, distance + 1):
                cell = self._cell(distance, place)
                if cell not in self.plan:
                    continue
                span = place * width, (place + 1) * width
                blocks = opaque(self.plan, cell, self.viewer)
                if cast_before and (
                    not self._lit(distance, place, seen)
                    or any(_shaded(span, shadow, blocks) for shadow in cast_before)
                ):
                    continue
                seen.add(cell)
                anything_seen = True
                if not blocks:
                    continue
                if span[0] > nearest_free:
                    shadows.append(span)
                elif place == distance:
                    return
                else:
                    nearest_free = span[1]
            if not anything_seen:
                return

    def _cell(self, distance: int, place: int) -> Cell:
        return self.aside.from_cell(self.ahead.from_cell(self.viewer, distance), place)

    def _lit(self, distance: int, place: int, seen: set[Cell]) -> bool:
        """Whether a cell of the row before, straight or diagonally behind, passes the view on."""
        behind = (self._cell(distance - 1, place), self._cell(distance - 1, place - 1))
        return any(cell in seen and not opaque(self.plan, cell, self.viewer) for cell in behind)


def _shaded(span: tuple[int, int], shadow: tuple[int, int], blocks: bool) -> bool:
    """Whether `shadow` hides a cell: a wall when it is covered, a free cell when its centre is."""
    if blocks:
        return shadow[0] <= span[0] and span[1] <= shadow[1]
    return 2 * shadow[0] < span[0] + span[1] < 2 * shadow[1]
