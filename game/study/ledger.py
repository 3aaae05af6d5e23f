"""The ledger of a study: who was allocated what, kept so that it can be audited from it alone.

JSON lines, append only, written under an exclusive `flock` and fsynced before the lock is given
up: whoever was told a slot finds it on the disk, and two who ask at once are told two slots. The
lock dies with its process, so a crash never leaves it held.
"""

from __future__ import annotations

import errno
import fcntl
import os
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from datetime import UTC, datetime
from pathlib import Path
from typing import Literal

import msgspec

from game.errors import AnaError
from game.study.design import BLOCK, DesignCell, design_cell

Mode = Literal["live", "pilot", "simulated"]
"""Each mode has an allocation sequence of its own."""

Ending = Literal["finished", "declined", "withdrawn", "dropped", "turned_away"]


class LedgerError(AnaError):
    """The ledger cannot be read or written, or does not allow what was asked."""


class NoPlace(LedgerError):
    """There is no place for this participant: the study is closed or full, or the place is gone.

    Its words are an experimenter's; participants read `Texts.no_place`.
    """


class Entry(msgspec.Struct, frozen=True, kw_only=True, tag_field="type"):
    """One line of the ledger."""

    utc: str


class StudyCreated(Entry, frozen=True, tag="study_created"):
    seed: int
    blocks: int
    settings_hash: str


class SlotTaken(Entry, frozen=True, tag="slot_taken"):
    """A participant was allocated. `refill` tells that the slot was a drop-out's before."""

    participant: str
    mode: Mode
    slot: int
    cell: DesignCell
    refill: bool = False


class SessionEnded(Entry, frozen=True, tag="session_ended"):
    """How a participant's session ended. One who withdrew leaves this and nothing else."""

    participant: str
    mode: Mode
    ending: Ending


class CameBack(Entry, frozen=True, tag="came_back"):
    """One marked as a drop-out takes part again, in the slot held before."""

    participant: str
    mode: Mode


class SettingsAmended(Entry, frozen=True, tag="settings_amended"):
    """study.toml was changed after the first session, knowingly."""

    settings_hash: str
    why: str


class Unblinded(Entry, frozen=True, tag="unblinded"):
    """Someone asked for counts by design cell while the study was open."""

    why: str


class StudyClosed(Entry, frozen=True, tag="study_closed"):
    """Recruiting is over: no live slot is taken any more, and nothing need be concealed."""


LedgerEntry = (
    StudyCreated | SlotTaken | SessionEnded | CameBack | SettingsAmended | Unblinded | StudyClosed
)

_decoder = msgspec.json.Decoder(LedgerEntry)


def utc_now() -> str:
    """The wall clock, as ledgers and journals write it."""
    return datetime.now(UTC).isoformat(timespec="milliseconds")


