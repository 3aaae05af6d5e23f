"""The state of a study: sessions, totals and problems, and what may be told only unblinded.

While a study recruits, nothing here tells how anybody was allocated (design 7): counts by design
cell and reasons for exclusion are made by `breakdown` alone, which leaves its trace in the ledger.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from pathlib import Path

import msgspec

from game.journal.folders import transcripts
from game.study.design import BLOCK
from game.study.folder import LEDGER, SETTINGS
from game.study.ledger import (
    Ledger,
    LedgerEntry,
    SessionEnded,
    SlotTaken,
    StudyCreated,
    Unblinded,
    ending_of,
    is_closed,
)
from game.study.roll import Roll, SessionStatus
from game.study.study_settings import StudySettings, read_settings
from game.tables.rows import ParticipantRow
from game.tables.session_tables import combined, session_tables


class Totals(msgspec.Struct, frozen=True, kw_only=True):
    """Counts over the live sessions. `places` are all slots of the study, `taken` those given
    out; `turned_away` found none left, `dropped` came to be marked so in the ledger."""

    places: int
    taken: int
    started: int
    taking_part: int
    left: int
    cut_off: int
    finished: int
    declined: int
    turned_away: int
    withdrawn: int
    dropped: int


class StudyStatus(msgspec.Struct, frozen=True, kw_only=True):
    """A study at one moment."""

    study: str
    closed: bool
    unblinded: int
    totals: Totals
    sessions: tuple[SessionStatus, ...]
    problems: tuple[str, ...]


class ExclusionRule(msgspec.Struct, frozen=True):
    """Leaves out who has more than `more_than` in `column` of the participants table."""

    name: str
    words: str
    column: str
    more_than: int


class CellCount(msgspec.Struct, frozen=True, kw_only=True):
    """One design cell: how many were allocated to it and finished, and by each exclusion rule how
    many of those allocated are left out."""

    cell: str
    allocated: int
    finished: int
    excluded: dict[str, int]


class StatusReader:
    """Looks at a study again and again, each time at what is new. Reads only."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self._roll = Roll(folder)

    def look(self) -> StudyStatus:
        """The study now. Raises SettingsError or LedgerError for a folder that is no study."""
        settings, _ = read_settings(self.folder / SETTINGS)
        entries = Ledger(self.folder / LEDGER).entries()
        sessions = tuple(self._roll.look(settings))
        return StudyStatus(
            study=settings.name,
            closed=is_closed(entries),
            unblinded=sum(isinstance(entry, Unblinded) for entry in entries),
            totals=_totals(settings, entries, sessions),
            sessions=sessions,
            problems=tuple(
                f"{session.participant} ({session.mode}): {problem}"
                for session in sessions
                for problem in session.problems
            ),
        )


def breakdown(folder: Path, rules: Sequence[ExclusionRule], why: str) -> tuple[CellCount, ...]:
    """Counts of live participants by design cell, with reasons for exclusion.

    Unless the study is closed, the ledger records that they were looked at, and `why`, before
    anything is told. Raises LedgerError or JournalError.
    """
    ledger = Ledger(folder / LEDGER)
    entries = ledger.entries()
    if not is_closed(entries):
        ledger.unblind(why)
    taken = {
        entry.participant: entry
        for entry in entries
        if isinstance(entry, SlotTaken) and entry.mode == "live"
    }
    people = combined(map(session_tables, transcripts(folder, "live"))).participants
    counts = []
    for code in sorted({entry.cell.code for entry in taken.values()}):
        here = [
            row
            for row in people
            if row.participant in taken and taken[row.participant].cell.code == code
        ]
        counts.append(
            CellCount(
                cell=code,
                allocated=sum(entry.cell.code == code for entry in taken.values()),
                finished=sum(row.session_ending == "finished" for row in here),
                excluded={rule.name: sum(_breaks(row, rule) for row in here) for rule in rules},
            )
        )
    return tuple(counts)


def _breaks(row: ParticipantRow, rule: ExclusionRule) -> bool:
    count = getattr(row, rule.column)
    return count is not None and bool(count > rule.more_than)


def _totals(
    settings: StudySettings, entries: Sequence[LedgerEntry], sessions: Sequence[SessionStatus]
) -> Totals:
    states = Counter(session.state for session in sessions if session.mode == "live")
    people = {
        entry.participant
        for entry in entries
        if isinstance(entry, SessionEnded) and entry.mode == "live"
    }
    ended = Counter(ending_of(entries, person, "live") for person in people)
    created = [entry.blocks for entry in entries if isinstance(entry, StudyCreated)]
    slots = {
        entry.slot for entry in entries if isinstance(entry, SlotTaken) and entry.mode == "live"
    }
    blocks = created[0] if created else settings.blocks
    return Totals(
        places=blocks * BLOCK,
        taken=len(slots),
        started=sum(states.values()) + ended["withdrawn"],
        taking_part=states["taking part"],
        left=states["left"],
        cut_off=states["cut off"],
        finished=states["finished"],
        declined=states["declined"],
        turned_away=states["turned away"],
        withdrawn=ended["withdrawn"],
        dropped=ended["dropped"],
    )
