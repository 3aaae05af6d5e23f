"""From the drawing in a file to a building: every rule that a building must obey, with hints.

A `Drawing` is the unchecked content of a text file, or of a CSV grid and its legend. `survey` lists
everything that is wrong with it; `build` derives rooms, doors and victims from a valid one.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from functools import cached_property

from game.errors import AnaError
from game.world.building import Building, Door, Room, Severity, VictimSite
from game.world.geometry import Cell, Heading
from game.world.plan import Plan
from game.world.regions import Region, doors_of, doorways, floor_regions, label_cell, reachable

MOST_CELLS, MOST_ROOMS = 40_000, 300
"""A building has no more; the shipped ones have 5,000 cells and 20 rooms."""

_NAME_MARKS = " -'&/"
_OPEN_A_WAY = "Open a way to it with floor or a door"


@dataclass(frozen=True, order=True)
class Problem:
    """A problem at a line and column (both from 1) of a file, and how to fix it."""

    source: str
    line: int
    column: int
    message: str
    hint: str

    @property
    def place(self) -> str:
        return f"{self.source}, line {self.line}, column {self.column}"


class BuildingError(AnaError):
    """A building that cannot be used.

    `problems` holds everything found, in file order; the error's message is the first.
    """

    def __init__(self, problems: tuple[Problem, ...]) -> None:
        first, more = problems[0], len(problems) - 1
        message = first.message
        if more:
            message += f" (and {more} more {'problem' if more == 1 else 'problems'})"
        super().__init__(message, place=first.place, hint=first.hint)
        self.problems = problems


@dataclass(frozen=True)
class RoomMark:
    """A room's name, the cells marked with it, and the line of the file that defines it."""

    name: str
    cells: tuple[Cell, ...]
    line: int


@dataclass(frozen=True)
class Drawing:
    """A building as drawn.

    Row y of the plan is on line `top_line` + y of the file `source`; anything missing from the
    legend belongs at `legend_line` of `legend_source`.
    """

    source: str
    legend_source: str
    name: str
    plan: Plan
    rooms: tuple[RoomMark, ...]
    victims: tuple[tuple[Cell, Severity], ...]
    starts: tuple[tuple[Cell, Heading], ...]
    top_line: int
    legend_line: int

    @cached_property
    def doors(self) -> tuple[Door, ...]:
        return doorways(self.plan)

    @cached_property
    def region_of(self) -> dict[Cell, Region]:
        """The enclosed space that each floor cell belongs to."""
        return {cell: region for region in floor_regions(self.plan) for cell in region}

    def problem(self, cell: Cell, message: str, hint: str) -> Problem:
        return Problem(self.source, self.top_line + cell[1], cell[0] + 1, message, hint)

    def legend_problem(self, line: int, message: str, hint: str) -> Problem:
        return Problem(self.legend_source, line, 1, message, hint)


def too_large(plan: Plan, rooms: int, source: str, line: int) -> Problem | None:
    """The problem of a plan with more cells or rooms than can be worked with in a few seconds."""
    cells = plan.width * plan.height
    if cells > MOST_CELLS:
        message = f"the plan has {plan.width} x {plan.height} = {cells} cells, at most {MOST_CELLS}"
        return Problem(source, line, 1, f"{message} are possible", "Draw a smaller building")
    if rooms > MOST_ROOMS:
        message = f"the plan has {rooms} rooms, at most {MOST_ROOMS} are possible"
        return Problem(source, line, 1, message, "Open some rooms to each other, or leave them out")
    return None


def build(drawing: Drawing, text: str) -> Building:
    """The building described by a valid drawing (one in which `survey` finds nothing)."""
    doors = drawing.doors
    rooms = []
    for mark in drawing.rooms:
        cells = drawing.region_of[mark.cells[0]]
        rooms.append(Room(mark.name, cells, label_cell(cells), doors_of(cells, doors)))
    rooms.sort(key=lambda room: (room.cells[0][1], room.cells[0][0]))
    victims = numbered(drawing.victims)
    start, heading = drawing.starts[0]
    return Building(drawing.name, drawing.plan, tuple(rooms), doors, victims, start, heading, text)


def numbered(lying: Iterable[tuple[Cell, Severity]]) -> tuple[VictimSite, ...]:
    """The victims with their ids: `v01`, `v02`, ... row by row over the plan."""
    in_order = sorted(lying, key=lambda victim: (victim[0][1], victim[0][0]))
    return tuple(
        VictimSite(f"v{number:02}", cell, severity)
        for number, (cell, severity) in enumerate(in_order, start=1)
    )


def survey(drawing: Drawing) -> tuple[Problem, ...]:
    """Everything that makes a drawing invalid, in file order; of a too large one, only that."""
    too_much = too_large(drawing.plan, len(drawing.rooms), drawing.source, drawing.top_line)
    if too_much is not None:
        return (too_much,)
    return tuple(
        sorted(
            (
                *_outer_wall(drawing),
                *_start(drawing),
                *_crowds(drawing),
                *_names(drawing),
                *_spaces(drawing),
            )
        )
    )


