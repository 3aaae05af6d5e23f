"""What an Observation shows, in sentences: where walls, doors and people are from where one stands.

Everything is told as seen by a walker who faces `ahead`: so many steps ahead or behind, so many to
the left or right.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from game.rescuers.literal.grammar import Landmark
from game.rescuers.literal.looking import abreast, floor_around, in_view, same, would_treat
from game.screens.text.phrases import clock_words, counted, joined
from game.world.building import Building
from game.world.floodfill import cost_to_go
from game.world.geometry import Cell, Heading
from game.world.observation import Observation, SeenVictim, VictimState
from game.world.plan import Plan, Tile
from game.world.settings import MissionSettings

MOST_DOORS = 10
"""How many doors of the whole building are told, the nearest first."""
_LANDMARKS: tuple[Landmark, ...] = ("door", "intersection")

Passed = dict[tuple[Landmark, str], Cell | None]
"""What is abreast of a walker on either side."""


def place(ahead: Heading, position: Cell, cell: Cell) -> str:
    """Where a cell is, as `3 ahead and 1 left`."""
    dx, dy = cell[0] - position[0], cell[1] - position[1]
    (fx, fy), (rx, ry) = ahead.step, ahead.right.step
    forward, right = dx * fx + dy * fy, dx * rx + dy * ry
    parts = []
    if forward:
        parts.append(f"{abs(forward)} {'ahead' if forward > 0 else 'behind'}")
    if right:
        parts.append(f"{abs(right)} {'right' if right > 0 else 'left'}")
    return " and ".join(parts) or "where you stand"


def look(now: Observation, ahead: Heading) -> list[str]:
    """All that is in view."""
    here = "You stand in a doorway." if now.plan.is_door(now.position) else ""
    ways = (
        (f"Ahead, {ahead.name.lower()}", ahead), ("Left", ahead.left), ("Right", ahead.right),
        ("Behind", ahead.back),
    )  # fmt: skip
    lines = [here, *(f"{name}: {_along(now, way)}." for name, way in ways)]
    doors = _doorways(now.plan, now.plan.cells(now.visible))
    if doors:
        where = [place(ahead, now.position, _nearest(now.position, door)) for door in doors]
        lines.append(f"Doors in view: {'; '.join(where)}.")
    else:
        lines += [f"No door in view. {line}" for line in _doors_by_steps(now, ahead)[:1]]
    lines += victims_told(now, ahead, now.victims)
    lines += rooms_told(now, ahead, {room.name for room in now.rooms})
    lines.append(in_reach(now))
    return [line for line in lines if line]


def victims_told(now: Observation, ahead: Heading, victims: Iterable[SeenVictim]) -> list[str]:
    """The waiting among `victims`, each in a line."""
    return [
        f"A {victim.severity} victim: {place(ahead, now.position, victim.cell)}."
        for victim in victims
        if victim.state is VictimState.WAITING
    ]


def rooms_told(now: Observation, ahead: Heading, names: Iterable[str]) -> list[str]:
    """The rooms of these names whose middle is in view."""
    wanted = set(names)
    return [
        f"{room.name}: its middle is {place(ahead, now.position, room.label)}."
        for room in now.rooms
        if room.name in wanted
    ]


def in_reach(now: Observation) -> str:
    """Whom a press would treat."""
    cell = would_treat(now)
    if cell is None or now.treatment is not None:
        return ""
    severity = next(victim.severity for victim in now.victims if victim.cell == cell)
    return f"A {severity} victim is in reach: type treat."


def remembered(now: Observation, ahead: Heading) -> list[str]:
    """The people seen before who still wait, as far as is known."""
    lines = [f"Seen before. {line}" for line in victims_told(now, ahead, now.remembered)]
    return lines or ["Nobody seen before still waits."]


def status(now: Observation, rules: MissionSettings) -> list[str]:
    """The numbers of the mission."""
    reds = min(rules.reds_expire_ms, rules.duration_ms) - now.time_ms
    points = "" if now.score is None else f", {counted(now.score, 'point')}"
    lines = [f"{clock_words(now.time_left_ms)} left."]
    died = f"{counted(now.lost, 'red victim')} died."
    lines.append(f"{clock_words(reds)} left for red victims." if reds > 0 else died)
    lines.append(f"{now.rescued} rescued{points}.")
    lines.append(f"You face {now.heading.name.lower()}.")
    return lines


def building_map(now: Observation, ahead: Heading) -> list[str]:
    """What the small map shows: the size of everything, the space around, the nearest doors."""
    plan, (x, y) = now.plan, now.position
    lines = [
        f"The building is {plan.width} cells from west to east and {plan.height} from north to "
        f"south. You are in column {x + 1}, row {y + 1}, counted from the north-west corner."
    ]
    if plan.tile(now.position) is Tile.FLOOR:
        space = floor_around(plan, now.position)
        wide = max(x for x, _ in space) - min(x for x, _ in space) + 1
        high = max(y for _, y in space) - min(y for _, y in space) + 1
        lines.append(
            f"The space around you reaches over {wide} cells from west to east and {high} from "
            "north to south."
        )
    return lines + _doors_by_steps(now, ahead)[:MOST_DOORS]


def _doors_by_steps(now: Observation, ahead: Heading) -> list[str]:
    """The doors of the building, each in a line, the nearest by walking first."""
    plan = now.plan
    to_here = cost_to_go(plan, now.position)
    doors = _doorways(plan, plan.cells(plan.walkable_mask))
    steps = sorted((min(to_here[plan.index(cell)] for cell in door), door) for door in doors)
    lines = []
    for away, door in steps:
        seen = "seen" if any(now.explored >> plan.index(cell) & 1 for cell in door) else "not seen"
        where = place(ahead, now.position, _nearest(now.position, door))
        lines.append(f"A door, {seen}: {where}, {counted(int(away), 'step')} to walk.")
    return lines


def rooms_of(building: Building) -> list[str]:
    """The map with the rooms' names: where the middle of each is from the start."""
    lines = [f"The rooms of {building.name}, from where you start, facing north:"]
    for room in building.rooms:
        where = place(Heading.NORTH, building.start, room.label)
        lines.append(f"{room.name}: {where}; {counted(len(room.doors), 'door')}.")
    return lines


