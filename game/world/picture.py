"""A building drawn with characters: the whole plan, room names, victims and start.

The picture does not depend on a terminal: it is rows of strokes, and the caller chooses colours.
"""

from __future__ import annotations

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
_VICTIM_MARKS = {Severity.RED: ("◆", Ink.RED), Severity.BLUE: ("●", Ink.BLUE)}
_START_MARKS = {Heading.NORTH: "▲", Heading.EAST: "▶", Heading.SOUTH: "▼", Heading.WEST: "◀"}

LEGEND: Row = (
    Stroke("▒", Ink.DOOR),
    Stroke(" door  ", Ink.NAME),
    Stroke("▲", Ink.START),
    Stroke(" start  ", Ink.NAME),
    Stroke("◆", Ink.RED),
    Stroke(" red victim  ", Ink.NAME),
    Stroke("●", Ink.BLUE),
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
    marks = {victim.cell: _VICTIM_MARKS[victim.severity] for victim in building.victims}
    marks[building.start] = _START_MARKS[building.start_heading], Ink.START
    for (x, y), (mark, ink) in marks.items():
        canvas[y // scale.cells][x * scale.columns] = Stroke(mark, ink)
    for room in building.rooms:
        free = tuple(cell for cell in room.cells if cell not in marks)
        for line in label_lines(room.name, free, scale) if free else ():
            for column, letter in line.letters:
                canvas[line.row][column] = Stroke(letter, Ink.NAME)
    return tuple(tuple(row) for row in canvas)


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
