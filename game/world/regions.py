"""The doorways of a plan, and the floor regions that its walls and doors enclose."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from game.world.building import Door
from game.world.geometry import Cell
from game.world.plan import Plan, Tile

Region = tuple[Cell, ...]
"""Connected cells, row by row."""


def floor_regions(plan: Plan) -> tuple[Region, ...]:
    """The connected floor regions, doors excluded, in row order of their first cells."""
    return tuple(_connected(plan, plan.mask_of(Tile.FLOOR)))


def doorways(plan: Plan) -> tuple[Door, ...]:
    """Every group of adjacent door cells, in row order of their first cells."""
    return tuple(Door(cells) for cells in _connected(plan, plan.mask_of(Tile.DOOR)))


def reachable(plan: Plan, start: Cell) -> frozenset[Cell]:
    """Every cell that can be reached from `start`, which must be walkable."""
    return frozenset(plan.cells(_spread(plan, plan.mask([start]), plan.walkable_mask)))


def doors_of(region: Iterable[Cell], doors: tuple[Door, ...]) -> tuple[int, ...]:
    """The indices of the doors that open onto `region`."""
    cells = frozenset(region)
    return tuple(number for number, door in enumerate(doors) if not cells.isdisjoint(door.beside))


def label_cell(region: Region) -> Cell:
    """The cell of `region` nearest its centroid; the first of several, row by row.

    Distances are compared as integers (scaled by the number of cells), without rounding.
    """
    count = len(region)
    sum_x, sum_y = sum(x for x, _ in region), sum(y for _, y in region)

    def squared_distance(cell: Cell) -> int:
        return (cell[0] * count - sum_x) ** 2 + (cell[1] * count - sum_y) ** 2

    return min(region, key=squared_distance)


def _connected(plan: Plan, mask: int) -> Iterator[Region]:
    while mask:
        region = _spread(plan, mask & -mask, mask)
        yield tuple(plan.cells(region))
        mask ^= region


def _spread(plan: Plan, seed: int, mask: int) -> int:
    """The cells of `mask` that are connected to `seed` within it."""
    found = frontier = seed
    while frontier:
        frontier = plan.around(frontier) & mask & ~found
        found |= frontier
    return found