def abreast_of(now: Observation, ahead: Heading) -> Passed:
    """The door and the intersection abreast on either side, as the coach counts them."""
    return {
        (landmark, side): abreast(now, landmark, way)
        for landmark in _LANDMARKS
        for side, way in (("left", ahead.left), ("right", ahead.right))
    }


def came_abreast(before: Passed, after: Passed) -> list[tuple[Landmark, str]]:
    """The doors and intersections that came abreast with the last step, and on which side."""
    return [
        key
        for key, cell in after.items()
        if cell is not None and not same(key[0], before.get(key), cell)
    ]


def _along(now: Observation, way: Heading) -> str:
    """How far one sees, and could walk, straight on."""
    free, cell = 0, way.from_cell(now.position)
    doors = []
    while in_view(now, cell) and now.plan.walkable(cell):
        free += 1
        if now.plan.is_door(cell):
            doors.append(free)
        cell = way.from_cell(cell)
    end = "then a wall" if in_view(now, cell) or cell not in now.plan else "then out of sight"
    if not free:
        return "a wall" if end == "then a wall" else "out of sight"
    through = f", a door after {joined([str(n) for n in doors])}" if doors else ""
    return f"{counted(free, 'step')}{through}, {end}"


def _doorways(plan: Plan, cells: Iterable[Cell]) -> list[tuple[Cell, ...]]:
    """The door cells among `cells`, those side by side together."""
    doors: list[list[Cell]] = []
    for cell in cells:
        if not plan.is_door(cell):
            continue
        beside = next((door for door in doors if any(_next_to(cell, it) for it in door)), None)
        if beside is None:
            doors.append([cell])
        else:
            beside.append(cell)
    return [tuple(door) for door in doors]


def _nearest(position: Cell, cells: Sequence[Cell]) -> Cell:
    return min(cells, key=lambda cell: abs(cell[0] - position[0]) + abs(cell[1] - position[1]))


def _next_to(one: Cell, other: Cell) -> bool:
    return abs(one[0] - other[0]) + abs(one[1] - other[1]) == 1