def _outer_wall(drawing: Drawing) -> Iterator[Problem]:
    plan = drawing.plan
    right, bottom = plan.width - 1, plan.height - 1
    sides = {
        "north": [(x, 0) for x in range(plan.width)],
        "south": [(x, bottom) for x in range(plan.width)],
        "west": [(0, y) for y in range(1, bottom)],
        "east": [(right, y) for y in range(1, bottom)],
    }
    for side, cells in sides.items():
        gaps = [cell for cell in cells if plan.walkable(cell)]
        if gaps:
            count = "" if len(gaps) == 1 else f" in {len(gaps)} cells, first here"
            yield drawing.problem(
                gaps[0],
                f"the {side} outer wall is open{count}",
                "Draw wall all around the plan",
            )


def _start(drawing: Drawing) -> Iterator[Problem]:
    if not drawing.starts:
        yield drawing.legend_problem(
            drawing.legend_line,
            "the building has no start",
            "Add exactly one start, with the direction it faces",
        )
    for cell, _ in drawing.starts[1:]:
        yield drawing.problem(
            cell, "the building has more than one start", "Keep exactly one start"
        )


def _crowds(drawing: Drawing) -> Iterator[Problem]:
    """One thing per cell: a text file can draw no more, and a room's glyph needs a cell too."""
    taken = {cell for cell, _ in drawing.starts}
    for cell, severity in drawing.victims:
        if cell in taken:
            yield drawing.problem(
                cell,
                f"the {severity} victim is on a cell that is already taken",
                "Move it to a free cell",
            )
        taken.add(cell)
    for mark in drawing.rooms:
        if taken.issuperset(drawing.region_of[mark.cells[0]]):
            yield drawing.problem(
                mark.cells[0],
                f"'{mark.name}' has no free cell",
                "Leave one of its cells free of victims and of the start",
            )


def _names(drawing: Drawing) -> Iterator[Problem]:
    first_line: dict[str, int] = {}
    for mark in drawing.rooms:
        known = first_line.setdefault(mark.name.casefold(), mark.line)
        if known != mark.line:
            yield drawing.legend_problem(
                mark.line,
                f"the room name '{mark.name}' is already used on line {known}",
                "Give every room its own name; capitals make no difference",
            )
        if not sound_name(mark.name):
            yield drawing.legend_problem(
                mark.line,
                f"'{mark.name}' is not a valid room name",
                "Begin with a letter or digit; use letters, digits, single spaces and - ' & /",
            )


def sound_name(name: str) -> bool:
    """Whether the coach can use the name in a sentence."""
    return (
        name[:1].isalnum()
        and name == " ".join(name.split())
        and all(letter.isalnum() or letter in _NAME_MARKS for letter in name)
    )


def _spaces(drawing: Drawing) -> Iterator[Problem]:
    """Each room has one name, a door and a way to it; every victim is in a room."""
    region_of = drawing.region_of
    reached = _reached(drawing)
    named: dict[Cell, str] = {}
    for mark in drawing.rooms:
        home = region_of[mark.cells[0]]
        stray = next((cell for cell in mark.cells if region_of[cell] is not home), None)
        if stray is not None:
            yield drawing.problem(
                stray,
                f"'{mark.name}' is in two enclosed spaces",
                "Keep a room's glyphs inside its walls, or remove the wall between them",
            )
        other = named.setdefault(home[0], mark.name)
        if other != mark.name:
            yield drawing.problem(
                mark.cells[0],
                f"'{mark.name}' and '{other}' are in the same enclosed space",
                "Separate them with a wall and a door, or keep one of the names",
            )
        elif not doors_of(home, drawing.doors):
            yield drawing.problem(
                mark.cells[0], f"'{mark.name}' has no door", "Draw a door in its wall"
            )
        elif home[0] not in reached:
            yield drawing.problem(
                mark.cells[0], f"'{mark.name}' cannot be reached from the start", _OPEN_A_WAY
            )
    for cell, severity in drawing.victims:
        if region_of[cell][0] in named:
            continue
        if cell in reached:
            yield drawing.problem(
                cell,
                f"the {severity} victim is not in a named room",
                "Move the victim into a room, or add a room name where it is",
            )
        else:
            yield drawing.problem(
                cell, f"the {severity} victim cannot be reached from the start", _OPEN_A_WAY
            )


def _reached(drawing: Drawing) -> frozenset[Cell]:
    """The cells that can be reached from any start; every cell if there is no start."""
    if not drawing.starts:
        plan = drawing.plan
        return frozenset(plan.cells(plan.walkable_mask))
    return frozenset().union(*(reachable(drawing.plan, cell) for cell, _ in drawing.starts))
