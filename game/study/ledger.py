"""The ledger of a study: who was allocated what, in a form that can be audited by itself.

Append-only JSON lines, written under an exclusive `flock` and fsynced before the lock is released:
a slot is on the disk before anyone acts on it, and two people who ask at once get two slots. The
lock dies with its process, so a crash never leaves it held.
"""

from __future__ import annotations

import errno
import fcntl
import os
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from datetime import UTC, datetime
from pathlib import Path
from typing import Literal, TypeVar

import msgspec
from msgspec.structs import replace

from game.errors import AnaError, disk_hint
from game.journal.records import StudyMode
from game.study.design import PAPER, Design, DesignCell
from game.study.files import NEW_STUDY, NO_STUDY, SETTINGS

SessionEnding = Literal["finished", "declined", "withdrawn", "dropped", "turned_away"]


class LedgerError(AnaError):
    """The ledger cannot be read or written, or does not allow the request."""


class NoPlace(LedgerError):
    """There is no place for this participant: the study is closed or full, or the place is gone.

    The message is for the experimenter; participants read `Texts.no_place`.
    """


class LedgerLine(msgspec.Struct, frozen=True, kw_only=True, tag_field="type"):
    """One line of the ledger; `utc` is stamped when it is written."""

    utc: str = ""


class StudyCreated(LedgerLine, frozen=True, tag="study_created"):
    """`settings_hash` is that of study.toml; ledgers of earlier releases know no other input."""

    seed: int
    blocks: int
    settings_hash: str


class SlotTaken(LedgerLine, frozen=True, tag="slot_taken"):
    """A participant was allocated. With `refill`, the slot used to be a drop-out's."""

    participant: str
    mode: StudyMode
    slot: int
    cell: DesignCell
    refill: bool = False


class SessionOutcome(LedgerLine, frozen=True, tag="session_ended"):
    """How a participant's session ended. After a withdrawal nothing but this is left."""

    participant: str
    mode: StudyMode
    ending: SessionEnding


class CameBack(LedgerLine, frozen=True, tag="came_back"):
    """A participant marked as a drop-out takes part again, in the same slot."""

    participant: str
    mode: StudyMode


class SettingsAmended(LedgerLine, frozen=True, tag="settings_amended"):
    """What sessions are made from, from now on: the SHA-256 of study.toml, texts.toml, forms.toml
    and every building by name, and which of them `changed`."""

    settings_hash: str
    why: str
    inputs: dict[str, str] = {}
    changed: tuple[str, ...] = ()


class Unblinded(LedgerLine, frozen=True, tag="unblinded"):
    """Someone asked for counts by design cell while the study was open."""

    why: str


class StudyClosed(LedgerLine, frozen=True, tag="study_closed"):
    """Recruiting is over: no more live slots are given out, and nothing has to be concealed."""


LedgerEntry = (
    StudyCreated | SlotTaken | SessionOutcome | CameBack | SettingsAmended | Unblinded | StudyClosed
)

_Entry = TypeVar("_Entry", bound=LedgerEntry)

_decoder = msgspec.json.Decoder(LedgerEntry)


def utc_now() -> str:
    """The wall clock, as written in ledgers and journals."""
    return datetime.now(UTC).isoformat(timespec="milliseconds")


