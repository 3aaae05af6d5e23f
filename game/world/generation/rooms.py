"""Blocks become rooms, each of which borders a corridor; and doors between the two."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator
from random import Random
from typing import NamedTuple

from game.world.generation.area import Area
from game.world.geometry import Cell, Heading

SHORTEST_SIDE = (8, 6)
"""The least width and height of a room, in cells; a name needs more width than height."""
_LARGEST = 420
"""A room with more cells than this is always divided."""
_MOST_DRAWN_OUT = 3.6
"""A room is at most so many times as long as it is wide."""
_OPEN_PLAN = range(270, _LARGEST + 1)
"""The size of a floor without walls, which a building has one of where one comes about."""
_CORNER = 2
"""A door stands at least so many cells from its room's corners."""
_SECOND_DOOR = 0.35
_DOUBLE_DOOR = 0.12


class Run(NamedTuple):
    """Wall cells in a line, with a room on one side (`side` of it) and a corridor on the other."""

    side: Heading
    cells: tuple[Cell, ...]


class Entrance(NamedTuple):
    """A door's cells, and the side of the room it is on."""

    side: Heading
    cells: tuple[Cell, ...]


def rooms_in(
    blocks: Iterable[Area], corridors: Collection[Cell], count: int, random: Random
) -> list[Area]:
    """The blocks divided into about `count` rooms: the largest first, with some chance."""
    whole = list(blocks)
    rooms: list[Area] = []
    open_plan = False
    while whole and len(whole) + len(rooms) < count:
        chosen = max(whole, key=lambda area: area.size * random.uniform(0.8, 1.2))
        whole.remove(chosen)
        if not open_plan and chosen.size in _OPEN_PLAN:
            open_plan = True
            rooms.append(chosen)
            continue
        halves = _halved(chosen, corridors, random)
        if halves:
            whole += halves
        else:
            rooms.append(chosen)
    for area in whole:
        halves = _halved(area, corridors, random) if area.size > _LARGEST else ()
        rooms += halves or (area,)
    return rooms


def _halved(area: Area, corridors: Collection[Cell], random: Random) -> tuple[Area, ...]:
    """Two rooms from one, both at a corridor, across its longer side if possible; else none."""
    wide = area.width >= 1.2 * area.height
    for upright in (wide, not wide):
        work = area if upright else area.turned()
        low, high = work.left + 5, work.right - 5
        walls = [x for x in range(low, high + 1) if 0.36 <= (x - work.left) / work.width <= 0.64]
        random.shuffle(walls)
        for x in walls:
            pair = work._replace(right=x - 1), work._replace(left=x + 1)
            halves = pair if upright else (pair[0].turned(), pair[1].turned())
            if all(_roomy(half) and runs(half, corridors) for half in halves):
                return halves
    return ()


def _roomy(area: Area) -> bool:
    long, short = max(area.width, area.height), min(area.width, area.height)
    least_width, least_height = SHORTEST_SIDE
    return (
        area.width >= least_width
        and area.height >= least_height
        and long <= _MOST_DRAWN_OUT * short
    )


def runs(area: Area, corridors: Collection[Cell]) -> list[Run]:
    """Where a door could stand: away from the corners, with a corridor right behind the wall."""
    return [run for side in Heading for run in _runs(area, side, corridors)]


def _runs(area: Area, side: Heading, corridors: Collection[Cell]) -> Iterator[Run]:
    found: list[Cell] = []
    for cell in [*tuple(area.wall(side).cells())[_CORNER:-_CORNER], None]:
        if cell is not None and side.from_cell(cell) in corridors:
            found.append(cell)
        elif found:
            yield Run(side, tuple(found))
            found = []


def entrances(
    area: Area, corridors: Collection[Cell], taken: Collection[Cell], random: Random, *, lobby: bool
) -> list[Entrance]:
    """The doors of a room: one, sometimes a second on another side; of a lobby, a double door on
    every side that has a corridor. Empty where no door can stand clear of those `taken`."""
    ways = runs(area, corridors)
    random.shuffle(ways)
    ways.sort(key=lambda run: len(run.cells) < 4)
    wanted = len(Heading) if lobby else 1 + (random.random() < _SECOND_DOOR)
    doors: list[Entrance] = []
    for run in ways:
        if len(doors) == wanted or any(door.side is run.side for door in doors):
            continue
        cells = _doorway(run, taken, random, double=lobby or random.random() < _DOUBLE_DOOR)
        if cells:
            doors.append(Entrance(run.side, cells))
    return doors


def _doorway(
    run: Run, taken: Collection[Cell], random: Random, *, double: bool
) -> tuple[Cell, ...]:
    """The cells of a door somewhere in a run, apart from all other doors."""
    width = 2 if double and len(run.cells) > 1 else 1
    places = list(range(len(run.cells) - width + 1))
    random.shuffle(places)
    for place in places:
        cells = run.cells[place : place + width]
        near = {way.from_cell(cell) for cell in cells for way in Heading}
        if not near & set(taken):
            return cells
    return ()
