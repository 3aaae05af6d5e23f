"""From an Observation to the rows of the office view: pure, without terminal or mission."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from functools import cache
from typing import NamedTuple

from game.screens.widgets.camera import Camera
from game.screens.widgets.canvas import Row, Run
from game.screens.widgets.glyphs import (
    NORMAL,
    CellSize,
    GlyphSet,
    Kind,
    player_kind,
    treated_kind,
    victim_kind,
)
from game.world.geometry import Cell, reach
from game.world.labels import FILLER, spread
from game.world.observation import Observation, VictimState
from game.world.plan import Plan, Tile

_RUN = re.compile(rb"(.)\1*", re.DOTALL)
_ALIKE = bytes([0, 0, 0, *range(3, 256)])
"""What is unexplored looks the same, whatever it is."""


class Label(NamedTuple):
    """A room's name as it stands in the view: it begins at column `column` of the whole plan."""

    column: int
    text: str


def kinds(observation: Observation) -> bytes:
    """The `Kind` of every cell of the plan, row by row."""
    plan, index = observation.plan, observation.plan.index
    size = len(plan.tiles)
    shades = (
        int.from_bytes(plan.tiles)
        + 3 * int.from_bytes(plan.flags(observation.explored))
        + 3 * int.from_bytes(plan.flags(observation.visible))
    )
    cells = bytearray(shades.to_bytes(size).translate(_ALIKE))
    for victim in observation.remembered:
        cells[index(victim.cell)] = victim_kind(victim.severity, victim.state, in_view=False)
    under_foot = None
    for victim in observation.victims:
        cells[index(victim.cell)] = victim_kind(victim.severity, victim.state)
        if victim.cell == observation.position and victim.state is VictimState.WAITING:
            under_foot = victim.severity
    if observation.treatment is not None:
        treated = observation.treatment
        cells[index(treated.cell)] = treated_kind(treated.severity)
    cells[index(observation.position)] = player_kind(observation.heading, under_foot)
    return bytes(cells)


def labels(observation: Observation, cells: bytes, size: CellSize = NORMAL) -> dict[int, Label]:
    """The names in view, by row, on lit floor beside their label cells, covering nobody.

    A name stands about its label cell, in two lines or one, where all of that is free, so that it
    mostly keeps its place while the rescuer walks. Else it moves aside, or is cut if it fits
    nowhere.
    """
    placed: dict[int, Label] = {}
    across = size.columns
    for room in observation.rooms:
        x, y = room.label
        free = {
            row: (start, end)
            for row in _rows_beside(observation.plan, room.label)
            if row not in placed
            for start, end in _free_floor(observation.plan, cells, row)
            if start - 1 <= x <= end
        }
        ways = [
            {row: _nearest(text, x, free[row], across) for row, text in enumerate(lines, start=top)}
            for lines in _wrappings(room.name)
            for top in sorted(free, key=lambda row: abs(row - y))
            if all(
                top + n in free and len(line) <= _columns(free[top + n], across)
                for n, line in enumerate(lines)
            )
        ]
        if not ways and free:
            widest = max(free, key=lambda row: (_columns(free[row], across), -abs(row - y)))
            cut = _cut(spread(room.name), _columns(free[widest], across))
            ways = [{widest: _nearest(cut, x, free[widest], across)}]
        at_home = (
            way for way in ways if all(_is_about(x, label, across) for label in way.values())
        )
        placed |= next(at_home, ways[0] if ways else {})
    return placed


class Line(NamedTuple):
    """What one row of the window shows; equal lines are drawn alike."""

    cells: bytes
    label: Label | None


def window_lines(observation: Observation, camera: Camera, size: CellSize = NORMAL) -> list[Line]:
    """The lines of the office in the window of `camera`, from its top; empty beside the plan."""
    cells, plan = kinds(observation), observation.plan
    names = labels(observation, cells, size)
    left, right = max(0, camera.left), min(plan.width, camera.left + camera.columns)
    return [
        Line(cells[y * plan.width + left : y * plan.width + right], names.get(y))
        if 0 <= y < plan.height
        else Line(b"", None)
        for y in range(camera.top, camera.top + camera.rows)
    ]