class Ledger:
    """The ledger in one file. `now` gives the time to write into entries."""

    def __init__(self, path: Path, now: Callable[[], str] = utc_now) -> None:
        self.path = path
        self._now = now

    def create(self, seed: int, blocks: int, settings_hash: str) -> None:
        """Begin a ledger. Raises LedgerError if there already is one."""
        if self.path.exists():
            raise LedgerError(
                "there already is a ledger",
                place=str(self.path),
                hint="Choose a new folder for a new study",
            )
        with self._locked() as write:
            write(StudyCreated(seed=seed, blocks=blocks, settings_hash=settings_hash))

    def entries(self) -> tuple[LedgerEntry, ...]:
        """All entries. A last line that a crash left unfinished does not count."""
        try:
            data = self.path.read_bytes()
        except FileNotFoundError as error:
            if not self.path.with_name(SETTINGS).exists():
                folder = str(self.path.parent)
                raise LedgerError(NO_STUDY, place=folder, hint=NEW_STUDY) from error
            raise LedgerError(
                "the ledger is missing", place=str(self.path), hint="Restore it from a backup"
            ) from error
        except OSError as error:
            raise LedgerError(
                f"the ledger cannot be read ({error.strerror})",
                place=str(self.path),
                hint=disk_hint(error),
            ) from error
        return tuple(self._decoded(data))

    def allocate(
        self,
        participant: str,
        mode: StudyMode,
        *,
        refill: bool = False,
        design: Design = PAPER,
        places: int | None = None,
    ) -> SlotTaken:
        """The participant's slot: the one they already hold, or the next free one of the mode.

        `places` are all that there are, as many as the blocks of `design` have if not said. With
        `refill`, the slots of people who dropped out or withdrew are given out first.
        Raises NoPlace if every live slot is taken or the study is closed.
        """
        with self._locked() as write:
            entries = self.entries()
            held = slot_of(entries, participant, mode)
            if held is not None:
                return held
            slot, refilled = self._free_slot(entries, mode, refill, design, places)
            cell = design.cell(self._created(entries).seed, mode, slot)
            return write(
                SlotTaken(participant=participant, mode=mode, slot=slot, cell=cell, refill=refilled)
            )

    def see_place(
        self,
        participant: str,
        mode: StudyMode,
        *,
        refill: bool = False,
        design: Design = PAPER,
        places: int | None = None,
    ) -> None:
        """Raise NoPlace if `allocate` would. Nothing is written."""
        entries = self.entries()
        if slot_of(entries, participant, mode) is None:
            self._free_slot(entries, mode, refill, design, places)

    def end_session(self, participant: str, mode: StudyMode, ending: SessionEnding) -> None:
        """Record how a session ended; repeating the same ending writes nothing."""
        with self._locked() as write:
            if ending_of(self.entries(), participant, mode) != ending:
                write(SessionOutcome(participant=participant, mode=mode, ending=ending))

    def come_back(self, participant: str, mode: StudyMode) -> None:
        """Let a drop-out take part again; does nothing for anyone else.

        From then on the slot is not given to anyone else. Raises NoPlace if it already has been.
        """
        with self._locked() as write:
            entries = self.entries()
            if ending_of(entries, participant, mode) != "dropped":
                return
            slot = slot_of(entries, participant, mode)
            if slot is not None and _holders(entries, mode)[slot.slot] != participant:
                raise NoPlace(
                    f"the place of {participant} has been given to someone else",
                    place=str(self.path.parent),
                )
            write(CameBack(participant=participant, mode=mode))

    def agree(self, inputs: Mapping[str, str]) -> None:
        """Make sure that the study is made from these inputs: SHA-256 by name.

        Until the first live slot is taken they may change freely; the change is recorded. Raises
        LedgerError, naming what changed later without an amendment.
        """
        with self._locked() as write:
            entries = self.entries()
            agreed = agreed_inputs(entries)
            changed = differing(agreed, inputs)
            if changed and any(isinstance(it, SlotTaken) and it.mode == "live" for it in entries):
                raise LedgerError(
                    f"{', '.join(changed)} changed after the first participant was allocated",
                    place=str(self.path.parent),
                    hint="Undo the change, or record it: ana study amend DIR --why TEXT",
                )
            if changed or agreed.keys() != inputs.keys():
                why = "before the first participant" if changed else "recorded for the first time"
                write(_amended(inputs, why, changed))

    def amend(self, inputs: Mapping[str, str], why: str) -> tuple[str, ...]:
        """Record that the inputs were changed on purpose; returns which were."""
        with self._locked() as write:
            changed = differing(agreed_inputs(self.entries()), inputs)
            if changed:
                write(_amended(inputs, why, changed))
            return changed

    def unblind(self, why: str) -> bool:
        """Record that the allocation was looked at; False where the study is closed."""
        if is_closed(self.entries()):
            return False
        with self._locked() as write:
            write(Unblinded(why=why))
        return True

    def close(self) -> None:
        """Close the study; closing it again writes nothing."""
        with self._locked() as write:
            if not is_closed(self.entries()):
                write(StudyClosed())

    def _free_slot(
        self,
        entries: Sequence[LedgerEntry],
        mode: StudyMode,
        refill: bool,
        design: Design,
        places: int | None,
    ) -> tuple[int, bool]:
        """The next slot of a mode, and whether someone else had it before. Raises NoPlace."""
        places = places or self._created(entries).blocks * design.block
        if mode == "live" and is_closed(entries):
            raise NoPlace("the study is closed", place=str(self.path), hint="Create a new study")
        slot, refilled = _next_slot(entries, mode, refill)
        if mode == "live" and slot >= places:
            raise NoPlace(
                f"all {places} places of the study are taken",
                place=str(self.path),
                hint="Close the study, or create a new one with more blocks",
            )
        return slot, refilled

    def _created(self, entries: Sequence[LedgerEntry]) -> StudyCreated:
        if entries and isinstance(entries[0], StudyCreated):
            return entries[0]
        raise LedgerError(
            "the ledger does not begin with the creation of the study",
            place=f"{self.path}, line 1",
            hint="Restore the ledger from a backup; nothing was allocated",
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
                    f"this entry cannot be read: {error}",
                    place=f"{self.path}, line {number}",
                    hint="Restore the ledger from a backup; nothing was changed",
                ) from error

    @contextmanager
    def _locked(self) -> Iterator[Callable[[_Entry], _Entry]]:
        """Lock the ledger; yields a function that stamps an entry and appends it durably."""

        def write(entry: _Entry) -> _Entry:
            stamped = replace(entry, utc=self._now())
            _append(descriptor, self.path, stamped)
            return stamped

        try:
            descriptor = os.open(self.path, os.O_RDWR | os.O_APPEND | os.O_CREAT, 0o600)
        except OSError as error:
            raise LedgerError(
                f"the ledger cannot be written ({error.strerror})",
                place=str(self.path),
                hint=disk_hint(error) or "Allow this account to write there",
            ) from error
        try:
            lock_whole(descriptor, self.path)
            _drop_torn_tail(descriptor)
            yield write
        finally:
            os.close(descriptor)


