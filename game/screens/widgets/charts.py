"""Charts of a value over a mission's time, in line-drawing and block characters."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import NamedTuple

from game.screens.widgets.canvas import Row, Run

MINUTE_MS = 60_000
_MARK_COLUMNS = 2
"""At least so wide are the marks on the left, so that charts one below the other are in line."""
_BAR_COLUMNS = 3
"""Of a bar and the blank after it."""
_EIGHTHS = " ▁▂▃▄▅▆▇█"


class ChartStep(NamedTuple):
    """From `at_ms` on the value is `value`."""

    at_ms: int
    value: int


def step_chart(
    title: str,
    steps: Sequence[ChartStep],
    labels: Sequence[tuple[int, str]],
    end_ms: int,
    full_ms: int,
    *,
    columns: int,
    rows: int,
) -> list[Row]:
    """A line from the first step to `end_ms` on an axis of `full_ms`, `rows` high without title
    and axis.

    `labels` are the values with a mark on the left, of which the first is the lowest and the last
    the highest shown.
    """
    margin = max(_MARK_COLUMNS, *(len(text) for _, text in labels)) + 1
    lowest, highest = labels[0][0], labels[-1][0]

    def line_of(value: int) -> int:
        return round((rows - 1) * (highest - value) / (highest - lowest))

    wide = columns - margin - 1
    grid = [[" "] * wide for _ in range(rows)]
    before: int | None = None
    for column, value in enumerate(_by_column(steps, end_ms, full_ms, wide)):
        if value is not None:
            here = line_of(value)
            _draw_step(grid, column, here, here if before is None else before)
            before = here
    marks = {line_of(value): text for value, text in labels}
    return _framed(title, ["".join(line) for line in grid], "line", marks, margin, full_ms)


def area_chart(
    title: str,
    steps: Sequence[ChartStep],
    highest: int,
    end_ms: int,
    full_ms: int,
    *,
    columns: int,
    rows: int,
) -> list[Row]:
    """The area under the steps, from 0 to `highest`, in eighths of a row."""
    margin = max(_MARK_COLUMNS, len(str(highest))) + 1
    wide = columns - margin - 1
    values = _by_column(steps, end_ms, full_ms, wide)
    heights = [-(-8 * rows * (value or 0) // highest) for value in values]
    lines = [
        "".join(
            _EIGHTHS[max(0, min(8, height - 8 * (rows - 1 - row)))] for height in heights
        ).ljust(wide)
        for row in range(rows)
    ]
    return _framed(title, lines, "area", {0: str(highest), rows - 1: "0"}, margin, full_ms)


def bars(
    title: str, values: Sequence[tuple[int, str]], highest: int, *, columns: int, rows: int
) -> list[Row]:
    """A bar for each value, in its style, from 0 to `highest`, in eighths of a row; the last ones
    where there are more than fit. The title and the axis take a row each."""
    margin = max(_MARK_COLUMNS, len(str(highest))) + 1
    wide = max(1, (columns - margin - 1) // _BAR_COLUMNS)
    shown = values[-wide:]
    body: list[Row] = []
    for row in range(rows):
        mark = str(highest) if row == 0 else "0" if row == rows - 1 else ""
        line: list[Run] = [(f"{mark:>{margin - 1}} ", "quiet"), ("┤" if mark else "│", "faint")]
        for value, style in shown:
            height = -(-8 * rows * value // max(1, highest)) - 8 * (rows - 1 - row)
            line.append((_EIGHTHS[max(0, min(8, height))] * (_BAR_COLUMNS - 1) + " ", style))
        body.append(tuple(line))
    axis = "└" + "─" * (_BAR_COLUMNS * len(shown))
    return [((f"{' ' * margin} {title}", "title"),), *body, ((" " * margin, ""), (axis, "faint"))]


def _by_column(
    steps: Sequence[ChartStep], end_ms: int, full_ms: int, wide: int
) -> list[int | None]:
    """The value at each column of the axis, up to the one of `end_ms`."""
    values: list[int | None] = []
    for column in range(min(wide, 1 + (wide - 1) * end_ms // full_ms)):
        at_ms = full_ms * column // max(1, wide - 1)
        past = [step.value for step in steps if step.at_ms <= at_ms]
        values.append(past[-1] if past else None)
    return values


def _draw_step(grid: list[list[str]], column: int, here: int, before: int) -> None:
    if here == before:
        grid[here][column] = "━"
        return
    up = here < before
    grid[here][column] = "┏" if up else "┗"
    grid[before][column] = "┛" if up else "┓"
    for between in range(min(here, before) + 1, max(here, before)):
        grid[between][column] = "┃"


def _framed(
    title: str,
    lines: Sequence[str],
    style: str,
    marks: Mapping[int, str],
    margin: int,
    full_ms: int,
) -> list[Row]:
    """Title, lines with their marks on the left, and an axis of minutes."""
    wide = max(len(line) for line in lines)
    body: list[Row] = []
    for number, line in enumerate(lines):
        mark = f"{marks.get(number, ''):>{margin - 1}} "
        body.append(((mark, "quiet"), ("┤" if number in marks else "│", "faint"), (line, style)))
    ticks, names = ["─"] * wide, [" "] * (wide + 1)
    last = full_ms // MINUTE_MS
    for minute in (0, last, *range(1, last)):
        at = (wide - 1) * minute * MINUTE_MS // full_ms
        ticks[at] = "┴"
        name = f"{minute}:00"
        start = max(0, min(at - 1, wide - len(name)))
        end = start + len(name)
        if not "".join(names[max(0, start - 1) : end + 1]).strip():
            names[start:end] = name
    indent = " " * margin
    return [
        ((f"{indent} {title}", "title"),),
        *body,
        ((indent, ""), ("└" + "".join(ticks), "faint")),
        ((f"{indent} {''.join(names).rstrip()}", "quiet"),),
    ]
