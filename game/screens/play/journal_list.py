"""Choosing a journal to replay: the newest first."""

from __future__ import annotations

from collections.abc import Sequence
from datetime import datetime
from functools import lru_cache
from pathlib import Path
from typing import ClassVar

from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.screen import Screen

from game.errors import AnaError
from game.journal.history import read_history
from game.journal.reader import read_journal
from game.screens.play.mission_story import coach_name
from game.screens.widgets.canvas import BLANK, Canvas, Row
from game.screens.widgets.keyline import KeyLine

LISTED = 200


@lru_cache(maxsize=LISTED)
def journal_text(path: Path) -> str:
    """What was played in a journal, by whom if simulated, and what it came to."""
    try:
        transcript = read_journal(path)
    except AnaError:
        return "cannot be read"
    played = read_history(transcript).missions
    if not played:
        return "no mission"
    first = played[0]
    if first.step.phase == "practice":
        return "tutorial"
    rescued = sum(fate == "rescued" for fate, _ in first.fates.values())
    parts = [first.started.building, coach_name(first.started.coach), f"{rescued} rescued"]
    if first.end == "abandoned":
        parts.append("left early")
    if transcript.started.simulated:
        parts.append(f"simulated {transcript.started.rescuer}")
    return " · ".join(parts)


class JournalList(Canvas):
    """Shows as many journals as fit, around the selected one."""

    COMPONENT_CLASSES: ClassVar[set[str]] = {"item", "selected", "title", "quiet"}

    def show(self, journals: Sequence[Path], selected: int) -> None:
        """Draw the list."""
        rows: list[Row] = [(("  Replay which mission?", "title"),), BLANK]
        high = max(1, self.size.height - 3)
        first = max(0, min(selected - high // 2, len(journals) - high))
        for number, path in enumerate(journals[first : first + high], start=first):
            played = datetime.fromtimestamp(path.stat().st_mtime).astimezone()
            style = "selected" if number == selected else "item"
            text = f"  {played:%d %b %Y  %H:%M}  {journal_text(path)}  "
            rows.append(((text, style),))
        if not journals:
            rows.append((("  There are no missions yet: play one first.", "quiet"),))
        self.draw(rows)


class JournalsScreen(Screen[Path]):
    """Dismissed with the journal chosen, or with None."""

    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("up,k", "move(-1)", id="journals.up"),
        Binding("down,j", "move(1)", id="journals.down"),
        Binding("enter,space", "choose", id="journals.choose"),
        Binding("escape,q,Q,ctrl+q,ctrl+c", "dismiss", id="journals.back"),
    ]

    def __init__(self, journals: Sequence[Path]) -> None:
        super().__init__()
        self._journals = journals
        self._selected = 0
        self._list = JournalList()

    def compose(self) -> ComposeResult:
        yield self._list
        yield KeyLine(("↑ ↓", "choose"), ("Enter", "replay"), ("Esc", "back"), id="keys")

    def on_resize(self) -> None:
        self.call_after_refresh(self._show)

    def _show(self) -> None:
        self._list.show(self._journals, self._selected)

    def action_move(self, way: int) -> None:
        if self._journals:
            self._selected = (self._selected + way) % len(self._journals)
            self._show()

    def action_choose(self) -> None:
        if self._journals:
            self.dismiss(self._journals[self._selected])
