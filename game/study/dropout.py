"""Drop-outs: who was allocated and does not come back. What they did is kept."""

from __future__ import annotations

from game.study.folder import Identity, Study, StudyError
from game.study.ledger import ending_of, slot_of
from game.study.lock import SessionLock


def drop_out(study: Study, identity: Identity) -> None:
    """Record that a participant dropped out; the study's settings say what becomes of the place.

    Who comes back before it is given out again may go on. Raises StudyError for somebody who holds
    no place, or whose session has ended, and SessionBusy while they take part.
    """
    participant, mode = identity.participant, identity.mode
    entries = study.ledger.entries()
    if slot_of(entries, participant, mode) is None:
        raise StudyError(f"{participant} holds no place", place=str(study.folder))
    ending = ending_of(entries, participant, mode)
    if ending is not None and ending != "dropped":
        raise StudyError(f"{participant} has {ending} already", place=str(study.folder))
    lock = SessionLock(study.home(identity))
    try:
        study.ledger.end_session(participant, mode, "dropped")
    finally:
        lock.release()
