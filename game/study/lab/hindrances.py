"""What keeps people from logging in, or makes the data of a study doubtful."""

from __future__ import annotations

import shutil
from collections.abc import Callable, Iterator, Sequence
from functools import partial
from pathlib import Path

from game.errors import AnaError
from game.journal.folders import JOURNAL, folders_of, has_journal, misplaced
from game.journal.reader import read_journal
from game.journal.records import STUDY_MODES, StudyMode
from game.study.donors import without_donor
from game.study.folder import ROSTER, Study, open_study, roster_of
from game.study.lab.sessions import places_without_a_session, without_a_place
from game.study.ledger import (
    LedgerEntry,
    SlotTaken,
    agreed_inputs,
    differing,
)


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
        yield from _room(study)
        yield from _yoked(study)
    yield from _roster(folder)
    for mode in STUDY_MODES:
        yield from _sessions(folder, mode, entries, cached)


def _room(study: Study) -> Iterator[str]:
    free_mb = shutil.disk_usage(study.folder).free // 1_000_000
    least_mb = study.settings.least_free_mb
    if free_mb < least_mb:
        yield (
            f"the disk is nearly full: {free_mb} MB are left, and there should be {least_mb} "
            "(least_free_mb in study.toml)"
        )


def _yoked(study: Study) -> Iterator[str]:
    """Where the first participants would have nobody's levels to repeat. Pilots alone are asked:
    what live sessions have done is nobody's business while the study is open."""
    other = study.settings.yoked_to
    lacking = () if other is None else without_donor(study.folder, study.buildings, other)
    if lacking and other is not None:
        yield (
            f"no pilot has finished a mission with {other.kind} in {' or '.join(lacking)}: who is "
            "led by yoked there before anybody else has finished one is told C2 throughout. Run "
            "another pilot"
        )


def _roster(folder: Path) -> Iterator[str]:
    try:
        roster = roster_of(folder)
    except AnaError as error:
        yield f"nobody can log in: {error}"
    else:
        if roster == ():
            yield f"nobody can log in: {folder / ROSTER} has no ID in it. Fill it, or remove it"


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
        found = folders_of(folder, mode)
    except AnaError as error:
        yield str(error)
        return
    begun: set[str] = set()
    for home in found:
        path = home / JOURNAL
        try:
            there = has_journal(home) and path.stat().st_size > 0
        except AnaError as error:
            begun.add(home.name)
            yield str(error)
            continue
        if there:
            begun.add(home.name)
            wrong = cached(path, partial(_session, folder, mode, path, entries))
            if wrong:
                yield wrong
    alike: dict[str, str] = {}
    for name in sorted(home.name for home in found):
        other = alike.setdefault(name.casefold(), name)
        if other != name:
            yield f"{other} and {name} ({mode}) differ in case alone: is it the same person?"
    yield from places_without_a_session(entries, mode, begun)


def _session(folder: Path, mode: StudyMode, path: Path, entries: Sequence[LedgerEntry]) -> str:
    try:
        transcript = read_journal(path)
    except AnaError as error:
        return str(error)
    wrong = misplaced(transcript.started, folder, mode, path.parent.name)
    wrong = wrong or without_a_place(transcript, entries, mode)
    return f"{path}: {wrong}" if wrong else ""


def not_come(folder: Path, entries: Sequence[LedgerEntry]) -> tuple[str, ...]:
    """Who is on the roster and has not begun; nobody where there is no roster, or what is there
    cannot be read."""
    try:
        roster = roster_of(folder)
        there = {home.name for home in folders_of(folder, "live")}
    except AnaError:
        return ()
    left = {it.participant for it in entries if isinstance(it, SlotTaken) and it.mode == "live"}
    return tuple(name for name in roster or () if name not in there | left)