class Ledger:
    """The ledger in one file. `now` gives the time written into entries."""

    def __init__(self, path: Path, now: Callable[[], str] = utc_now) -> None:
        self.path = path
        self._now = now

    def create(self, seed: int, blocks: int, settings_hash: str) -> None:
        """Begin a ledger. Raises LedgerError where there is one already."""
        if self.path.exists():
            raise LedgerError(
                "there is a ledger already",
                place=str(self.path),
                mend="Choose a new folder for a new study",
            )
        with self._locked() as write:
            write(
                StudyCreated(utc=self._now(), seed=seed, blocks=blocks, settings_hash=settings_hash)
            )

    def entries(self) -> tuple[LedgerEntry, ...]:
        """All entries. A last line that was torn by a crash does not count."""
        try:
            data = self.path.read_bytes()
        except OSError as error:
            raise LedgerError(
                f"the ledger cannot be read ({error.strerror})", place=str(self.path)
            ) from error
        return tuple(self._decoded(data))

    def allocate(self, participant: str, mode: Mode, *, refill: bool = False) -> SlotTaken:
        """The participant's slot: the one held already, or the next free one of the mode.

        With `refill`, the slots of those who dropped out or withdrew are given out again first.
        Raises NoPlace when every live slot is taken, or the study is closed.
        """
        with self._locked() as write:
            entries = self.entries()
            held = slot_of(entries, participant, mode)
            if held is not None:
                return held
            slot, refilled = self._free_slot(entries, mode, refill)
            cell = design_cell(self._created(entries).seed, mode, slot)
            taken = SlotTaken(
                utc=self._now(),
                participant=participant,
                mode=mode,
                slot=slot,
                cell=cell,
                refill=refilled,
            )
            write(taken)
            return taken

    def see_place(self, participant: str, mode: Mode, *, refill: bool = False) -> None:
        """Raise NoPlace where `allocate` would. Nothing is written."""
        entries = self.entries()
        if slot_of(entries, participant, mode) is None:
            self._free_slot(entries, mode, refill)

    def end_session(self, participant: str, mode: Mode, ending: Ending) -> None:
        """Record how a session ended; the same ending twice is written once."""
        with self._locked() as write:
            if ending_of(self.entries(), participant, mode) != ending:
                write(
                    SessionEnded(utc=self._now(), participant=participant, mode=mode, ending=ending)
                )

    def come_back(self, participant: str, mode: Mode) -> None:
        """Let a drop-out take part again; of anybody else nothing is recorded.

        From then on the slot is not given out again. Raises NoPlace where it has been.
        """
        with self._locked() as write:
            entries = self.entries()
            if ending_of(entries, participant, mode) != "dropped":
                return
            slot = slot_of(entries, participant, mode)
            if slot is not None and _holders(entries, mode)[slot.slot] != participant:
                raise NoPlace(
                    f"the place of {participant} has gone to somebody else in the meantime",
                    place=str(self.path.parent),
                )
            write(CameBack(utc=self._now(), participant=participant, mode=mode))

    def agree(self, settings_hash: str) -> None:
        """Make sure that the study runs under the settings with this hash.

        Until the first live slot is taken they may change freely, which is recorded. Raises
        LedgerError when they changed afterwards without an amendment.
        """
        with self._locked() as write:
            entries = self.entries()
            if agreed_hash(entries) == settings_hash:
                return
            if any(isinstance(entry, SlotTaken) and entry.mode == "live" for entry in entries):
                raise LedgerError(
                    "study.toml was changed after the first participant was allocated",
                    place=str(self.path.parent),
                    mend="Put it back, or record the change: ana study amend DIR --why TEXT",
                )
            write(
                SettingsAmended(
                    utc=self._now(), settings_hash=settings_hash, why="before the first participant"
                )
            )

    def amend(self, settings_hash: str, why: str) -> None:
        with self._locked() as write:
            write(SettingsAmended(utc=self._now(), settings_hash=settings_hash, why=why))

    def unblind(self, why: str) -> None:
        with self._locked() as write:
            write(Unblinded(utc=self._now(), why=why))

    def close(self) -> None:
        """Close the study; closing it twice is written once."""
        with self._locked() as write:
            if not is_closed(self.entries()):
                write(StudyClosed(utc=self._now()))

    def _free_slot(
        self, entries: Sequence[LedgerEntry], mode: Mode, refill: bool
    ) -> tuple[int, bool]:
        """The next slot of a mode, and whether it was somebody's before. Raises NoPlace."""
        places = self._created(entries).blocks * BLOCK
        if mode == "live" and is_closed(entries):
            raise NoPlace("the study is closed", place=str(self.path), mend="Create another study")
        slot, refilled = _next_slot(entries, mode, refill)
        if mode == "live" and slot >= places:
            raise NoPlace(
                f"all {places} places of the study are taken",
                place=str(self.path),
                mend="Close the study, or create one with more blocks",
            )
        return slot, refilled

    def _created(self, entries: Sequence[LedgerEntry]) -> StudyCreated:
        if entries and isinstance(entries[0], StudyCreated):
            return entries[0]
        raise LedgerError(
            "the ledger does not begin with the study's creation",
            place=f"{self.path}, line 1",
            mend="Restore it from a copy; nothing was allocated",
        )

    def _decoded(self, data: bytes) -> Iterator[LedgerEntry]:
        complete, _, _torn = data.rpartition(b"\n")
        for number, line in enumerate(complete.split(b"\n"), start=1):
            if not line:
                continue
            try:
                yield _decoder.decode(line)
            except msgspec.DecodeError as error:
                raise LedgerError(
                    f"an entry cannot be read: {error}",
                    place=f"{self.path}, line {number}",
                    mend="Restore the ledger from a copy; nothing was changed",
                ) from error

    @contextmanager
    def _locked(self) -> Iterator[Callable[[LedgerEntry], None]]:
        """Hold the ledger alone; yields what appends an entry durably."""
        try:
            descriptor = os.open(self.path, os.O_RDWR | os.O_APPEND | os.O_CREAT, 0o600)
        except OSError as error:
            raise LedgerError(
                f"the ledger cannot be written ({error.strerror})",
                place=str(self.path),
                mend="Give this account the right to write there",
            ) from error
        try:
            fcntl.flock(descriptor, fcntl.LOCK_EX)
            _drop_torn_tail(descriptor)
            yield lambda entry: _append(descriptor, self.path, entry)
        finally:
            os.close(descriptor)


