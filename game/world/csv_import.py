"""Buildings from plain CSV grids (0 floor, 1 wall, 2 door), as used in earlier studies.

A grid has no names, victims or start. They come from a small legend beside it
(docs/building-format.md) or, if there is none, from `game.world.furnishing` and a seed.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

from game.world.building import Building, Severity
from game.world.drawing import BuildingError, Drawing, Problem, RoomMark, build, survey
from game.world.furnishing import furnish
from game.world.geometry import Cell, Heading
from game.world.plan import Plan, Tile
from game.world.reading import COMMENT
from game.world.writing import with_own_text

_TILES = {str(tile.value): tile for tile in Tile}
_PLACED = re.compile(
    r"(?:room (?P<room>.+)|(?P<victim>red|blue) victim|start)"
    r" at (?P<x>\d+)\s*,\s*(?P<y>\d+)(?: facing (?P<facing>north|east|south|west))?"
)
_OTHER_SEPARATORS = {";": "semicolons", "\t": "tabs", " ": "spaces", "|": "bars"}
_TILE_VALUES = "Use 0 for floor, 1 for wall or 2 for a door"
_PLACINGS = (
    "Write 'room NAME at X,Y', 'red victim at X,Y', 'blue victim at X,Y' "
    "or 'start at X,Y facing north|east|south|west'"
)


def import_grid(
    grid: str, source: str, *, name: str, legend: str | None, legend_source: str, seed: int
) -> Building:
    """The building of a CSV `grid`, furnished by `legend` or, if that is None, by `seed`.

    Raises BuildingError, which names `source` or `legend_source`.
    """
    plan = read_grid(grid, source)
    if legend is None:
        drawing = furnish(plan, name, seed, source)
    else:
        drawing = _read_legend(legend, plan, name, source, legend_source)
    problems = survey(drawing)
    if problems:
        raise BuildingError(problems)
    return with_own_text(build(drawing, text=""))


def read_grid(grid: str, source: str) -> Plan:
    """The plan in a CSV grid. Raises BuildingError; its columns count values, not characters."""
    rows = [line.split(",") for line in grid.rstrip().splitlines()]
    problems = tuple(_grid_problems(rows, source))
    if problems:
        raise BuildingError(problems)
    tiles = bytes(_TILES[value.strip()] for row in rows for value in row)
    return Plan(len(rows[0]), len(rows), tiles)


def _grid_problems(rows: list[list[str]], source: str) -> Iterator[Problem]:
    if not rows:
        yield Problem(source, 1, 1, "the file is empty", "Fill it with rows of 0, 1 and 2")
        return
    apart = next((it for it in _OTHER_SEPARATORS if it in rows[0][0]), None)
    if len(rows[0]) == 1 and apart is not None:
        message = f"the values are separated by {_OTHER_SEPARATORS[apart]}, not by commas"
        yield Problem(source, 1, 1, message, "Save the grid again with commas between the values")
        return
    width = len(rows[0])
    for number, row in enumerate(rows, start=1):
        for column, value in enumerate(row, start=1):
            if value.strip() not in _TILES:
                message = f"'{value.strip()[:20]}' is not a tile"
                yield Problem(source, number, column, message, _TILE_VALUES)
        if len(row) != width:
            message = f"the row has {len(row)} values, the first has {width}"
            hint = "Give every row the same number of values"
            yield Problem(source, number, min(len(row), width) + 1, message, hint)


def _read_legend(legend: str, plan: Plan, name: str, source: str, legend_source: str) -> Drawing:
    problems: list[Problem] = []
    rooms: list[RoomMark] = []
    victims: list[tuple[Cell, Severity]] = []
    starts: list[tuple[Cell, Heading]] = []
    lines = legend.splitlines()
    for number, raw in enumerate(lines, start=1):
        line = raw.strip()
        if not line or line.startswith(COMMENT):
            continue
        if line.startswith("name:"):
            name = line.removeprefix("name:").strip() or name
            continue
        placed = _PLACED.fullmatch(line)
        if placed is None or line.startswith("start") != bool(placed["facing"]):
            message, hint = f"'{line[:40]}' is not a valid line", _PLACINGS
            problems.append(Problem(legend_source, number, 1, message, hint))
            continue
        cell = int(placed["x"]), int(placed["y"])
        if plan.tile(cell) is not Tile.FLOOR:
            message = (
                f"{cell[0]},{cell[1]} is not a floor cell of the {plan.width} x {plan.height} grid"
            )
            hint = "Give x,y, both counted from 0 at the top left"
            problems.append(Problem(legend_source, number, placed.start("x") + 1, message, hint))
        elif placed["room"]:
            rooms.append(RoomMark(placed["room"], (cell,), number))
        elif placed["victim"]:
            victims.append((cell, Severity(placed["victim"])))
        else:
            starts.append((cell, Heading[placed["facing"].upper()]))
    if problems:
        raise BuildingError(tuple(problems))
    return Drawing(
        source,
        legend_source,
        name,
        plan,
        tuple(rooms),
        tuple(victims),
        tuple(starts),
        top_line=1,
        legend_line=max(1, len(lines)),
    )
