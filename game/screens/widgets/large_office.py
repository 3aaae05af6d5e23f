"""The office drawn large: a cell is four columns wide and two rows high."""

from __future__ import annotations

import re
from collections.abc import Iterator

from game.screens.widgets.camera import Camera
from game.screens.widgets.canvas import Row, Run
from game.screens.widgets.glyphs import GlyphSet, Kind
from game.screens.widgets.office import Label, Line
from game.world.geometry import Heading
from game.world.labels import FILLER

COLUMNS, ROWS = 4, 2
"""Of a cell."""

Pair = tuple[str, str]
"""The upper and the lower half of a cell."""

_RUN = re.compile(rb"(.)\1*", re.DOTALL)
_ARROWS: dict[Heading, Pair] = {
    Heading.NORTH: (" ◢◣ ", "◢██◣"),
    Heading.EAST: ("━━█◣", "━━█◤"),
    Heading.SOUTH: ("◥██◤", " ◥◤ "),
    Heading.WEST: ("◢█━━", "◥█━━"),
}
_FULL: Pair = ("◢██◣", "◥██◤")
_OPEN: Pair = ("╭──╮", "╰──╯")
_TICK: Pair = (" ✓  ", "    ")
_CROSS: Pair = (" ✗  ", "    ")
_FIGURES: dict[Kind, Pair] = {
    **dict.fromkeys((Kind.RED, Kind.SEEN_RED, Kind.TREATED_RED), _FULL),
    **dict.fromkeys((Kind.BLUE, Kind.SEEN_BLUE, Kind.TREATED_BLUE), _OPEN),
    **dict.fromkeys((Kind.RESCUED, Kind.SEEN_RESCUED), _TICK),
    **dict.fromkeys((Kind.EXPIRED, Kind.SEEN_EXPIRED), _CROSS),
    **{
        Kind(first + way): pair
        for first in (Kind.PLAYER_NORTH, Kind.ON_RED_NORTH, Kind.ON_BLUE_NORTH)
        for way, pair in _ARROWS.items()
    },
}
_WIDENED = {"▐▌": "▐██▌", "[]": "[  ]"}
"""Both halves of a large door, by the text of a small one."""
_DOTTED = frozenset({Kind.FLOOR, Kind.SEEN_FLOOR})


def large_rows(line: Line, camera: Camera, glyphs: GlyphSet) -> tuple[Row, Row]:
    """A line of the window as two rows, drawn with the colours of `glyphs`."""
    left = max(0, camera.left)
    upper, lower = (list(_runs(line.cells, glyphs, half)) for half in (0, 1))
    if line.label is not None:
        upper = _lay_over(upper, line.label, left)
    if camera.left >= 0:
        return tuple(upper), tuple(lower)
    margin: Run = (" " * (COLUMNS * -camera.left), "dark")
    return (margin, *upper), (margin, *lower)


def _runs(cells: bytes, glyphs: GlyphSet, half: int) -> Iterator[Run]:
    for match in _RUN.finditer(cells):
        kind = Kind(cells[match.start()])
        yield _half(kind, glyphs, half) * (match.end() - match.start()), glyphs[kind].style


def _half(kind: Kind, glyphs: GlyphSet, half: int) -> str:
    if kind in _FIGURES:
        return _FIGURES[kind][half]
    text = glyphs[kind].text
    if kind in _DOTTED:
        return f"{text}  " if half == 0 else "    "
    return _WIDENED.get(text, 2 * text)


def _lay_over(runs: list[Run], label: Label, left: int) -> list[Run]:
    """The runs with a room's name over them, its middle where it is in cells of the usual size."""
    start = 2 * (label.column - 2 * left) + len(label.text) // 2
    end = start + len(label.text)
    over: list[Run] = []
    column = 0
    for text, style in runs:
        before, after = max(0, start - column), max(0, end - column)
        if before < len(text) and after > 0:
            name = label.text[max(0, column - start) : column + len(text) - start]
            over += [
                (text[:before], style),
                (name.replace(FILLER, ""), "label"),
                (text[after:], style),
            ]
        else:
            over.append((text, style))
        column += len(text)
    return [run for run in over if run[0]]
