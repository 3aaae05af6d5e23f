"""Names, victims and a start for a bare plan, drawn from a seed.

Each choice has its own stream, `random.Random("furnishing/<purpose>/<seed>")`, so that a plan and a
seed give the same building on every machine.
"""

from __future__ import annotations

from random import Random

from game.world.building import Door, Severity
from game.world.drawing import BuildingError, Drawing, Problem, RoomMark, too_large
from game.world.geometry import Cell, Heading
from game.world.labels import label_lines
from game.world.plan import Plan
from game.world.regions import Region, doors_of, doorways, floor_regions, label_cell, reachable

VICTIMS = 20
REDS = 7
SMALLEST_ROOM = 6
"""An enclosed space with fewer floor cells gets no name."""


def furnish(plan: Plan, name: str, seed: int, source: str) -> Drawing:
    """A bare plan with names, victims and a start.

    The enclosed space with the most doors (the largest of several) is the hallway network, which
    has the start. Every other enclosed space that can be reached and is not tiny is a room.
    Victims are spread evenly over the rooms as far as there is space. Raises BuildingError if
    the plan has no room, or is too large.
    """
    if (problem := too_large(plan, 0, source, 1)) is not None:
        raise BuildingError((problem,))
    doors = doorways(plan)
    regions = floor_regions(plan)
    hallway = max(
        regions, key=lambda region: (len(doors_of(region, doors)), len(region)), default=()
    )
    walkable = reachable(plan, hallway[0]) if hallway else frozenset()
    rooms = [
        region
        for region in regions
        if region is not hallway and region[0] in walkable and len(region) >= SMALLEST_ROOM
    ]
    if not rooms:
        problem = Problem(
            source,
            1,
            1,
            "the grid has no room that is connected by a door",
            "Mark the doors between rooms and hallways with 2",
        )
        raise BuildingError((problem,))
    if (problem := too_large(plan, len(rooms), source, 1)) is not None:
        raise BuildingError((problem,))
    start = _stream("start", seed).choice(hallway)
    marks = tuple(
        RoomMark(room_name, (label_cell(region),), line=1)
        for room_name, region in zip(_names(rooms, seed), rooms, strict=True)
    )
    return Drawing(
        source,
        source,
        name,
        plan,
        marks,
        _victims(rooms, doors, seed),
        ((start, _widest_view(plan, start)),),
        top_line=1,
        legend_line=1,
    )


def _stream(purpose: str, seed: int) -> Random:
    return Random(f"furnishing/{purpose}/{seed}")


def _names(rooms: list[Region], seed: int) -> list[str]:
    """A different name for each room, if possible one that fits its room on the map."""
    left = list(ROOM_NAMES)
    _stream("names", seed).shuffle(left)
    chosen = []
    for number, region in enumerate(rooms, start=1):
        fitting = next((name for name in left if label_lines(name, region)), None)
        name = fitting or (min(left, key=len) if left else f"Room {number}")
        if name in left:
            left.remove(name)
        chosen.append(name)
    return chosen


def _victims(
    rooms: list[Region], doors: tuple[Door, ...], seed: int
) -> tuple[tuple[Cell, Severity], ...]:
    """Victims dealt to the rooms in turn, in random order, away from the doors if possible."""
    stream = _stream("victims", seed)
    thresholds = {
        heading.from_cell(cell) for door in doors for cell in door.cells for heading in Heading
    }
    free: list[list[Cell]] = []
    for region in rooms:
        label = label_cell(region)
        cells = [cell for cell in region if cell != label]
        stream.shuffle(cells)
        free.append(sorted(cells, key=lambda cell: cell not in thresholds))
    lying: list[Cell] = []
    while len(lying) < VICTIMS and any(free):
        order = [cells for cells in free if cells]
        stream.shuffle(order)
        lying += [cells.pop() for cells in order[: VICTIMS - len(lying)]]
    severities = [Severity.RED] * REDS + [Severity.BLUE] * (VICTIMS - REDS)
    stream.shuffle(severities)
    return tuple(zip(lying, severities, strict=False))


def _widest_view(plan: Plan, cell: Cell) -> Heading:
    """The heading with the longest free run ahead; the first of several, clockwise from north."""

    def run(heading: Heading) -> int:
        steps = 0
        while plan.walkable(heading.from_cell(cell, steps + 1)):
            steps += 1
        return steps

    return max(Heading, key=run)


_ROOM_NAMES = """
Audit Office, Badge Office, Ballroom, Bike Store, Book Store, Branch Office, Briefing Room, Buying
Office, Card Room, Chart Room, Coffee Bar, Coat Room, Cold Store, Council Room, Craft Room, Data
Room, Dining Hall, Dispatch, Drawing Office, Estate Office, Events Room, Exam Room, Film Room,
Fitting Room, Form Store, Garden Room, Gift Shop, Grants Office, Green Room, Help Desk, Host
Office, Key Room, Lamp Store, Laundry, Lecture Room, Loan Desk, Map Room, Media Room, Model Room,
Music Room, News Room, North Office, Nurse Room, Paint Store, Parcel Room, Parts Store, Permit
Office, Phone Room, Photo Lab, Pool Room, Project Room, Quiet Room, Radio Room, Rent Office,
Repair Shop, Safe Room, Sample Room, Sound Room, South Office, Spare Room, Staff Room, Survey
Office, Switch Room, Tax Office, Tool Room, Travel Desk, Trophy Room, Typing Room, Vault, Video
Room, Visa Office, Waiting Room, Water Lab, West Office, Writing Room
"""
ROOM_NAMES = tuple(" ".join(_ROOM_NAMES.split()).split(", "))