def agreement(entries: Sequence[LedgerEntry]) -> StudyCreated | SettingsAmended | None:
    """The entry with the settings that the study runs under; None where there is no ledger yet."""
    for entry in reversed(entries):
        if isinstance(entry, StudyCreated | SettingsAmended):
            return entry
    return None


def agreed_hash(entries: Sequence[LedgerEntry]) -> str:
    """The hash of the settings that the study runs under; empty where there is no ledger yet."""
    agreed = agreement(entries)
    return "" if agreed is None else agreed.settings_hash


def is_closed(entries: Sequence[LedgerEntry]) -> bool:
    """Whether recruiting is over."""
    return any(isinstance(entry, StudyClosed) for entry in entries)


def slot_of(entries: Sequence[LedgerEntry], participant: str, mode: Mode) -> SlotTaken | None:
    """The slot a participant holds in a mode, if any."""
    for entry in entries:
        if isinstance(entry, SlotTaken) and (entry.participant, entry.mode) == (participant, mode):
            return entry
    return None


def ending_of(entries: Sequence[LedgerEntry], participant: str, mode: Mode) -> Ending | None:
    """How a participant's session ended last; None while it has not, or goes on again."""
    for entry in reversed(entries):
        if isinstance(entry, SessionEnded | CameBack) and (entry.participant, entry.mode) == (
            participant,
            mode,
        ):
            return entry.ending if isinstance(entry, SessionEnded) else None
    return None


def _holders(entries: Sequence[LedgerEntry], mode: Mode) -> dict[int, str]:
    """Who holds each slot of a mode, or held it last."""
    return {
        entry.slot: entry.participant
        for entry in entries
        if isinstance(entry, SlotTaken) and entry.mode == mode
    }


def _next_slot(entries: Sequence[LedgerEntry], mode: Mode, refill: bool) -> tuple[int, bool]:
    """The next slot of a mode, and whether it was somebody's before."""
    holders = _holders(entries, mode)
    if refill:
        for slot, holder in sorted(holders.items()):
            if ending_of(entries, holder, mode) in ("dropped", "withdrawn"):
                return slot, True
    return len(holders), False


def _append(descriptor: int, path: Path, entry: LedgerEntry) -> None:
    line = msgspec.json.encode(entry) + b"\n"
    try:
        if os.write(descriptor, line) != len(line):
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
        os.fsync(descriptor)
    except OSError as error:
        full = error.errno in (errno.ENOSPC, errno.EDQUOT, errno.EFBIG)
        raise LedgerError(
            "the disk is full" if full else f"the ledger cannot be written ({error.strerror})",
            place=str(path),
            mend="Free some space and try again; the entry does not count",
        ) from error


def _drop_torn_tail(descriptor: int) -> None:
    """Cut off what a crash left behind after the last newline: it was never acted upon."""
    size = os.fstat(descriptor).st_size
    if size == 0 or os.pread(descriptor, 1, size - 1) == b"\n":
        return
    os.ftruncate(descriptor, os.pread(descriptor, size, 0).rfind(b"\n") + 1)
