"""Leaving a study. A drop-out's data are kept; withdrawal deletes everything that was recorded."""

from __future__ import annotations

import shutil
from typing import NamedTuple

from game.errors import did_you_mean
from game.journal.folders import JOURNAL, folders_of, has_journal
from game.journal.history import read_history
from game.journal.journal_error import JournalError
from game.journal.reader import read_journal
from game.journal.records import StudyMode
from game.journal.sink import sync_folder
from game.study.folder import Identity, Study, StudyError
from game.study.ledger import ending_of, slot_of
from game.study.lock import SessionLock


def drop_out(study: Study, identity: Identity) -> None:
    """Record that a participant dropped out; the study's settings decide what happens to the place.

    Participants who come back before it is given to someone else can continue. Raises StudyError
    if they have no place or their session has ended, and SessionBusy while they take part.
    """
    participant, mode = identity.participant, identity.mode
    entries = study.ledger.entries()
    if slot_of(entries, participant, mode) is None:
        raise StudyError(f"{participant} has no place in this study", place=str(study.folder))
    ending = ending_of(entries, participant, mode)
    if ending is not None and ending != "dropped":
        raise StudyError(
            f"the session of {participant} has already ended ({ending.replace('_', ' ')})",
            place=str(study.folder),
        )
    lock = SessionLock(study.home(identity))
    try:
        study.ledger.end_session(participant, mode, "dropped")
    finally:
        lock.release()


class Recorded(NamedTuple):
    """What is known about a participant before they withdraw."""

    since_utc: str = ""
    phase: str = ""
    round: int = 0
    records: int = 0
    trouble: str = ""
    """Why it cannot be told how far they are."""

    def told(self) -> str:
        """In words: how far they are, and since when."""
        if self.trouble:
            return f"how far they are cannot be told: {self.trouble}"
        if not self.records:
            return "nothing has been recorded"
        far = f"{self.phase}, round {self.round}" if self.round else self.phase
        return f"{self.records} records since {self.since_utc}; last phase: {far}"


def recorded(study: Study, identity: Identity) -> Recorded:
    """What is there of a participant, also where it cannot be read. Raises StudyError where the
    study never heard of them."""
    home, entries = study.home(identity), study.ledger.entries()
    mode, participant = identity
    known = slot_of(entries, participant, mode) or ending_of(entries, participant, mode)
    if not known and home not in folders_of(study.folder, mode):
        raise StudyError(
            f"there is no participant {participant} among the {mode} ones of this study",
            place=str(study.folder),
            hint=_in_another_mode(study, identity)
            or did_you_mean(participant, [one.name for one in folders_of(study.folder, mode)])
            or "`ana study status` lists who there is",
        )
    try:
        if not has_journal(home):
            return Recorded()
        transcript = read_journal(home / JOURNAL)
    except JournalError as error:
        return Recorded(trouble=str(error))
    history = read_history(transcript)
    return Recorded(
        history.started_utc, history.step.phase, history.step.round, len(transcript.entries)
    )


def _in_another_mode(study: Study, identity: Identity) -> str:
    """The hint where the ID is that of a pilot or of a live participant, and the other was meant;
    else empty."""
    participant = identity.participant
    for mode, hint in _OTHER_MODES.items():
        if mode != identity.mode and study.home(Identity(mode, participant)).is_dir():
            return f"{participant} is {hint}"
    return ""


_OTHER_MODES: dict[StudyMode, str] = {
    "pilot": "a pilot: add --pilot",
    "live": "a live participant: leave --pilot out",
    "simulated": "a simulated person",
}


def withdraw(study: Study, identity: Identity) -> bool:
    """Withdraw a participant; returns whether anything had been recorded.

    The tombstone is on the disk before anything is deleted, so an interrupted withdrawal can be
    repeated. Raises SessionBusy while the participant takes part, and StudyError if the files
    cannot be deleted.
    """
    home = study.home(identity)
    lock = SessionLock(home) if home in folders_of(study.folder, identity.mode) else None
    try:
        study.ledger.end_session(identity.participant, identity.mode, "withdrawn")
        if lock is None:
            return False
        recorded = any(path != lock.path for path in home.iterdir())
        try:
            shutil.rmtree(home)
        except OSError as error:
            raise StudyError(
                f"not everything could be deleted ({error.strerror})",
                place=str(home),
                hint="Delete the folder by hand; the withdrawal is recorded",
            ) from error
        sync_folder(home.parent)
        return recorded
    finally:
        if lock is not None:
            lock.release()
