"""Sight, checked against libtcod's restrictive field of view."""

from __future__ import annotations

import numpy as np
import pytest
import tcod.constants
import tcod.map

from game.world.geometry import Cell, Heading
from game.world.library import load_building, shipped_buildings
from game.world.plan import Plan, Tile
from game.world.sight import Sight, field_of_view

RADIUS = 5


def drawn(*rows: str) -> Plan:
    tiles = bytes("#+".find(glyph) + 1 for row in rows for glyph in row)
    return Plan(len(rows[0]), len(rows), tiles)


def opaque(plan: Plan, cell: Cell, viewer: Cell) -> bool:
    """The rule of sight, written a second time: what blocks the view from `viewer`."""
    away = abs(cell[0] - viewer[0]) + abs(cell[1] - viewer[1])
    return plan.tile(cell) is Tile.WALL or (plan.tile(cell) is Tile.DOOR and away > 1)


def reference(plan: Plan, viewer: Cell) -> tuple[np.ndarray, tuple[int, int]]:
    """libtcod's field in the square around `viewer`, and the square's top left corner (x, y)."""
    left, top = max(0, viewer[0] - RADIUS - 1), max(0, viewer[1] - RADIUS - 1)
    columns = range(left, min(plan.width, viewer[0] + RADIUS + 2))
    rows = range(top, min(plan.height, viewer[1] + RADIUS + 2))
    clear = np.array([[not opaque(plan, (x, y), viewer) for x in columns] for y in rows])
    field = tcod.map.compute_fov(
        clear,
        (viewer[1] - top, viewer[0] - left),
        radius=RADIUS,
        light_walls=True,
        algorithm=tcod.constants.FOV_RESTRICTIVE,
    )
    return field, (left, top)


def agreement(plan: Plan, viewers: list[Cell]) -> float:
    """The share of cells in the squares of sight on which both fields agree."""
    same = total = 0
    for viewer in viewers:
        expected, (left, top) = reference(plan, viewer)
        field = field_of_view(plan, viewer, RADIUS)
        for y in range(viewer[1] - RADIUS, viewer[1] + RADIUS + 1):
            for x in range(viewer[0] - RADIUS, viewer[0] + RADIUS + 1):
                if (x, y) in plan:
                    total += 1
                    ours = bool(field >> plan.index((x, y)) & 1)
                    same += ours == bool(expected[y - top, x - left])
    return same / total


@pytest.mark.parametrize("name", shipped_buildings())
def test_it_agrees_with_the_reference_on_our_buildings(name: str) -> None:
    plan = load_building(name).plan
    viewers = list(plan.cells(plan.walkable_mask))[::3]
    assert agreement(plan, viewers) >= 0.99


def test_a_door_blocks_unless_the_viewer_stands_in_it_or_beside_it() -> None:
    plan = drawn("#########", "#...+...#", "#########")

    def seen(x: int) -> set[Cell]:
        return set(plan.cells(field_of_view(plan, (x, 1), RADIUS)))

    assert (4, 1) in seen(1) and (5, 1) not in seen(1)
    assert (5, 1) in seen(3) and (5, 1) in seen(4)


def test_sight_reaches_its_radius_and_no_further() -> None:
    plan = drawn("#" * 15, "#" + "." * 13 + "#", "#" * 15)
    seen = set(plan.cells(Sight(plan, RADIUS).field((1, 1))))
    assert (6, 1) in seen and (7, 1) not in seen
    assert (0, 1) in seen and (3, 0) in seen, "walls in view are seen"


def test_sight_is_the_same_in_every_direction() -> None:
    plan = drawn(
        "###########",
        "#.........#",
        "#.........#",
        "#..#...#..#",
        "#.........#",
        "#.........#",
        "#.........#",
        "#..#...#..#",
        "#.........#",
        "#.........#",
        "###########",
    )
    seen = set(plan.cells(field_of_view(plan, (5, 5), RADIUS)))
    assert seen == {(10 - x, y) for x, y in seen} == {(y, x) for x, y in seen}
    assert all(heading.from_cell((5, 5), 4) in seen for heading in Heading)
