"""An office from a seed: corridors, rooms, doors, names, furniture, a start and victims.

What does not pass the checks of a drawn building, or is too easy or too hard, is drawn again. Each
try has its own stream of random numbers, so that a seed gives the same building on every machine.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable
from functools import lru_cache
from itertools import count, islice
from random import Random
from statistics import mean
from typing import NamedTuple

from game.world.building import Building
from game.world.drawing import Drawing, RoomMark, build, survey
from game.world.fitness import shortcomings
from game.world.floodfill import cost_to_go
from game.world.generation.area import Area, Grid
from game.world.generation.furniture import furnished
from game.world.generation.layout import lay_out
from game.world.generation.rooms import Entrance, entrances, rooms_in
from game.world.generation.uses import BUILDINGS, LOBBIES, USES, Use
from game.world.geometry import Cell, Heading
from game.world.labels import HALF_BLOCKS, label_lines
from game.world.placing import SPOTS, Lying, dealt, reached, spots_of, with_victims
from game.world.plan import Plan, Tile
from game.world.regions import label_cell, reachable

SIZE = (95, 52)
"""Columns and rows, as of the mission buildings that are drawn by hand."""
ROOMS = (19, 20, 20, 20, 21, 22)
VICTIMS, REDS = 20, 7
RESCUED = (18, 19)
"""What a follower who loses no time rescues, every red among them."""
_LOST_BY_PLAN_MS = 9_000
"""A good walker can be so much faster than the plan, which allows a move for each treatment."""
_OCCUPIED = (15, 16, 16, 17)
"""So many rooms have victims: one or two."""
_FEWEST_EMPTY = 3
_PLACINGS = 14
"""So many ways to place the victims are tried in one layout."""
_FLOOR = range(2650, 3500)
"""The floor of all rooms together, in cells."""
_MEAN_WAY = (48, 72)
"""Moves from the start to a room's label, on average."""
_AS_FLOWN = 60
"""At most so many steps from the start to the middle of a room, on average, if no wall were in the
way."""
_LOBBY = range(110, 331)
"""The size of a lobby, in cells."""
_SHAFT = 0.3
"""How often a corner of a large room is closed off, for lifts or pipes."""


_Doors = dict[Area, list[Entrance]]


class _Entry(NamedTuple):
    """The room with the start, the start, and which way it faces."""

    lobby: Area
    start: Cell
    facing: Heading


class _Room(NamedTuple):
    """A room's name, and its floor without furniture."""

    name: str
    floor: tuple[Cell, ...]


@lru_cache(maxsize=32)
def generated(seed: int) -> Building:
    """The office of a seed, with about 20 named rooms, 7 red and 13 blue victims."""
    name = f"{Random(f'generation/name/{seed}').choice(BUILDINGS)} {seed}"
    tries = (_office(name, Random(f"generation/{attempt}/{seed}")) for attempt in count())
    return next(office for office in tries if office is not None)


def _office(name: str, random: Random) -> Building | None:
    """One try; None where it fails a check."""
    layout = lay_out(*SIZE, random)
    if layout is None:
        return None
    corridors = {cell for corridor in layout.corridors for cell in corridor.cells()}
    areas = rooms_in(layout.blocks, corridors, random.choice(ROOMS), random)
    entry = _entry(areas, random)
    if len(areas) not in ROOMS or entry is None:
        return None
    doors = _doors(areas, entry.lobby, corridors, random)
    if doors is None or not _central(
        _plan(corridors, doors, (area.cells() for area in areas)), entry.start, areas
    ):
        return None
    rooms = _rooms(areas, doors, entry, random)
    if rooms is None or sum(len(room.floor) for room in rooms) not in _FLOOR:
        return None
    plan = _plan(corridors, doors, (room.floor for room in rooms))
    if len(reachable(plan, entry.start)) != plan.walkable_mask.bit_count():
        return None
    marks = tuple(RoomMark(room.name, (label_cell(room.floor),), line=1) for room in rooms)
    starts = ((entry.start, entry.facing),)
    drawing = Drawing(name, name, name, plan, marks, (), starts, top_line=1, legend_line=1)
    if survey(drawing):
        return None
    empty = build(drawing, text="")
    lying = _victims(empty, rooms[areas.index(entry.lobby)].name, random)
    if lying is None:
        return None
    office = with_victims(empty, lying)
    return None if shortcomings(office, name, top_line=1) else office


def _entry(areas: list[Area], random: Random) -> _Entry | None:
    """The lobby is at an outer wall; the start in it faces inwards from there."""
    width, height = SIZE
    entries = [
        _Entry(area, _just_inside(area, side), side.back)
        for area in areas
        if area.size in _LOBBY
        for side, outside in (
            (Heading.SOUTH, area.bottom == height - 2),
            (Heading.WEST, area.left == 1),
            (Heading.EAST, area.right == width - 2),
            (Heading.NORTH, area.top == 1),
        )
        if outside
    ]
    middles = [area.middle for area in areas]
    central = [
        entry
        for entry in entries
        if mean(abs(x - entry.start[0]) + abs(y - entry.start[1]) for x, y in middles) <= _AS_FLOWN
    ]
    return random.choice(central) if central else None


