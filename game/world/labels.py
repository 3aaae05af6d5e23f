"""Where to write a room's name on a map: inside the room, on free floor, wrapped over rows."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import combinations
from unicodedata import east_asian_width

from game.world.building import Room
from game.world.geometry import Cell

FILLER = "\0"
"""Stands after a character that takes two columns, so that a text is as long as it is wide."""


def is_wide(character: str) -> bool:
    """Whether it takes two columns, as Chinese, Japanese and Korean ones do."""
    return east_asian_width(character) in "WF"


def spread(text: str) -> str:
    """The text with a filler after each wide character."""
    if text.isascii():
        return text
    return "".join(it + FILLER if is_wide(it) else it for it in text)


@dataclass(frozen=True)
class MapScale:
    """Terminal columns per cell, and cells (one above the other) per terminal row."""

    columns: int
    cells: int


HALF_BLOCKS = MapScale(columns=1, cells=2)
"""The memorise map: a cell is one column wide and half a row high."""
SQUARES = MapScale(columns=2, cells=1)


@dataclass(frozen=True)
class LabelLine:
    """A piece of a name, spread, from terminal column `column` of map row `row` (both from 0)."""

    column: int
    row: int
    text: str

    @property
    def letters(self) -> Iterator[tuple[int, str]]:
        """Each column with what is drawn there: nothing in the second column of a wide one."""
        for column, letter in enumerate(self.text, start=self.column):
            yield column, "" if letter == FILLER else letter


def fit_label(room: Room, scale: MapScale = HALF_BLOCKS) -> tuple[LabelLine, ...]:
    """The lines of a room's name on the map; none if it does not fit."""
    return label_lines(room.name, room.cells, scale)


def label_lines(
    name: str, cells: Sequence[Cell], scale: MapScale = HALF_BLOCKS
) -> tuple[LabelLine, ...]:
    """The lines of `name` over `cells`, covering no wall; none if it does not fit.

    As few lines as possible, broken between words, centred below each other as near as possible
    to the centroid. Offsets are integers: half columns times the number of cells.
    """
    rows = _free_columns(cells, scale)
    count = len(cells)
    centre = scale.columns * (2 * sum(x for x, _ in cells) + count)
    middle = 2 * sum(y for _, y in cells) + count
    for texts in _wrappings(spread(name).split()):

        def offset(axis: int, top: int, lines: int = len(texts)) -> int:
            off_middle = abs((2 * top + lines) * scale.cells * count - middle)
            return abs(axis * count - centre) + scale.columns * off_middle

        places = [(axis, top) for top in rows for axis in _axes(texts, top, rows)]
        if places:
            axis, top = min(places, key=lambda place: (offset(*place), place))
            return tuple(
                LabelLine((axis - len(text)) // 2, row, text)
                for row, text in enumerate(texts, start=top)
            )
    return ()


def _free_columns(cells: Sequence[Cell], scale: MapScale) -> dict[int, frozenset[int]]:
    """For every map row, the terminal columns in which only `cells` are drawn."""
    rows: dict[int, set[int]] = {}
    drawn = Counter((x, y // scale.cells) for x, y in cells)
    for (x, row), free in drawn.items():
        if free == scale.cells:
            left = x * scale.columns
            rows.setdefault(row, set()).update(range(left, left + scale.columns))
    return {row: frozenset(columns) for row, columns in rows.items()}


def _wrappings(words: Sequence[str]) -> Iterator[tuple[str, ...]]:
    """All ways to break the words into lines: fewest lines first, then shortest longest line."""
    for breaks in range(len(words)):
        ways = []
        for cut in combinations(range(1, len(words)), breaks):
            bounds = zip((0, *cut), (*cut, len(words)), strict=True)
            ways.append(tuple(" ".join(words[start:end]) for start, end in bounds))
        yield from sorted(ways, key=lambda lines: (max(map(len, lines)), lines))


def _axes(texts: Sequence[str], top: int, rows: dict[int, frozenset[int]]) -> list[int]:
    """The axes, in half columns, on which the texts can be centred from row `top` down."""
    free = [rows.get(row, frozenset[int]()) for row in range(top, top + len(texts))]
    fitting = [
        {2 * left + len(text) + half for left in _lefts(columns, len(text)) for half in (0, 1)}
        for columns, text in zip(free, texts, strict=True)
    ]
    return sorted(set.intersection(*fitting))


def _lefts(columns: frozenset[int], length: int) -> set[int]:
    """The columns from which so many are free."""
    lefts = set(columns)
    for offset in range(1, length):
        lefts &= {column - offset for column in columns}
    return lefts
