"""The sessions of a study that its ledger knows: what export and status count."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from pathlib import Path

from game.journal.folders import PUT_BACK, SESSIONS, journals, transcripts
from game.journal.journal_error import JournalError
from game.journal.reader import Transcript
from game.journal.records import Allocated, StudyMode
from game.study.folder import LEDGER
from game.study.ledger import Ledger, LedgerEntry, SlotTaken, ending_of, slot_of


def sessions_of(
    folder: Path, mode: StudyMode, entries: Sequence[LedgerEntry], without: Collection[str] = ()
) -> list[Transcript]:
    """The sessions of a mode but for withdrawn ones and those in the folders `without`.

    Raises JournalError, naming the file, for one that cannot be read, lies in the wrong place or
    has a place that the ledger does not know, and for a place whose session is gone.
    """
    found = []
    for transcript in transcripts(folder, mode, without):
        participant = transcript.started.participant
        if ending_of(entries, participant, mode) == "withdrawn":
            continue
        if wrong := without_a_place(transcript, entries, mode):
            raise JournalError(wrong, place=transcript.source, hint=PUT_BACK)
        found.append(transcript)
    _refuse_lost(folder, mode, entries, {it.started.participant for it in found} | set(without))
    return found


def refuse_unlike_ledger(folder: Path, mode: StudyMode) -> None:
    """Compare the folders of a mode's sessions with the study's ledger; nobody opens a journal.

    Raises JournalError for a place whose session is gone, and for a session whose participant has
    withdrawn. What is no study of ours has no ledger, and passes.
    """
    ledger = Ledger(folder / LEDGER)
    if not ledger.path.exists():
        return
    entries = ledger.entries()
    there = {path.parent.name for path in journals(folder, mode)}
    _refuse_lost(folder, mode, entries, there)
    for name in sorted(there):
        if ending_of(entries, name, mode) == "withdrawn":
            raise JournalError(
                f"{name} ({mode}) has withdrawn, and what was recorded is still there",
                place=str(folder / SESSIONS / mode / name),
                hint=f"Delete it: ana study withdraw {folder} {name}",
            )


def _refuse_lost(
    folder: Path, mode: StudyMode, entries: Sequence[LedgerEntry], there: Collection[str]
) -> None:
    for lost in places_without_a_session(entries, mode, there):
        raise JournalError(lost, place=str(folder / SESSIONS / mode), hint=_LOST)


def places_without_a_session(
    entries: Sequence[LedgerEntry], mode: StudyMode, there: Collection[str]
) -> Iterator[str]:
    """Who has a place but is not among those whose session is `there`, and has not withdrawn."""
    for entry in entries:
        if (
            isinstance(entry, SlotTaken)
            and entry.mode == mode
            and entry.participant not in there
            and ending_of(entries, entry.participant, mode) != "withdrawn"
        ):
            yield f"{entry.participant} ({mode}) has place {entry.slot}, but no session"


_LOST = (
    "Bring the session's folder back from a backup, or export the study without it "
    "(ana study export --without ID) and use the dataset"
)


def without_a_place(transcript: Transcript, entries: Sequence[LedgerEntry], mode: StudyMode) -> str:
    """Why the place in a session's journal is not one of this study's; empty if it is."""
    taken = [entry.record for entry in transcript.entries if isinstance(entry.record, Allocated)]
    held = slot_of(entries, transcript.started.participant, mode)
    if taken and (held is None or held.slot != taken[-1].slot):
        known = "none" if held is None else str(held.slot)
        return (
            f"this session has place {taken[-1].slot}, but the ledger gave its participant {known}"
        )
    return ""
