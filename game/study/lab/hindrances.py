"""What keeps people from logging in, or makes the data of a study doubtful."""

from __future__ import annotations

import shutil
from collections.abc import Callable, Iterator, Sequence
from functools import partial
from pathlib import Path

from game.errors import AnaError
from game.journal.folders import JOURNAL, homes, misplaced
from game.journal.reader import read_journal
from game.journal.records import STUDY_MODES, StudyMode
from game.study.folder import Study, open_study, roster_of
from game.study.lab.sessions import without_a_place
from game.study.ledger import (
    LedgerEntry,
    SlotTaken,
    agreed_inputs,
    differing,
    ending_of,
)

LEAST_FREE_BYTES = 1_000_000_000
"""A disk with less room is nearly full: a session takes 2 MB, and the system needs the rest."""


class Hindrances:
    """Looks again and again; a journal that has not changed is not read again."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._journals: dict[Path, tuple[tuple[int, int], str]] = {}

    def look(self, entries: Sequence[LedgerEntry]) -> tuple[str, ...]:
        """Everything that is wrong with the study as a whole, most urgent first."""
        return tuple(_all(self._folder, entries, self._journal))

    def _journal(self, path: Path, check: Callable[[], str]) -> str:
        stat = path.stat()
        signature = stat.st_mtime_ns, stat.st_size
        known = self._journals.get(path)
        if known is None or known[0] != signature:
            known = self._journals[path] = signature, check()
        return known[1]


_Cached = Callable[[Path, Callable[[], str]], str]


def _all(folder: Path, entries: Sequence[LedgerEntry], cached: _Cached) -> Iterator[str]:
    try:
        study = open_study(folder)
    except AnaError as error:
        yield f"nobody can log in: {error}"
    else:
        yield from _unrecorded(study, entries)
    free = shutil.disk_usage(folder).free
    if free < LEAST_FREE_BYTES:
        yield f"the disk is nearly full: {free // 1_000_000} MB are left"
    for mode in STUDY_MODES:
        yield from _sessions(folder, mode, entries, cached)


def _unrecorded(study: Study, entries: Sequence[LedgerEntry]) -> Iterator[str]:
    changed = differing(agreed_inputs(entries), study.inputs)
    if changed and any(isinstance(it, SlotTaken) and it.mode == "live" for it in entries):
        yield (
            f"nobody can log in: {', '.join(changed)} changed after the first participant was "
            "allocated. Undo the change, or record it with ana study amend"
        )


def _sessions(
    folder: Path, mode: StudyMode, entries: Sequence[LedgerEntry], cached: _Cached
) -> Iterator[str]:
    try:
        found = homes(folder, mode)
    except AnaError as error:
        yield str(error)
        return
    for home in found:
        path = home / JOURNAL
        if path.is_file() and path.stat().st_size:
            wrong = cached(path, partial(_session, folder, mode, path, entries))
            if wrong:
                yield wrong
    names = {home.name for home in found}
    alike: dict[str, str] = {}
    for name in sorted(names):
        other = alike.setdefault(name.casefold(), name)
        if other != name:
            yield f"{other} and {name} ({mode}) differ in case alone: is it the same person?"
    for entry in entries:
        if (
            isinstance(entry, SlotTaken)
            and entry.mode == mode
            and entry.participant not in names
            and ending_of(entries, entry.participant, mode) != "withdrawn"
        ):
            yield f"{entry.participant} ({mode}) has place {entry.slot}, but no session"


def _session(folder: Path, mode: StudyMode, path: Path, entries: Sequence[LedgerEntry]) -> str:
    try:
        transcript = read_journal(path)
    except AnaError as error:
        return str(error)
    wrong = misplaced(transcript.started, folder, mode, path.parent.name)
    wrong = wrong or without_a_place(transcript, entries, mode)
    return f"{path}: {wrong}" if wrong else ""


def not_come(folder: Path, entries: Sequence[LedgerEntry]) -> tuple[str, ...]:
    """Who is on the roster and has not begun; nobody where there is no roster."""
    roster = roster_of(folder)
    there = {home.name for home in homes(folder, "live")}
    left = {it.participant for it in entries if isinstance(it, SlotTaken) and it.mode == "live"}
    return tuple(name for name in roster or () if name not in there | left)
