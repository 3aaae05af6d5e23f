"""Leaving a study. A drop-out's data are kept; withdrawal deletes everything that was recorded."""

from __future__ import annotations

import shutil

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


def withdraw(study: Study, identity: Identity) -> bool:
    """Withdraw a participant; returns whether anything had been recorded.

    The tombstone is on the disk before anything is deleted, so an interrupted withdrawal can be
    repeated. Raises SessionBusy while the participant takes part, and StudyError if the files
    cannot be deleted.
    """
    home = study.home(identity)
    lock = SessionLock(home) if home.exists() else None
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
