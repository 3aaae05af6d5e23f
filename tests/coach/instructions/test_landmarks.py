"""Where the tuples that move somebody lead, on plans drawn for the purpose."""

from itertools import pairwise

import pytest

from game.coach.instructions.landmarks import Landmarks
from game.coach.instructions.vocabulary import Tuple
from game.world.building import Building, Room
from game.world.geometry import Cell, Heading
from game.world.plan import Plan
from game.world.regions import doors_of, doorways, floor_regions, label_cell

N, E, S, W = Heading

STREET = """\
#####################
#.....###......#....#
#.....###......#....#
#.....###......#....#
#.....###......#....#
###+#####.....##++###
#...................#
#...................#
#####+########..#####
#......#.....#..#####
#......#.....#..#####
#......+.....#..#####
#......#.....#..#####
#####################
"""


def landmarks(drawing: str, *room_cells: Cell) -> Landmarks:
    """The landmarks of a drawing, in which the spaces of `room_cells` are rooms."""
    rows = drawing.splitlines()
    tiles = {"#": 1, ".": 0, "+": 2}
    plan = Plan(len(rows[0]), len(rows), bytes(tiles[mark] for row in rows for mark in row))
    doors = doorways(plan)
    rooms = tuple(
        Room(f"Room {number}", region, label_cell(region), doors_of(region, doors))
        for number, region in enumerate(floor_regions(plan))
        if set(region) & set(room_cells)
    )
    return Landmarks(Building("drawn", plan, rooms, doors, (), (1, 1), N, ""), 5)


STREET_ROOMS = ((1, 1), (16, 1), (1, 9), (8, 9))


def leads(start: Cell, heading: Heading) -> dict[Tuple, Cell]:
    known = landmarks(STREET, *STREET_ROOMS)
    plan = known.building.plan
    return {move.said: plan.cell(move.end) for move in known.moves(plan.index(start), heading)}


def test_doors_are_counted_on_the_side_where_they_come_abreast() -> None:
    found = leads((1, 6), E)
    assert found["Proceed", "1 Door left"] == (3, 6)
    assert found["Enter", "1 Door left"] == (3, 4)
    assert found["Enter", "1 Door right"] == (5, 9)


def test_a_double_door_is_one_door() -> None:
    found = leads((1, 6), E)
    assert found["Enter", "2 Door left"] == (16, 4)
    assert ("Enter", "3 Door left") not in found


def test_a_door_abreast_at_the_start_does_not_count() -> None:
    assert leads((3, 6), E)["Enter", "1 Door left"] == (16, 4)
    assert ("Enter", "1 Door left") not in leads((16, 6), E)


def test_an_opening_counts_once_at_its_first_cell() -> None:
    found = leads((1, 7), E)
    assert found["Proceed", "1 Intersection left"] == (9, 7)
    assert ("Proceed", "2 Intersection left") not in found
    assert found["Proceed", "1 Intersection right"] == (14, 7)
    assert leads((11, 7), E).get(("Proceed", "1 Intersection left")) is None


SHALLOW = "########\n#......#\n###..###\n###..###\n###..###\n###..###\n########\n"
DEEP = SHALLOW.replace("###..###\n", "###..###\n###..###\n", 1)


@pytest.mark.parametrize(
    ("drawing", "rooms", "count"), [(SHALLOW, (), 0), (DEEP, (), 1), (DEEP, ((1, 1),), 0)]
)
def test_a_deep_opening_in_a_hallway_is_an_intersection(
    drawing: str, rooms: tuple[Cell, ...], count: int
) -> None:
    known = landmarks(drawing, *rooms)
    moves = known.moves(known.building.plan.index((1, 1)), E)
    assert sum("Intersection" in move.said[1] for move in moves) == count


def test_proceeding_ends_before_a_wall_or_a_door() -> None:
    assert leads((1, 6), E)["Proceed", "Hallway"] == (19, 6)
    assert leads((1, 11), E)["Proceed", "Room"] == (6, 11)
    assert ("Proceed", "Hallway") not in leads((19, 6), E)


def test_the_door_ahead_leads_to_the_first_cell_beyond() -> None:
    assert leads((3, 7), N)["Enter", "Door"] == (3, 4)
    assert leads((3, 2), S)["Exit", "Door"] == (3, 6)


def test_out_of_a_doorway() -> None:
    assert leads((3, 5), N)["Enter", "Room"] == (3, 4)
    assert leads((3, 5), S)["Enter", "Hallway"] == (3, 6)
    assert not any(said[0] == "Enter" for said in leads((3, 5), E))


@pytest.mark.parametrize(
    ("start", "end"),
    [
        ((1, 1), (3, 6)),
        ((1, 9), (5, 7)),
        ((6, 12), (8, 11)),
        ((12, 9), (6, 11)),
        ((19, 1), (17, 6)),
    ],
)
def test_the_exit_is_by_the_nearest_door(start: Cell, end: Cell) -> None:
    known = landmarks(STREET, *STREET_ROOMS)
    plan = known.building.plan
    way = known.exit(plan.index(start))
    assert way is not None
    assert plan.cell(way.end) == end
    walked = [start, *(plan.cell(index) for index in known.path(plan.index(start), way))]
    assert len(walked) == way.steps + 1
    assert walked[-1] == end
    assert all(
        abs(x - u) + abs(y - v) == 1 and plan.walkable((u, v))
        for (x, y), (u, v) in pairwise(walked)
    )


def test_between_two_doors_no_exit_is_the_nearest() -> None:
    room = landmarks("#######\n#.....#\n+.....+\n#.....#\n#######\n", (1, 1))
    index = room.building.plan.index
    assert room.exit(index((3, 2))) is None
    assert room.exit(index((2, 2))) is None  # nothing lies beyond the western door


def test_hallways_have_no_exit() -> None:
    known = landmarks(STREET, *STREET_ROOMS)
    assert known.exit(known.building.plan.index((1, 6))) is None


def test_lookouts_leave_out_only_what_cannot_see() -> None:
    known = landmarks(STREET, *STREET_ROOMS)
    plan = known.building.plan
    for target in plan.cells(plan.walkable_mask):
        if plan.is_door(target):
            continue
        seen_from = plan.mask(
            cell
            for cell in plan.cells(plan.walkable_mask)
            if known.sight.field(cell) >> plan.index(target) & 1
        )
        assert not seen_from & ~known.lookouts(target)
