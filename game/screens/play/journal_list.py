"""The missions that were played: a chart of what they came to, and a list to choose from."""

from __future__ import annotations

from collections.abc import Sequence
from datetime import datetime
from pathlib import Path
from typing import ClassVar, Literal

from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.screen import Screen

from game.places import shortened
from game.screens.play.past_missions import PastMission, past_mission, past_missions
from game.screens.widgets.aside import aside
from game.screens.widgets.canvas import BLANK, Row, Run, width, wrapped
from game.screens.widgets.charts import bars
from game.screens.widgets.keyline import KeyLine
from game.screens.widgets.pointing import ClickCanvas, Pointed, RowClicked

CHART_ROWS = 6
LEAST_LISTED = 8
"""So many rows the list keeps before there is a chart."""
Chosen = tuple[Literal["replay", "result"], Path]


def journal_text(path: Path) -> str:
    """What was played in a journal, by whom if simulated, and what it came to."""
    mission = past_mission(path)
    if isinstance(mission, str):
        return mission
    parts = [mission.building, mission.coach, f"{mission.rescued} rescued"]
    if mission.difficulty != "standard":
        parts.append(mission.difficulty)
    if mission.map_s:
        parts.append(f"map {mission.map_s} s")
    if not mission.ended:
        parts.append("left early")
    if mission.rescuer:
        parts.append(f"simulated {mission.rescuer}")
    return " · ".join(parts)


def history_rows(
    missions: Sequence[PastMission], selected: Path | None, columns: int, rows: int
) -> list[Row]:
    """A bar for the rescues of each mission that a person finished, the oldest first, as many as
    fit: the selected one stands out, and those of its kind are brighter than the others."""
    shown = sorted((it for it in missions if it.counts), key=lambda it: it.at)
    chosen = next((it for it in missions if it.journal == selected), None)
    highest = max((it.people for it in shown), default=1)

    def style(mission: PastMission) -> str:
        if mission.journal == selected:
            return "bar"
        return "area" if chosen is None or mission.kind == chosen.kind else "faint"

    values = [(mission.rescued, style(mission)) for mission in shown]
    return bars("Rescued, mission by mission", values, highest, columns=columns, rows=rows)


class JournalList(ClickCanvas):
    """Shows as many journals as fit, around the selected one, below a chart if there is room."""

    COMPONENT_CLASSES: ClassVar[set[str]] = {
        "item", "selected", "title", "quiet", "faint", "area", "bar",
    }  # fmt: skip

    def __init__(self) -> None:
        super().__init__()
        self._first_row = self._first = self._count = 0

    def journal_at(self, row: int) -> int | None:
        """The journal in a row of the list."""
        number = row - self._first_row + self._first
        return number if row >= self._first_row and number < self._count else None

    def show(
        self,
        folder: Path,
        journals: Sequence[Path],
        selected: int,
        missions: Sequence[PastMission],
    ) -> None:
        """Draw the list of a folder's journals."""
        rows: list[Row] = []
        counted = sum(mission.counts for mission in missions)
        if counted > 1 and self.size.height >= CHART_ROWS + LEAST_LISTED:
            chart = history_rows(missions, journals[selected], self.size.width - 2, CHART_ROWS - 2)
            rows += [*chart, BLANK]
        kept = f"kept in {shortened(folder)}"
        title: Row = (("  Your missions", "title"),)
        if width(title) + len(kept) + 3 <= self.size.width:
            rows += [(*title, (f"   {kept}", "quiet")), BLANK]
        else:
            rows += [
                title,
                *(((f"  {line}", "quiet"),) for line in wrapped(kept, self.size.width - 3)),
            ]
        high = max(1, self.size.height - len(rows) - 1)
        above = len(rows)
        first = max(0, min(selected - high // 2, len(journals) - high))
        for number, path in enumerate(journals[first : first + high], start=first):
            played = datetime.fromtimestamp(path.stat().st_mtime).astimezone()
            style = "selected" if number == selected else "item"
            text: Run = (f"  {played:%d %b %Y  %H:%M}  {journal_text(path)}  ", style)
            rows.append((text,))
        self._first_row, self._first, self._count = above, first, len(journals)
        if not journals:
            rows.append((("  There are no missions yet: play one first.", "quiet"),))
        self.draw(rows)


class JournalsScreen(Pointed, Screen[Chosen]):
    """Dismissed with what is to be seen of the journal chosen, or with None."""

    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("up,k,w", "move(-1)", id="journals.up"),
        Binding("down,j,s", "move(1)", id="journals.down"),
        Binding("pageup", "move(-10)", id="journals.page_up"),
        Binding("pagedown", "move(10)", id="journals.page_down"),
        Binding("enter,space", "choose('replay')", id="journals.choose"),
        Binding("r,R", "choose('result')", id="journals.result"),
        Binding("escape,q,Q,ctrl+q,ctrl+c", "dismiss", id="journals.back"),
    ]

    def __init__(self, folder: Path, journals: Sequence[Path]) -> None:
        super().__init__()
        self._folder = folder
        self._journals = journals
        self._selected = 0
        self._missions: tuple[PastMission, ...] = ()
        self._list = JournalList()

    def compose(self) -> ComposeResult:
        yield self._list
        yield KeyLine(
            ("↑ ↓", "choose"), ("Enter", "replay"), ("R", "result page"), ("Esc", "back"),
            id="keys",
        )  # fmt: skip

    def on_mount(self) -> None:
        aside(self, lambda: past_missions(self._journals), self._have_read)

    def _have_read(self, missions: tuple[PastMission, ...]) -> None:
        self._missions = missions
        self._show()

    def on_resize(self) -> None:
        self.call_after_refresh(self._show)

    def _show(self) -> None:
        self._list.show(self._folder, self._journals, self._selected, self._missions)

    def on_row_clicked(self, message: RowClicked) -> None:
        number = self._list.journal_at(message.row)
        if number is not None and number == self._selected:
            self.action_choose("replay")
        elif number is not None:
            self._selected = number
            self._show()

    def action_move(self, way: int) -> None:
        count = len(self._journals)
        if not count:
            return
        to = self._selected + way
        self._selected = to % count if abs(way) == 1 else max(0, min(to, count - 1))
        self._show()

    def action_choose(self, what: Literal["replay", "result"]) -> None:
        if self._journals:
            self.dismiss((what, self._journals[self._selected]))
