"""Drawing by rows of styled runs, of which only those that changed are painted again."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from itertools import zip_longest
from textwrap import wrap

from rich.cells import cell_len
from rich.segment import Segment
from rich.style import Style
from textual.geometry import Region, Size
from textual.strip import Strip
from textual.widget import Widget

Run = tuple[str, str]
"""A text and its style: a component class, or `a/b` for the colour of `a` on the ground of `b`."""
Row = tuple[Run, ...]

BLANK: Row = ()

_WIDE = "\u1100-\u115f\u2e80-\ua4cf\uac00-\ud7a3\uf900-\ufaff\ufe30-\ufe4f\uff01-\uff60"
_CLOSING = "\u3001\u3002\uff0c\uff0e\uff01\uff1f\u30fc\u300d\u300f\uff09\u3011\u30fb\u2026\u3005"
_PIECES = re.compile(rf"[{_WIDE}][{_CLOSING}]*\s*|[^\s{_WIDE}]+\s*|\s+")
"""What stays together on a line: a wide character with the marks that may not begin one, a word."""


def width(row: Row) -> int:
    """Columns of a row."""
    return sum(cell_len(text) for text, _ in row)


def sliced(row: Row, start: int, end: int) -> Row:
    """Columns `start` to `end` (exclusive) of a row."""
    kept: list[Run] = []
    column = 0
    for text, style in row:
        first, last, columns = max(0, start - column), max(0, end - column), cell_len(text)
        part = text[first:last] if columns == len(text) else _cut(text, first, last)
        if part:
            kept.append((part, style))
        column += columns
    return tuple(kept)


def _cut(text: str, start: int, end: int) -> str:
    """Columns of a text with characters that take two: half a character is a blank."""
    upto, _ = Segment(text).split_cells(end)
    _, kept = upto.split_cells(start)
    return kept.text


def centred(row: Row, columns: int, style: str = "") -> Row:
    """A row with as much blank on its left as centres it in `columns`."""
    return ((" " * max(0, (columns - width(row)) // 2), style), *row)


def padded(row: Row, columns: int, style: str = "") -> Row:
    """A row of exactly `columns`, cut or filled up with blank of a style."""
    missing = columns - width(row)
    if missing > 0:
        return (*row, (" " * missing, style))
    return sliced(row, 0, columns) if missing else row


def wrapped(text: str, columns: int) -> list[str]:
    """A text in lines of at most `columns`: broken at blanks, between characters that take two
    columns, and within what is longer than a whole line."""
    if cell_len(text) == len(text):
        return wrap(text, columns)
    lines, line = [], ""
    for piece in _PIECES.findall(text):
        if cell_len(line + piece.rstrip()) > columns and line:
            lines.append(line.rstrip())
            line = ""
        line += piece if line else piece.lstrip()
        while cell_len(line.rstrip()) > columns:
            cut = next(
                n for n in range(len(line), 0, -1) if cell_len(line[:n]) <= columns or n == 1
            )
            lines.append(line[:cut])
            line = line[cut:]
    return [*lines, line.rstrip()] if line.strip() else lines


def unbroken(text: str) -> list[str]:
    """What `wrapped` breaks only where it is longer than a whole line."""
    return [piece.rstrip() for piece in _PIECES.findall(text) if piece.strip()]


def beside(left: Sequence[Row], right: Sequence[Row], columns: int) -> list[Row]:
    """Two blocks of rows side by side; the right one begins at column `columns`."""
    return [
        (*padded(one, columns), *other) for one, other in zip_longest(left, right, fillvalue=())
    ]


def difference(old: Row, new: Row, columns: int) -> tuple[int, int]:
    """Columns from which and up to which (exclusive) two unequal rows may differ in `columns`."""
    start = 0
    for one, other in zip(old, new, strict=False):
        if one != other:
            break
        start += cell_len(one[0])
    tail = 0
    if width(old) == width(new):
        for one, other in zip(reversed(old), reversed(new), strict=False):
            if one != other:
                break
            tail += cell_len(one[0])
        return start, width(new) - tail
    return start, columns


def plain(rows: Iterable[Row]) -> list[str]:
    """The characters of rows, without their styles."""
    return ["".join(text for text, _ in row) for row in rows]


class Canvas(Widget):
    """A widget that shows rows. Styles are its component classes, so colours live in CSS.

    It has margins, but no border and no padding: its lines go to the screen as they are, and those
    that stay the same are made once.
    """

    DEFAULT_CSS = "Canvas { height: auto; }"

    def __init__(
        self,
        rows: Sequence[Row] = (),
        *,
        id: str | None = None,
        classes: str | None = None,
    ) -> None:
        super().__init__(id=id, classes=classes)
        self._rows: list[Row] = list(rows)
        self._strips: dict[int, Strip] = {}
        self._inks: dict[str, Style] = {}
        self._papers: dict[str, Style] = {}

    @property
    def rows(self) -> list[Row]:
        """What stands on the canvas."""
        return self._rows

    @property
    def size(self) -> Size:
        """Columns and rows to draw in: all of the widget."""
        return self.outer_size

    def draw(self, rows: Sequence[Row]) -> None:
        """Show `rows`, painting only the lines that differ from what is shown."""
        before, self._rows = self._rows, list(rows)
        if len(before) != len(self._rows):
            self._strips.clear()
            self.refresh(layout=True)
            return
        columns = self.size.width
        changed = []
        for y, (old, new) in enumerate(zip(before, self._rows, strict=True)):
            if old is not new and old != new:
                start, end = difference(old, new, columns)
                changed.append(Region(start, y, end - start, 1))
                self._strips.pop(y, None)
        if changed:
            self.refresh(*changed)

    def _fill(self, rows: Sequence[Row]) -> None:
        """Have these rows when it is next painted: for a layout that gives it another size."""
        if self._rows != rows:
            self._rows = list(rows)
            self._strips.clear()

    def get_content_height(self, container: object, viewport: object, width: int) -> int:
        return len(self._rows)

    def get_content_width(self, container: object, viewport: object) -> int:
        return max(map(width, self._rows), default=0)

    def notify_style_update(self) -> None:
        super().notify_style_update()
        assert not self.styles.gutter, f"{self} cannot have a border or padding"
        self._strips.clear()
        self._inks.clear()
        self._papers.clear()

    def render_lines(self, crop: Region) -> list[Strip]:
        columns = self.size.width
        strips = [self._strip(y, columns) for y in crop.line_range]
        if crop.column_span == (0, columns):
            return strips
        return [strip.crop(crop.x, crop.right) for strip in strips]

    def _strip(self, y: int, columns: int) -> Strip:
        """A whole line as it is sent, made once as long as it stays the same."""
        strip = self._strips.get(y)
        if strip is None or strip.cell_length != columns:
            row = self._rows[y] if y < len(self._rows) else BLANK
            segments = [
                Segment(text, self._paper(style) if text.isspace() else self._ink(style))
                for text, style in padded(row, columns)
            ]
            strip = self._strips[y] = Strip(segments, columns)
        return strip

    def _ink(self, name: str) -> Style:
        """How a style is sent to the terminal."""
        ink = self._inks.get(name)
        if ink is None:
            segments = [Segment(" ", self._mix(name))]
            for line_filter in self.get_line_filters():
                segments = line_filter.apply(segments, self.background_colors[1])
            ink = self._inks[name] = segments[0].style or Style()
        return ink

    def _paper(self, name: str) -> Style:
        """How a blank in a style is sent: without a colour that nobody sees."""
        paper = self._papers.get(name)
        if paper is None:
            ink = self._ink(name)
            paper = ink if ink.reverse else Style(bgcolor=ink.bgcolor)
            self._papers[name] = paper
        return paper

    def _mix(self, name: str) -> Style:
        if not name:
            return self.rich_style
        colour, _, ground = name.partition("/")
        ink = self.get_component_rich_style(colour)
        if not ground:
            return ink
        return ink + Style(bgcolor=self.get_component_rich_style(ground).bgcolor)
