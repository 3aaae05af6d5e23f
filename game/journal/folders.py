"""The journals of a study folder, whoever asks for them."""

from __future__ import annotations

from pathlib import Path

from game.journal.reader import Transcript, read_file, read_journal
from game.journal.records import Mode

JOURNAL = "journal.jsonl"
SESSIONS = "sessions"


def journals(study: Path, mode: Mode) -> tuple[Path, ...]:
    """The journals of all sessions of a mode, in the order of their participants.

    A journal in which not one line was finished is none: its session never began.
    """
    found = sorted((study / SESSIONS / mode).glob(f"*/{JOURNAL}"))
    return tuple(path for path in found if b"\n" in read_file(path))


def transcripts(study: Path, mode: Mode) -> tuple[Transcript, ...]:
    """All sessions of a mode, in the order of their participants.

    Raises JournalError, naming the file, where one cannot be read.
    """
    return tuple(read_journal(path) for path in journals(study, mode))