def lock_whole(descriptor: int, path: Path, *, wait: bool = True) -> None:
    """Lock a file for this process alone. Raises BlockingIOError where another one has it and
    `wait` is false, and LedgerError where the disk has no locks."""
    try:
        fcntl.flock(descriptor, fcntl.LOCK_EX | (0 if wait else fcntl.LOCK_NB))
    except BlockingIOError:
        raise
    except OSError as error:
        raise LedgerError(
            f"files cannot be locked on this disk ({error.strerror})",
            place=str(path),
            hint="Keep the study on a local disk: some network drives have no locks",
        ) from error


def agreement(entries: Sequence[LedgerEntry]) -> StudyCreated | SettingsAmended | None:
    """The entry with the settings that the study runs with; None if there is no ledger yet."""
    for entry in reversed(entries):
        if isinstance(entry, StudyCreated | SettingsAmended):
            return entry
    return None


def agreed_inputs(entries: Sequence[LedgerEntry]) -> dict[str, str]:
    """The inputs that the study runs with, SHA-256 by name; of a ledger that an earlier release
    wrote, study.toml alone, and none if there is no ledger yet."""
    agreed = agreement(entries)
    if agreed is None:
        return {}
    known = agreed.inputs if isinstance(agreed, SettingsAmended) else {}
    return known or {"study.toml": agreed.settings_hash}


def differing(agreed: Mapping[str, str], now: Mapping[str, str]) -> tuple[str, ...]:
    """The names of inputs that are not what was agreed on. Of an earlier release's ledger only
    study.toml is compared."""
    names = now.keys() | agreed.keys() if len(agreed) > 1 else agreed.keys()
    return tuple(sorted(name for name in names if agreed.get(name) != now.get(name)))


def _amended(inputs: Mapping[str, str], why: str, changed: tuple[str, ...]) -> SettingsAmended:
    return SettingsAmended(
        settings_hash=inputs["study.toml"], why=why, inputs=dict(inputs), changed=changed
    )


def is_closed(entries: Sequence[LedgerEntry]) -> bool:
    """Whether recruiting is over."""
    return any(isinstance(entry, StudyClosed) for entry in entries)


def slot_of(entries: Sequence[LedgerEntry], participant: str, mode: StudyMode) -> SlotTaken | None:
    """The slot a participant holds in a mode, if any."""
    for entry in entries:
        if isinstance(entry, SlotTaken) and (entry.participant, entry.mode) == (participant, mode):
            return entry
    return None


def ending_of(
    entries: Sequence[LedgerEntry], participant: str, mode: StudyMode
) -> SessionEnding | None:
    """How a participant's session last ended; None if it has not, or has been resumed."""
    for entry in reversed(entries):
        if isinstance(entry, SessionOutcome | CameBack) and (entry.participant, entry.mode) == (
            participant,
            mode,
        ):
            return entry.ending if isinstance(entry, SessionOutcome) else None
    return None


def _holders(entries: Sequence[LedgerEntry], mode: StudyMode) -> dict[int, str]:
    """Who holds each slot of a mode, or last held it."""
    return {
        entry.slot: entry.participant
        for entry in entries
        if isinstance(entry, SlotTaken) and entry.mode == mode
    }


def _next_slot(entries: Sequence[LedgerEntry], mode: StudyMode, refill: bool) -> tuple[int, bool]:
    """The next slot of a mode, and whether someone else had it before."""
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
            hint="Free some space and try again; this entry was not recorded",
        ) from error


def _drop_torn_tail(descriptor: int) -> None:
    """Cut off whatever a crash left after the last newline: nothing was done because of it."""
    size = os.fstat(descriptor).st_size
    if size == 0 or os.pread(descriptor, 1, size - 1) == b"\n":
        return
    os.ftruncate(descriptor, os.pread(descriptor, size, 0).rfind(b"\n") + 1)
