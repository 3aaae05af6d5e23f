"""Withdrawal: all that was recorded of a participant is deleted; the ledger keeps a tombstone."""

from __future__ import annotations

import shutil

from game.journal.sink import sync_folder
from game.study.folder import Identity, Study, StudyError
from game.study.lock import SessionLock


def withdraw(study: Study, identity: Identity) -> bool:
    """Let a participant withdraw; whether anything had been recorded.

    The tombstone is on the disk before anything is deleted, so a withdrawal that was cut off can
    be repeated. Raises SessionBusy while the participant takes part, StudyError where the files
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
                mend="Delete the folder by hand; the withdrawal itself is recorded",
            ) from error
        sync_folder(home.parent)
        return recorded
    finally:
        if lock is not None:
            lock.release()
