"""The experimenter's screen: who is where in a study, followed every second."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from itertools import accumulate
from pathlib import Path, PurePath
from typing import ClassVar

from textual import events
from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.containers import VerticalScroll

from game.errors import AnaError
from game.screens.widgets.canvas import BLANK, Canvas, Row, wrapped
from game.screens.widgets.keyline import KeyLine
from game.screens.widgets.program import Program
from game.screens.widgets.signals import lead_out
from game.study.lab.attendance import SessionStatus
from game.study.lab.status_text import (
    HEADER,
    HINDRANCES,
    other_lines,
    session_cells,
    study_line,
    totals_line,
)
from game.study.lab.study_status import StatusReader, StudyStatus

EVERY_S = 1.0
GAP = 2
NOTHING = ("-", "0")
"""Cells that tell nothing."""

_STYLES = {
    "taking part": "going",
    "left": "quiet",
    "cut off": "trouble",
    "finished": "done",
    "declined": "quiet",
    "turned away": "quiet",
}


def status_rows(status: StudyStatus, columns: int = 120) -> list[Row]:
    """The screen's lines, none wider than so many columns: the study, its totals, a line a session
    and below it what has no room there, and what is wrong."""

    def told(style: str, *lines: str) -> list[Row]:
        return [((f" {part}", style),) for line in lines for part in wrapped(line, columns - 2)]

    live = f"Live sessions: {totals_line(status.totals)}"
    rows = told("title", study_line(status))
    rows += [*told("quiet", live, *other_lines(status.sessions)), BLANK]
    if status.hindrances:
        rows += [*told("trouble", HINDRANCES, *status.hindrances), BLANK]
    if not status.sessions:
        rows.append(((" Nobody has started yet.", "quiet"),))
        return rows
    cells = [session_cells(session) for session in status.sessions]
    widths = [max(map(len, column)) for column in zip(HEADER, *cells, strict=True)]
    shown = _shown(widths, columns)
    rows.append((_line(HEADER, widths[:shown], "quiet"),))
    for line, session in zip(cells, status.sessions, strict=True):
        rows.append((_line(line, widths[:shown], _style(session)),))
        rows += [((f"   {part}", _style(session)),) for part in _below(line, shown, columns - 4)]
    if status.problems:
        rows += [BLANK, ((" Look at:", "title"),)]
        rows += told("trouble", *status.problems)
    if status.not_come:
        rows += [BLANK, *told("quiet", f"Not begun: {', '.join(status.not_come)}")]
    return rows


def _shown(widths: Sequence[int], columns: int) -> int:
    """How many of the table's columns have room beside each other."""
    ends = [end + GAP * number for number, end in enumerate(accumulate(widths), start=1)]
    return sum(end < columns for end in ends) or 1


def _below(cells: Sequence[str], shown: int, columns: int) -> list[str]:
    """What is to be told of a session beyond the columns that are shown, with its column's name."""
    rest = zip(HEADER[shown:], cells[shown:], strict=True)
    return wrapped(", ".join(f"{name} {it}" for name, it in rest if it not in NOTHING), columns)


def _line(cells: Sequence[str], widths: Sequence[int], style: str) -> tuple[str, str]:
    padded = (text.ljust(width) for text, width in zip(cells, widths, strict=False))
    return f" {(' ' * GAP).join(padded)}", style


def _style(session: SessionStatus) -> str:
    if session.problems:
        return "trouble"
    return "quiet" if session.mode == "simulated" else _STYLES[session.state]


class StatusTable(Canvas):
    """Shows the state of a study."""

    COMPONENT_CLASSES: ClassVar[set[str]] = {"title", "quiet", "going", "done", "trouble"}

    DEFAULT_CSS = """
    StatusTable { width: auto; height: auto; }
    StatusTable > .title { text-style: bold; }
    StatusTable > .quiet { color: $ana-quiet; }
    StatusTable > .going { color: $ana-text; text-style: bold; }
    StatusTable > .done { color: $ana-high; }
    StatusTable > .trouble { color: $ana-low; text-style: bold; }
    """


class StatusApp(Program, inherit_bindings=False):
    """Follows a study until the experimenter leaves."""

    CSS_PATH: ClassVar[list[str | PurePath]] = [
        "../widgets/styles/base.tcss",
        "../widgets/styles/pages.tcss",
    ]
    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("q,Q,escape,ctrl+c,ctrl+q", "quit", id="status.leave"),
    ]

    def __init__(self, folder: Path) -> None:
        super().__init__()
        self._reader = StatusReader(folder)
        self._table = StatusTable()

    def compose(self) -> ComposeResult:
        with VerticalScroll():
            yield self._table
        yield KeyLine(("↑ ↓", "scroll"), ("Q", "leave"), id="keys")

    def on_mount(self) -> None:
        lead_out(lambda _: None, lambda status: self.exit(return_code=status))
        self._look()
        self.set_interval(EVERY_S, self._look)

    def on_resize(self, _event: events.Resize) -> None:
        self._look()

    def _look(self) -> None:
        try:
            rows = status_rows(self._reader.look(), max(40, self.size.width))
        except AnaError as error:
            self.failure = error
            self.exit(return_code=2)
        else:
            self._table.draw(rows)


def watch_status(folder: Path) -> int:
    """Follow the study in `folder` on this terminal; the exit status.

    Raises AnaError for what the experimenter can fix.
    """
    if not (sys.stdin.isatty() and sys.stdout.isatty()):
        raise AnaError("this is not a terminal", hint="Leave out --watch to print the status once.")
    StatusReader(folder).look()
    return StatusApp(folder).perform_or_report()