def _just_inside(area: Area, side: Heading) -> Cell:
    """A cell beside the middle of a room's wall, and one step from it."""
    x, y = area.middle
    match side:
        case Heading.NORTH:
            return x, area.top + 1
        case Heading.EAST:
            return area.right - 1, y
        case Heading.SOUTH:
            return x, area.bottom - 1
        case Heading.WEST:
            return area.left + 1, y


def _central(shell: Plan, start: Cell, areas: Iterable[Area]) -> bool:
    """Whether the start is neither too near the rooms nor too far from them."""
    from_start = cost_to_go(shell, start)
    way = mean(from_start[shell.index(area.middle)] for area in areas)
    return _MEAN_WAY[0] <= way <= _MEAN_WAY[1]


def _doors(
    areas: Iterable[Area], lobby: Area, corridors: Collection[Cell], random: Random
) -> _Doors | None:
    """The doors of each room; None where a room can have none."""
    taken: set[Cell] = set()
    doors: _Doors = {}
    for area in areas:
        doors[area] = entrances(area, corridors, taken, random, lobby=area is lobby)
        if not doors[area]:
            return None
        taken.update(cell for entrance in doors[area] for cell in entrance.cells)
    return doors


def _rooms(
    areas: Iterable[Area], doors: _Doors, entry: _Entry, random: Random
) -> list[_Room] | None:
    """The rooms with names that suit and fit them; None where there is none for a room."""
    uses = list(USES)
    random.shuffle(uses)
    rooms: list[_Room] = []
    for area in areas:
        at_start = area is entry.lobby
        clear = _kept_clear(area, doors[area], entry.start if at_start else None)
        shaft = _shaft(area, clear, random)
        suitable = [use for use in uses if use.least <= area.size <= use.most]
        if at_start:
            suitable = random.sample(LOBBIES, len(LOBBIES))
        made = (_room(area, use, shaft, clear, random) for use in suitable)
        room = next(filter(None, made), None)
        if room is None:
            return None
        rooms.append(room)
        uses = [use for use in uses if use.name != room.name]
    return rooms


def _room(area: Area, use: Use, shaft: set[Cell], clear: set[Cell], random: Random) -> _Room | None:
    """The room in this use, furnished round its name; None where the name does not fit."""
    bare = tuple(cell for cell in area.cells() if cell not in shaft)
    name = {
        (line.column + offset, line.row * HALF_BLOCKS.cells + below)
        for line in label_lines(use.name, bare)
        for offset in range(len(line.text))
        for below in range(HALF_BLOCKS.cells)
    }
    if not name:
        return None
    taken = furnished(area, use.arrange, clear | name, random)
    return _Room(use.name, tuple(cell for cell in bare if cell not in taken))


def _kept_clear(area: Area, entrances: Iterable[Entrance], start: Cell | None) -> set[Cell]:
    """Where nothing may stand: in front of doors, and around the start."""
    clear: set[Cell] = set()
    for entrance in entrances:
        inwards = entrance.side.back
        for cell in entrance.cells:
            for ahead in (1, 2):
                front = inwards.from_cell(cell, ahead)
                clear |= {front, inwards.left.from_cell(front), inwards.right.from_cell(front)}
    if start is not None:
        x, y = start
        clear.update(Area(x - 1, y - 1, x + 1, y + 1).cells())
    return clear.intersection(area.cells())


def _shaft(area: Area, clear: set[Cell], random: Random) -> set[Cell]:
    """A closed corner of a large room; empty in most."""
    if min(area.width, area.height) < 10 or random.random() > _SHAFT:
        return set()
    width = random.randint(4, max(4, area.width // 3))
    height = random.randint(3, max(3, area.height // 3))
    left = random.choice((area.left, area.right - width + 1))
    top = random.choice((area.top, area.bottom - height + 1))
    around = Area(left - 1, top - 1, left + width, top + height)
    if any(cell in clear for cell in around.cells()):
        return set()
    return set(Area(left, top, left + width - 1, top + height - 1).cells())


def _plan(corridors: Collection[Cell], doors: _Doors, floors: Iterable[Iterable[Cell]]) -> Plan:
    grid = Grid(*SIZE)
    grid.draw(corridors, Tile.FLOOR)
    for floor in floors:
        grid.draw(floor, Tile.FLOOR)
    for ways in doors.values():
        for entrance in ways:
            grid.draw(entrance.cells, Tile.DOOR)
    return grid.plan()


def _victims(building: Building, lobby: str, random: Random) -> Lying | None:
    """Where the victims lie so that a follower rescues neither too many nor too few; None where
    no such way was found."""
    floodfills = building.terrain.floodfills
    spots = tuple(
        spots_of(room, building, SPOTS, random) for room in building.rooms if room.name != lobby
    )
    most = len(building.rooms) - _FEWEST_EMPTY
    occupied = random.choice([number for number in _OCCUPIED if number <= most])
    counts = [2] * (VICTIMS - occupied) + [1] * (2 * occupied - VICTIMS)
    for lying in islice(dealt(spots, counts, REDS, random), _PLACINGS):
        found = reached(floodfills, building.start, lying)
        if found.red == REDS and found.total in RESCUED:
            at_most = reached(floodfills, building.start, lying, _LOST_BY_PLAN_MS)
            if at_most.total in RESCUED:
                return lying
    return None
