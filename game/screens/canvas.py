"""Drawing by rows of styled runs, of which only those that changed are painted again."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from itertools import zip_longest

from rich.segment import Segment
from rich.style import Style
from textual.geometry import Region
from textual.strip import Strip
from textual.widget import Widget

Run = tuple[str, str]
"""A text and its style: a component class, or `a/b` for the colour of `a` on the ground of `b`."""
Row = tuple[Run, ...]

BLANK: Row = ()


def width(row: Row) -> int:
    """Columns of a row in which every character takes one."""
    return sum(len(text) for text, _ in row)


def sliced(row: Row, start: int, end: int) -> Row:
    """Columns `start` to `end` (exclusive) of a row."""
    kept: list[Run] = []
    column = 0
    for text, style in row:
        part = text[max(0, start - column) : max(0, end - column)]
        if part:
            kept.append((part, style))
        column += len(text)
    return tuple(kept)


def centred(row: Row, columns: int, style: str = "") -> Row:
    """A row with as much blank on its left as centres it in `columns`."""
    return ((" " * max(0, (columns - width(row)) // 2), style), *row)


def padded(row: Row, columns: int) -> Row:
    """A row of exactly `columns`, cut or filled up with blank."""
    missing = columns - width(row)
    return (*row, (" " * missing, "")) if missing >= 0 else sliced(row, 0, columns)


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
        start += len(one[0])
    tail = 0
    if width(old) == width(new):
        for one, other in zip(reversed(old), reversed(new), strict=False):
            if one != other:
                break
            tail += len(one[0])
        return start, width(new) - tail
    return start, columns


def plain(rows: Iterable[Row]) -> list[str]:
    """The characters of rows, without their styles."""
    return ["".join(text for text, _ in row) for row in rows]


class Canvas(Widget):
    """A widget that shows rows. Styles are its component classes, so colours live in CSS."""

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
        self._inks: dict[str, Style] = {}

    @property
    def rows(self) -> list[Row]:
        """What stands on the canvas."""
        return self._rows

    def draw(self, rows: Sequence[Row]) -> None:
        """Show `rows`, painting only the lines that differ from what is shown."""
        before, self._rows = self._rows, list(rows)
        if len(before) != len(self._rows):
            self.refresh(layout=True)
            return
        columns = self.size.width
        changed = []
        for y, (old, new) in enumerate(zip(before, self._rows, strict=True)):
            if old is not new and old != new:
                start, end = difference(old, new, columns)
                changed.append(Region(start, y, end - start, 1))
        if changed:
            self.refresh(*changed)

    def get_content_height(self, container: object, viewport: object, width: int) -> int:
        return len(self._rows)

    def get_content_width(self, container: object, viewport: object) -> int:
        return max(map(width, self._rows), default=0)

    def notify_style_update(self) -> None:
        super().notify_style_update()
        self._inks.clear()

    def render_line(self, y: int) -> Strip:
        ground = self._ink("")
        columns = self.size.width
        if y >= len(self._rows):
            return Strip.blank(columns, ground)
        segments = [Segment(text, self._ink(style)) for text, style in self._rows[y]]
        return Strip(segments).adjust_cell_length(columns, ground)

    def _ink(self, name: str) -> Style:
        ink = self._inks.get(name)
        if ink is None:
            ink = self._inks[name] = self._mix(name)
        return ink

    def _mix(self, name: str) -> Style:
        if not name:
            return self.rich_style
        colour, _, ground = name.partition("/")
        ink = self.get_component_rich_style(colour)
        if not ground:
            return ink
        return ink + Style(bgcolor=self.get_component_rich_style(ground).bgcolor)
