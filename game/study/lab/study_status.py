"""The state of a study: sessions, totals and problems, and counts that unblind it.

While a study recruits, only `breakdown` reveals anything about the allocation: it gives counts by
design cell and reasons for exclusion, and the ledger records that it was called (docs/lab.md).
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from pathlib import Path

import msgspec

from game.forms.reading import BLANK, read_forms
from game.study.folder import LEDGER, SETTINGS, kept_copy
from game.study.lab.attendance import Attendance, SessionStatus
from game.study.lab.hindrances import Hindrances, not_come
from game.study.lab.sessions import sessions_of
from game.study.ledger import (
    Ledger,
    LedgerEntry,
    SessionOutcome,
    SlotTaken,
    Unblinded,
    agreed_inputs,
    ending_of,
    is_closed,
)
from game.study.study_settings import SettingsError, StudySettings, read_settings
from game.tables.exclusions import ExclusionRule
from game.tables.session_tables import combined, row_types, tables_of


class Totals(msgspec.Struct, frozen=True, kw_only=True):
    """Counts of live sessions. `places` are all slots of the study, `taken` those given out;
    `turned_away` found no place left, `dropped` are marked so in the ledger."""

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
    """A study at one moment. `hindrances` are wrong with the study as a whole, `problems` with
    single sessions; `not_come` are those on the roster who have not begun."""

    study: str
    closed: bool
    unblinded: int
    totals: Totals
    sessions: tuple[SessionStatus, ...]
    hindrances: tuple[str, ...]
    problems: tuple[str, ...]
    not_come: tuple[str, ...] = ()


class CellCount(msgspec.Struct, frozen=True, kw_only=True):
    """One design cell: how many were allocated to it, how many of them finished, and how many each
    exclusion rule excludes."""

    cell: str
    allocated: int
    finished: int
    excluded: dict[str, int]


class StatusReader:
    """Looks at a study repeatedly, reading only what is new. Writes nothing."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self._attendance = Attendance(folder)
        self._hindrances = Hindrances(folder)

    def look(self) -> StudyStatus:
        """The study now. Raises SettingsError or LedgerError if the folder is not a study."""
        entries = Ledger(self.folder / LEDGER).entries()
        settings = _settings(self.folder, entries)
        sessions = tuple(self._attendance.look(settings))
        return StudyStatus(
            study=settings.name,
            closed=is_closed(entries),
            unblinded=sum(isinstance(entry, Unblinded) for entry in entries),
            totals=_totals(settings, entries, sessions),
            sessions=sessions,
            hindrances=self._hindrances.look(entries),
            not_come=not_come(self.folder, entries),
            problems=tuple(
                f"{session.participant} ({session.mode}): {problem}"
                for session in sessions
                for problem in session.problems
            ),
        )


def _settings(folder: Path, entries: Sequence[LedgerEntry]) -> StudySettings:
    """The settings; where they cannot be used, those that were last agreed on, if there is a copy:
    an error in a file must not hide where everyone is."""
    try:
        return read_settings(folder / SETTINGS)[0]
    except SettingsError:
        agreed = kept_copy(folder, SETTINGS, agreed_inputs(entries).get(SETTINGS, ""))
        if not agreed.is_file():
            raise
        return read_settings(agreed)[0]


def breakdown(folder: Path, rules: Sequence[ExclusionRule], why: str) -> tuple[CellCount, ...]:
    """Counts of live participants by design cell, with reasons for exclusion.

    Unless the study is closed, the ledger first records that it was unblinded, and `why`. Raises
    LedgerError or JournalError.
    """
    ledger = Ledger(folder / LEDGER)
    entries = ledger.entries()
    ledger.unblind(why)
    taken = {
        entry.participant: entry
        for entry in entries
        if isinstance(entry, SlotTaken) and entry.mode == "live"
    }
    forms = read_forms(folder, BLANK).forms
    rules = [it for it in rules if it.column in row_types(forms)["participants"].__struct_fields__]
    people = combined(tables_of(sessions_of(folder, "live", entries), forms)).participants
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
                excluded={
                    rule.name: sum(rule.excludes(getattr(row, rule.column)) for row in here)
                    for rule in rules
                },
            )
        )
    return tuple(counts)


def _totals(
    settings: StudySettings, entries: Sequence[LedgerEntry], sessions: Sequence[SessionStatus]
) -> Totals:
    states = Counter(session.state for session in sessions if session.mode == "live")
    people = {
        entry.participant
        for entry in entries
        if isinstance(entry, SessionOutcome) and entry.mode == "live"
    }
    ended = Counter(ending_of(entries, person, "live") for person in people)
    slots = {
        entry.slot for entry in entries if isinstance(entry, SlotTaken) and entry.mode == "live"
    }
    return Totals(
        places=settings.all_places,
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
