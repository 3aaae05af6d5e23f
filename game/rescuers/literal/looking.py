"""What a reader makes out in an Observation: doors and openings abreast, ways out, victims."""

from __future__ import annotations

from collections.abc import Callable

from game.rescuers.literal.grammar import Landmark
from game.world.building import Severity
from game.world.geometry import HEADINGS, Cell, Heading
from game.world.observation import Observation, VictimState
from game.world.plan import Plan, Tile

GLANCE = 5
"""How many cells to the side somebody looks for a door or an opening."""


def abreast(now: Observation, landmark: Landmark, side: Heading) -> Cell | None:
    """The door cell abreast on one side, or the farthest floor cell of an opening there.

    Looking sideways over floor in view: the first cell that is not floor, if it is a door cell, is
    a door abreast; floor as far as a glance goes is an opening (an intersection).
    """
    cell = now.position
    for _ in range(GLANCE):
        cell = side.from_cell(cell)
        if not in_view(now, cell):
            return None
        if now.plan.tile(cell) is not Tile.FLOOR:
            return cell if landmark == "door" and now.plan.is_door(cell) else None
    return cell if landmark == "intersection" else None


def same(landmark: Landmark, before: Cell | None, here: Cell) -> bool:
    """Whether what is abreast here is still what was abreast one step before: door cells side by
    side are one door, and an opening lasts until a wall ends it."""
    if before is None:
        return False
    return landmark == "intersection" or _apart(before, here) == 1


def in_view(now: Observation, cell: Cell) -> bool:
    """Whether the reader sees `cell` from where it stands."""
    return cell in now.plan and bool(now.visible >> now.plan.index(cell) & 1)


def waiting(now: Observation, severity: Severity) -> list[Cell]:
    """The waiting victims of one colour in view."""
    return [
        victim.cell
        for victim in now.victims
        if victim.severity is severity and victim.state is VictimState.WAITING
    ]


def remembered(now: Observation, severity: Severity) -> list[Cell]:
    """The victims of one colour that wait, as far as the reader has seen."""
    return waiting(now, severity) + [
        victim.cell
        for victim in now.remembered
        if victim.severity is severity and victim.state is VictimState.WAITING
    ]


def would_treat(now: Observation) -> Cell | None:
    """Whom a press would treat: own cell, then ahead, then clockwise."""
    cells = {victim.cell for victim in now.victims if victim.state is VictimState.WAITING}
    ahead = now.heading
    around = (ahead, ahead.right, ahead.back, ahead.left)
    reach = (now.position, *(heading.from_cell(now.position) for heading in around))
    return next((cell for cell in reach if cell in cells), None)


def ways_to_nearest(
    start: Cell, wanted: Callable[[Cell], bool], passable: Callable[[Cell], bool]
) -> list[list[Cell]]:
    """For each of the wanted cells that are nearest, and equally near, the cells of a shortest way
    over passable ones. The way is empty where `start` itself is wanted."""
    came_from = {start: start}
    frontier = [start]
    while frontier:
        found = [cell for cell in frontier if wanted(cell)]
        if found:
            return [_traced(came_from, cell) for cell in found]
        reached = []
        for cell in frontier:
            x, y = cell
            for near in ((x, y - 1), (x + 1, y), (x, y + 1), (x - 1, y)):
                if near not in came_from and (passable(near) or wanted(near)):
                    came_from[near] = cell
                    reached.append(near)
        frontier = reached
    return []


def floor_around(plan: Plan, cell: Cell) -> frozenset[Cell]:
    """The floor that walls and doors close off around a floor cell."""
    found = {cell}
    frontier = [cell]
    while frontier:
        here = frontier.pop()
        for heading in HEADINGS:
            near = heading.from_cell(here)
            if near not in found and plan.tile(near) is Tile.FLOOR:
                found.add(near)
                frontier.append(near)
    return frozenset(found)


def _traced(came_from: dict[Cell, Cell], end: Cell) -> list[Cell]:
    way = [end]
    while came_from[way[-1]] != way[-1]:
        way.append(came_from[way[-1]])
    return way[-2::-1]


def _apart(one: Cell, other: Cell) -> int:
    return abs(one[0] - other[0]) + abs(one[1] - other[1])
