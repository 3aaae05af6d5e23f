"""Where the victims of a building lie, where a seed decides it: balanced as the drawn ones are.

Balance is judged by a follower who loses no time: whoever walks the planned route from the start,
at the usual pace.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Iterator, Sequence
from dataclasses import replace
from itertools import islice
from random import Random
from typing import NamedTuple

from game.world.building import Building, Room, Severity
from game.world.drawing import numbered
from game.world.floodfill import Floodfills
from game.world.geometry import Cell
from game.world.route import RoutePlanner
from game.world.settings import MissionSettings
from game.world.writing import with_own_text

SPOTS = 2
"""So many places a room are looked at, if it need not hold more victims."""
_APART = 4
"""Victims of one room lie at least so many cells apart, if there is space."""
_FROM_DOORS = 7
"""They lie at least so many cells from its doors, if there is space."""

_PLACINGS = 40
"""So many ways to place victims are tried for one as balanced as that drawn."""

Lying = tuple[tuple[Cell, Severity], ...]
Spots = tuple[tuple[Cell, ...], ...]


class Reached(NamedTuple):
    """How many victims of either kind a follower who loses no time rescues."""

    red: int
    blue: int

    @property
    def total(self) -> int:
        return self.red + self.blue


def placed_anew(building: Building, seed: int) -> Building:
    """The building with as many victims of either kind in other places, which the seed decides.

    As many rooms have one, two or more of them as before, and a follower who loses no time rescues
    as many, or one fewer; of the ways tried, the one that comes nearest to that.
    """
    random = Random(f"placing/{seed}")
    if not building.victims:
        return building
    drawn = reached_by_follower(building)
    by_room = Counter(building.room_of(victim) for victim in building.victims)
    start = building.room_at(building.start)
    rooms = [room for room in building.rooms if room is not start or room in by_room]
    count = max(SPOTS, *by_room.values())
    spots = tuple(spots_of(room, building, count, random) for room in rooms)
    reds = sum(victim.severity is Severity.RED for victim in building.victims)
    floodfills = building.terrain.floodfills
    best: tuple[int, Lying] | None = None
    for lying in islice(dealt(spots, tuple(by_room.values()), reds, random), _PLACINGS):
        found = reached(floodfills, building.start, lying)
        if found.red == drawn.red and drawn.total - 1 <= found.total <= drawn.total:
            return with_victims(building, lying)
        off = abs(drawn.red - found.red) * len(lying) + abs(drawn.total - found.total)
        if best is None or off < best[0]:
            best = off, lying
    return building if best is None else with_victims(building, best[1])


def reached_by_follower(building: Building) -> Reached:
    """Of a building's victims as they lie, under the usual rules."""
    lying = tuple((victim.cell, victim.severity) for victim in building.victims)
    return reached(building.terrain.floodfills, building.start, lying)


def reached(floodfills: Floodfills, start: Cell, lying: Lying, longer_ms: int = 0) -> Reached:
    """Of victims who lie as given, in a mission that lasts so much longer than usual."""
    usual = MissionSettings()
    settings = replace(
        usual, duration_ms=usual.duration_ms + longer_ms, red_expiry_ms=usual.reds_expire_ms
    )
    sites = {site.id: site for site in numbered(lying)}
    planner = RoutePlanner(floodfills, settings, sites)
    pace_ms = settings.pace_ms
    if planner.reaches_all(start, 0, sites, ms_per_move=pace_ms):
        rescued: Collection[str] = sites
    else:
        rescued = planner.plan(start, 0, sites, ms_per_move=pace_ms).order
    reds = sum(sites[victim].severity is Severity.RED for victim in rescued)
    return Reached(reds, len(rescued) - reds)


def with_victims(building: Building, lying: Lying) -> Building:
    """The building with its victims where `lying` says, and the text that describes it."""
    return with_own_text(replace(building, victims=numbered(lying)))


def spots_of(room: Room, building: Building, count: int, random: Random) -> tuple[Cell, ...]:
    """At most `count` places for victims in a room, apart from each other and from its label, and
    away from its doors if there is space."""
    doors = [cell for door in room.doors for cell in building.doors[door].cells]
    free = [cell for cell in room.cells if cell not in (room.label, building.start)]
    random.shuffle(free)
    far = [cell for cell in free if all(_steps(cell, door) >= _FROM_DOORS for door in doors)]
    chosen: list[Cell] = []
    for cells, apart in ((far, _APART), (free, _APART), (free, 1)):
        for cell in cells:
            if len(chosen) == count:
                return tuple(chosen)
            if all(_steps(cell, other) >= apart for other in chosen):
                chosen.append(cell)
    return tuple(chosen)


def _steps(a: Cell, b: Cell) -> int:
    return abs(a[0] - b[0]) + abs(a[1] - b[1])


def dealt(spots: Spots, counts: Sequence[int], reds: int, random: Random) -> Iterator[Lying]:
    """Victims dealt to rooms with these `spots`, again and again: `counts` says how many lie
    together in a room; the reds lie in different rooms as far as there are enough."""
    while True:
        rooms = list(range(len(spots)))
        random.shuffle(rooms)
        groups: list[list[Cell]] = []
        for count in sorted(counts, reverse=True):
            room = next((room for room in rooms if len(spots[room]) >= count), None)
            if room is None:
                return
            rooms.remove(room)
            groups.append(random.sample(spots[room], count))
        random.shuffle(groups)
        cells = [group[0] for group in groups] + [cell for group in groups for cell in group[1:]]
        yield tuple(
            (cell, Severity.RED if number < reds else Severity.BLUE)
            for number, cell in enumerate(cells)
        )
