"""A building drawn with characters: the whole plan, room names, victims and start.

The picture does not depend on a terminal: it is rows of strokes, and the caller chooses colours.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from enum import Enum
from itertools import groupby

from game.world.building import Building, Severity
from game.world.geometry import Heading
from game.world.labels import MapScale, label_lines
from game.world.plan import Plan, Tile


class Ink(Enum):
    """What a stroke stands for."""

    FLOOR = "floor"
    WALL = "wall"
    DOOR = "door"
    NAME = "name"
    RED = "red"
    BLUE = "blue"
    START = "start"


@dataclass(frozen=True)
class Stroke:
    """Characters in one ink on paper of another."""

    text: str
    ink: Ink
    paper: Ink = Ink.FLOOR


Row = tuple[Stroke, ...]

_TILE_INKS = {Tile.FLOOR: Ink.FLOOR, Tile.WALL: Ink.WALL, Tile.DOOR: Ink.DOOR}
_TILE_MARKS = {Ink.FLOOR: " ", Ink.WALL: "█", Ink.DOOR: "▒"}
VICTIM_SIGNS = {Severity.RED: "●", Severity.BLUE: "○"}
"""What a waiting victim is on every map."""
_VICTIM_INKS = {Severity.RED: Ink.RED, Severity.BLUE: Ink.BLUE}
_MARKED = (Ink.RED, Ink.BLUE, Ink.START)
_START_MARKS = {Heading.NORTH: "▲", Heading.EAST: "▶", Heading.SOUTH: "▼", Heading.WEST: "◀"}

LEGEND: Row = (
    Stroke("▒", Ink.DOOR),
    Stroke(" door  ", Ink.NAME),
    Stroke("▲", Ink.START),
    Stroke(" start  ", Ink.NAME),
    Stroke(VICTIM_SIGNS[Severity.RED], Ink.RED),
    Stroke(" red victim  ", Ink.NAME),
    Stroke(VICTIM_SIGNS[Severity.BLUE], Ink.BLUE),
    Stroke(" blue victim", Ink.NAME),
)


def picture(building: Building, scale: MapScale) -> tuple[Row, ...]:
    """The building at `scale`, top row first, one stroke a terminal column.

    A name that does not fit its room is left out.
    """
    plan = building.plan
    canvas = [
        [
            _ground(plan, column // scale.columns, row, scale)
            for column in range(_columns(plan, scale))
        ]
        for row in range(-(-plan.height // scale.cells))
    ]
    marks = {
        victim.cell: (VICTIM_SIGNS[victim.severity], _VICTIM_INKS[victim.severity])
        for victim in building.victims
    }
    marks[building.start] = _START_MARKS[building.start_heading], Ink.START
    for (x, y), (mark, ink) in marks.items():
        canvas[y // scale.cells][x * scale.columns] = Stroke(mark, ink)
    for room in building.rooms:
        free = tuple(cell for cell in room.cells if cell not in marks)
        for line in label_lines(room.name, free, scale) if free else ():
            for column, letter in line.letters:
                canvas[line.row][column] = Stroke(letter, Ink.NAME)
    return tuple(tuple(row) for row in canvas)


_QUARTERS = " ▘▝▀▖▌▞▛▗▚▐▜▄▙▟█"
"""By the sum of 1 (upper left), 2 (upper right), 4 (lower left) and 8 (lower right)."""


def small_picture(building: Building, numbers: Mapping[str, int]) -> tuple[Row, ...]:
    """The building with four cells a character, and in place of their names the `numbers` of its
    rooms."""
    plan = building.plan
    columns, rows = -(-plan.width // 2), -(-plan.height // 2)
    canvas = [[_quarter(plan, 2 * x, 2 * y) for x in range(columns)] for y in range(rows)]
    for victim in building.victims:
        x, y = victim.cell
        sign = Stroke(VICTIM_SIGNS[victim.severity], _VICTIM_INKS[victim.severity])
        canvas[y // 2][x // 2] = sign
    x, y = building.start
    canvas[y // 2][x // 2] = Stroke(_START_MARKS[building.start_heading], Ink.START)
    for room in building.rooms:
        number, row = str(numbers[room.name]), canvas[room.label[1] // 2]
        middle = room.label[0] // 2
        left = min(
            range(middle - len(number), middle + 2),
            key=lambda start: (
                sum(row[at].ink in _MARKED for at in range(start, start + len(number))),
                abs(start - middle),
            ),
        )
        row[left : left + len(number)] = [Stroke(digit, Ink.NAME) for digit in number]
    return tuple(tuple(row) for row in canvas)


def _quarter(plan: Plan, left: int, top: int) -> Stroke:
    tiles = [plan.tile((left + dx, top + dy)) for dy in (0, 1) for dx in (0, 1)]
    if Tile.DOOR in tiles:
        return Stroke(_TILE_MARKS[Ink.DOOR], Ink.DOOR)
    walls = sum(1 << place for place, tile in enumerate(tiles) if tile is Tile.WALL)
    return Stroke(_QUARTERS[walls], Ink.WALL if walls else Ink.FLOOR)


def joined(row: Row) -> Row:
    """The row with neighbouring strokes of the same ink and paper merged."""
    runs = groupby(row, key=lambda stroke: (stroke.ink, stroke.paper))
    return tuple(
        Stroke("".join(stroke.text for stroke in run), ink, paper) for (ink, paper), run in runs
    )


def _columns(plan: Plan, scale: MapScale) -> int:
    return plan.width * scale.columns


def _ground(plan: Plan, x: int, row: int, scale: MapScale) -> Stroke:
    """The cell, or the two cells above each other, at column `x` of the plan."""
    inks = [_TILE_INKS[plan.tile((x, row * scale.cells + below))] for below in range(scale.cells)]
    if scale.cells == 1 or inks[0] is inks[1]:
        return Stroke(_TILE_MARKS[inks[0]], inks[0])
    if Ink.WALL not in inks:
        return Stroke(_TILE_MARKS[Ink.DOOR], Ink.DOOR)
    upper, lower = inks
    return Stroke("▀", upper, lower) if upper is Ink.WALL else Stroke("▄", lower, upper)
