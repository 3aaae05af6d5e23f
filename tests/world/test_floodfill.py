"""The floodfill, checked against a search that is too simple to be wrong."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from game.world import load_building
from game.world.floodfill import UNREACHABLE, Floodfills, cost_to_go
from game.world.geometry import Cell, Heading
from game.world.plan import Plan, Tile


def searched(plan: Plan, goal: Cell) -> dict[Cell, int]:
    """Distances by a plain breadth-first search."""
    distances, queue = {goal: 0}, [goal]
    for cell in queue:
        for heading in Heading:
            near = heading.from_cell(cell)
            if plan.walkable(near) and near not in distances:
                distances[near] = distances[cell] + 1
                queue.append(near)
    return distances


@st.composite
def plans(draw: st.DrawFn) -> tuple[Plan, Cell]:
    """A plan, with openings to its very edges, and a walkable goal."""
    width, height = draw(st.integers(1, 9)), draw(st.integers(1, 9))
    tiles = draw(st.lists(st.sampled_from(Tile), min_size=width * height, max_size=width * height))
    index = draw(st.integers(0, width * height - 1))
    tiles[index] = Tile.FLOOR
    plan = Plan(width, height, bytes(tiles))
    return plan, plan.cell(index)


@given(plans())
def test_every_cell_has_its_distance(drawn: tuple[Plan, Cell]) -> None:
    plan, goal = drawn
    found = cost_to_go(plan, goal)
    expected = searched(plan, goal)
    for index, value in enumerate(found):
        assert value == expected.get(plan.cell(index), UNREACHABLE)


def test_distances_beyond_a_byte_are_whole() -> None:
    length = 1000
    plan = Plan(length, 1, bytes(length))
    assert list(cost_to_go(plan, (0, 0))) == list(range(length))


def test_a_step_changes_the_distance_by_one() -> None:
    plan = load_building("harbour").plan
    values = Floodfills(plan).to(load_building("harbour").start)
    for index, near in enumerate(plan.neighbours):
        assert all(abs(values[index] - values[other]) == 1 for other in near)


@given(plans())
def test_the_neighbours_of_a_mask_are_those_of_its_cells(drawn: tuple[Plan, Cell]) -> None:
    plan, goal = drawn
    around = {heading.from_cell(goal) for heading in Heading}
    expected = {cell for cell in around if cell in plan}
    found = plan.around(plan.bit(goal)) & (1 << len(plan.tiles)) - 1
    assert set(plan.cells(found)) == expected
