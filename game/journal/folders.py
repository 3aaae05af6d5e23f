"""Finding and reading the journals in a study folder."""

from __future__ import annotations

from pathlib import Path

from game.journal.reader import Transcript, read_file, read_journal
from game.journal.records import Mode

JOURNAL = "journal.jsonl"
SESSIONS = "sessions"


def journals(study: Path, mode: Mode) -> tuple[Path, ...]:
    """The journals of all sessions of a mode, ordered by participant.

    A file without one complete line is left out: its session never began.
    """
    found = sorted((study / SESSIONS / mode).glob(f"*/{JOURNAL}"))
    return tuple(path for path in found if b"\n" in read_file(path))


def transcripts(study: Path, mode: Mode) -> tuple[Transcript, ...]:
    """All sessions of a mode, ordered by participant.

    Raises JournalError, naming the file, if one cannot be read.
    """
    return tuple(read_journal(path) for path in journals(study, mode))
