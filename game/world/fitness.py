"""What a sound building may still lack for a study: `ana building check` refuses it."""

from __future__ import annotations

from collections.abc import Iterator

from game.world.building import Building
from game.world.drawing import Problem
from game.world.geometry import Cell
from game.world.labels import HALF_BLOCKS, fit_label

SCREEN = (120, 40)
"""Columns and rows of a study's screen, unless the study says otherwise."""

MAP_MARGIN = (22, 4)
"""Columns and rows of that screen that a building's map leaves to names, clock and keys."""


def shortcomings(
    building: Building, source: str, top_line: int, screen: tuple[int, int] = SCREEN
) -> tuple[Problem, ...]:
    """Everything that makes a building unfit for a study with such a screen, in file order.

    The plan's first row stands on line `top_line` of the file `source`.
    """
    found = (*_size(building, screen), *_victims(building), *_labels(building))
    return tuple(
        Problem(source, top_line + y, x + 1, message, hint)
        for (x, y), message, hint in sorted(found, key=lambda each: each[0][::-1])
    )


_Shortcoming = tuple[Cell, str, str]


def _size(building: Building, screen: tuple[int, int]) -> Iterator[_Shortcoming]:
    width, height = building.plan.width, building.plan.height
    widest = screen[0] - MAP_MARGIN[0]
    highest = (screen[1] - MAP_MARGIN[1]) * HALF_BLOCKS.cells
    if width > widest or height > highest:
        message = (
            f"{width} x {height} cells are more than the map of a study can show on a screen of "
            f"{screen[0]} x {screen[1]}"
        )
        hint = f"Draw at most {widest} x {highest} cells, or enlarge [screen] in study.toml"
        yield (0, 0), message, hint


def _victims(building: Building) -> Iterator[_Shortcoming]:
    if not building.victims:
        yield (0, 0), "the building has no victims", "Place victims in its rooms"


def _labels(building: Building) -> Iterator[_Shortcoming]:
    for room in building.rooms:
        if not fit_label(room):
            message = f"the name '{room.name}' does not fit its room on the study's map"
            hint = "Shorten the name or enlarge the room; one row of the map is two cells high"
            yield room.label, message, hint
