"""What a sound building may still lack for a study: `ana building check` refuses it."""

from __future__ import annotations

from collections.abc import Iterator

from game.world.building import Building
from game.world.drawing import Problem
from game.world.geometry import Cell
from game.world.labels import HALF_BLOCKS, fit_label

MAP_COLUMNS = 120
MAP_ROWS = 36
"""What the study's fixed screen of 120 x 40 leaves for the whole building."""


def shortcomings(building: Building, source: str, top_line: int) -> tuple[Problem, ...]:
    """Everything that makes a building unfit for a study, in file order.

    The plan's first row stands on line `top_line` of the file `source`.
    """
    found = (*_size(building), *_victims(building), *_labels(building))
    return tuple(
        Problem(source, top_line + y, x + 1, message, mend)
        for (x, y), message, mend in sorted(found, key=lambda each: each[0][::-1])
    )


_Shortcoming = tuple[Cell, str, str]


def _size(building: Building) -> Iterator[_Shortcoming]:
    width, height = building.plan.width, building.plan.height
    most = MAP_ROWS * HALF_BLOCKS.cells
    if width > MAP_COLUMNS or height > most:
        message = f"{width} x {height} cells are more than the study's map can show"
        yield (0, 0), message, f"Draw at most {MAP_COLUMNS} x {most} cells"


def _victims(building: Building) -> Iterator[_Shortcoming]:
    if not building.victims:
        yield (0, 0), "there is no victim in the building", "Place victims in its rooms"


def _labels(building: Building) -> Iterator[_Shortcoming]:
    for room in building.rooms:
        if not fit_label(room):
            message = f"the name '{room.name}' does not fit its room on the study's map"
            mend = "Shorten the name or enlarge the room: two cells high are one row of the map"
            yield room.label, message, mend
