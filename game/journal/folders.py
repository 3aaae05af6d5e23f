"""Finding and reading the journals in a study folder: the one list that everybody walks.

A session lies in `sessions/MODE/PARTICIPANT/journal.jsonl`. Whatever cannot be read, or lies where
it does not belong, is refused by name: nobody is left out silently, and nobody counts twice.
"""

from __future__ import annotations

import tomllib
from collections.abc import Collection
from pathlib import Path

from game.errors import disk_hint
from game.journal.journal_error import JournalError
from game.journal.reader import Transcript, read_file, read_journal
from game.journal.records import STUDY_MODES, Mode, SessionStarted

JOURNAL = "journal.jsonl"
MOST_MISSIONS = 200
"""So many journals of free play are looked at, the newest first."""
SESSIONS = "sessions"


def folders_of(study: Path, mode: Mode) -> tuple[Path, ...]:
    """The folders of all sessions of a mode, ordered by participant; nobody looks into them.

    Raises JournalError where the mode's own folder cannot be read.
    """
    folder = study / SESSIONS / mode
    try:
        return tuple(sorted(path for path in folder.iterdir() if path.is_dir()))
    except (FileNotFoundError, NotADirectoryError):
        return ()
    except OSError as error:
        raise _unreadable(folder, error) from error


def homes(study: Path, mode: Mode, without: Collection[str] = ()) -> tuple[Path, ...]:
    """The folders of all sessions of a mode, ordered by participant, but for those `without`.

    Raises JournalError, naming the folder, where one cannot be read.
    """
    found = tuple(home for home in folders_of(study, mode) if home.name not in without)
    for home in found:
        has_journal(home)
    return found


def has_journal(home: Path) -> bool:
    """Whether there is a journal in a session's folder. Raises JournalError, naming the folder,
    where it cannot be read."""
    try:
        next(home.iterdir(), None)
        return (home / JOURNAL).is_file()
    except FileNotFoundError:
        return False
    except OSError as error:
        raise _unreadable(home, error) from error


def journals(study: Path, mode: Mode, without: Collection[str] = ()) -> tuple[Path, ...]:
    """The journals of all sessions of a mode, ordered by participant, but for those in the folders
    `without`.

    A file without one complete line is left out: its session never began. Raises JournalError,
    naming the folder or file, for what cannot be read.
    """
    found = (home / JOURNAL for home in homes(study, mode, without))
    return tuple(path for path in found if path.is_file() and b"\n" in read_file(path))


def transcripts(study: Path, mode: Mode, without: Collection[str] = ()) -> tuple[Transcript, ...]:
    """All sessions of a mode, ordered by participant, but for those in the folders `without`.

    Raises JournalError, naming the file, for one that cannot be read or does not belong there.
    """
    found = []
    for path in journals(study, mode, without):
        transcript = read_journal(path)
        wrong = misplaced(transcript.started, study, mode, path.parent.name)
        if wrong:
            raise JournalError(wrong, place=str(path), hint=PUT_BACK)
        found.append(transcript)
    return tuple(found)


PUT_BACK = "Put it where it was recorded, or leave it out with --without"


def misplaced(started: SessionStarted, study: Path, mode: Mode, home: str) -> str:
    """Why a session does not belong into the folder `home` of a study's mode; empty if it does."""
    if started.mode != mode or started.simulated is not (mode == "simulated"):
        kind = "simulated" if started.simulated else "real"
        return f"this is a {kind} session of mode {started.mode} among the {mode} ones"
    if started.participant != home:
        return f"this is the journal of participant {started.participant}, in the folder of {home}"
    here, there = _seed_of(study), None if started.study is None else _seed(started.study.text)
    if None not in (here, there) and here != there:
        return f"this session is of another study: its seed is {there}, here it is {here}"
    return ""


def newest_journals(folder: Path) -> tuple[Path, ...]:
    """The journals of free play in `folder`, the newest first."""
    found = {path: path.stat().st_mtime for path in folder.glob(f"*/{JOURNAL}")}
    return tuple(sorted(found, key=lambda path: -found[path]))[:MOST_MISSIONS]


def all_journals(folder: Path) -> tuple[Path, ...]:
    """Every journal under a folder: of a study with all its modes, or of a single session.

    Raises JournalError for what cannot be read or lies in the wrong place, and where there is none.
    """
    if (folder / JOURNAL).is_file():
        return (folder / JOURNAL,)
    found = [
        Path(transcript.source) for mode in STUDY_MODES for transcript in transcripts(folder, mode)
    ]
    if not found:
        raise JournalError(
            "there is no journal in this folder",
            place=str(folder),
            hint="Give a journal, the folder of a session, or a study folder",
        )
    return tuple(found)


def _seed_of(study: Path) -> int | None:
    """The seed of the study in a folder; None where its settings cannot be read."""
    try:
        return _seed((study / "study.toml").read_text(encoding="utf-8-sig"))
    except (OSError, UnicodeDecodeError):
        return None


def _seed(settings: str) -> int | None:
    try:
        seed = tomllib.loads(settings).get("seed")
    except tomllib.TOMLDecodeError:
        return None
    return seed if isinstance(seed, int) else None


def _unreadable(path: Path, error: OSError) -> JournalError:
    return JournalError(
        f"the folder cannot be read ({error.strerror})", place=str(path), hint=disk_hint(error)
    )