def line_row(line: Line, camera: Camera, glyphs: GlyphSet, size: CellSize = NORMAL) -> Row:
    """A line of the window, drawn with `glyphs`, with the name on it."""
    runs = list(_runs(line.cells, glyphs))
    left = max(0, camera.left)
    if line.label is not None:
        runs = _lay_over(runs, line.label, size.columns * left)
    margin = size.columns * max(0, -camera.left)
    return ((" " * margin, "dark"), *runs) if camera.left < 0 else tuple(runs)


def line_rows(
    line: Line, camera: Camera, glyphs: Sequence[GlyphSet], size: CellSize
) -> tuple[Row, ...]:
    """The rows of the terminal that a line of the window takes, with the `glyphs` of each."""
    nameless = line._replace(label=None)
    return tuple(
        line_row(nameless if row else line, camera, one, size) for row, one in enumerate(glyphs)
    )


def _runs(line: bytes, glyphs: GlyphSet) -> Iterator[Run]:
    for match in _RUN.finditer(line):
        text, style = glyphs[line[match.start()]]
        yield text * (match.end() - match.start()), style


def _lay_over(runs: list[Run], label: Label, left: int) -> list[Run]:
    start = label.column - left
    end = start + len(label.text)
    over: list[Run] = []
    column = 0
    for text, style in runs:
        before, after = max(0, start - column), max(0, end - column)
        if before < len(text) and after > 0:
            name = label.text[max(0, column - start) : column + len(text) - start]
            shown = name.replace(FILLER, "")
            over += [(text[:before], style), (shown, "label"), (text[after:], style)]
        else:
            over.append((text, style))
        column += len(text)
    return [run for run in over if run[0]]


@cache
def _wrappings(name: str) -> list[list[str]]:
    """A name in one line or broken in two between words, the narrowest way first: it has most
    room to stay where it is."""
    words = spread(name).split()
    cuts = range(1, len(words))
    broken = ([" ".join(words[:cut]), " ".join(words[cut:])] for cut in cuts)
    return sorted([[" ".join(words)], *broken], key=lambda lines: max(map(len, lines)))


def _about(x: int, text: str, across: int) -> int:
    """The column at which a text is in the middle of cell column `x`."""
    return across * x + across // 2 - len(text) // 2


def _is_about(x: int, label: Label, across: int) -> bool:
    return label.column == _about(x, label.text, across)


def _nearest(text: str, x: int, stretch: tuple[int, int], across: int) -> Label:
    """A text in a stretch of cells, as near as it goes to the middle of cell column `x`."""
    start, end = stretch
    return Label(max(across * start, min(_about(x, text, across), across * end - len(text))), text)


def _columns(stretch: tuple[int, int], across: int) -> int:
    return across * (stretch[1] - stretch[0])


def _rows_beside(plan: Plan, label: Cell) -> Iterator[int]:
    """The row of a label cell, then those of its room within two rows, straight up and down."""
    x, y = label
    yield y
    for way in (-1, 1):
        for row in (y + way, y + 2 * way):
            if plan.tile((x, row)) is not Tile.FLOOR:
                break
            yield row


def _free_floor(plan: Plan, cells: bytes, y: int) -> Iterator[tuple[int, int]]:
    """The stretches [start, end) of lit floor in row `y` that nobody stands or lies on."""
    start = y * plan.width
    for match in _RUN.finditer(cells, start, start + plan.width):
        if cells[match.start()] == Kind.FLOOR:
            yield match.start() - start, match.end() - start


def _cut(name: str, columns: int) -> str:
    if len(name) <= columns:
        return name
    return name[: columns - 1 - (name[columns - 1] == FILLER)] + "…"


def in_reach(observation: Observation) -> Cell | None:
    """The cell of the waiting victim in view that triage would treat: the first in `reach`."""
    waiting = {v.cell for v in observation.victims if v.state is VictimState.WAITING}
    cells = reach(observation.position, observation.heading)
    return next((cell for cell in cells if cell in waiting), None)
