"""One participant's session: its journal, new or continued, and how far it has got.

Nothing is written to disk before consent: until then the journal is kept in memory. If someone
declines, only that is written.
"""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Literal

from msgspec.structs import replace

from game.errors import where
from game.journal.clock import Clock, SystemClock
from game.journal.folders import JOURNAL
from game.journal.history import Step, history_of
from game.journal.reader import Entry, read_file, read_journal
from game.journal.records import (
    PERSON,
    Allocated,
    Declined,
    Envelope,
    Interruption,
    Record,
    SessionEnded,
    SessionStarted,
    StudyAmended,
    TakenOver,
    Terminal,
)
from game.journal.sink import FileSink, Sink
from game.journal.writer import Journal, versions
from game.study.chance import digest, number
from game.study.folder import Identity, Study, StudyError, admit_by_roster, amendment
from game.study.ledger import differing, ending_of

CODE_LETTERS = "ABCDEFGHJKMNPQRTUVWXYZ2346789"
"""Letters and digits that are not easily confused."""
CODE_LENGTH = 8


class HasWithdrawn(StudyError):
    """The participant has withdrawn; they read `Texts.withdrawn`."""


class StudySession:
    """A session in progress. Methods that write raise JournalError if the journal fails."""

    def __init__(
        self,
        study: Study,
        identity: Identity,
        journal: Journal,
        clock: Clock,
        started: SessionStarted,
        keep: Callable[[], Sink],
        before: Sequence[Entry] = (),
    ) -> None:
        """`started` opened the journal; `before` holds the records of earlier segments. A journal
        that begins in memory is written to the sink that `keep` makes, from consent on."""
        self.study = study
        self.identity = identity
        self.journal = journal
        self.clock = clock
        self._started = started
        self.history = history_of((entry.envelope, entry.record) for entry in before)
        self._make_sink = keep
        self._kept = bool(before)
        self._failed = False

    @property
    def seed(self) -> int:
        """The seed of everything random in this session; see `chance`."""
        return session_seed(self.study, self.identity)

    @property
    def step(self) -> Step:
        """The step that new records belong to."""
        return Step(self.journal.phase, self.journal.round)

    @property
    def completion_code(self) -> str:
        """The participant's proof of having taken part."""
        drawn = digest(self.seed, self.identity.participant, "completion")
        return "".join(CODE_LETTERS[byte % len(CODE_LETTERS)] for byte in drawn[:CODE_LENGTH])

    def now_ms(self) -> int:
        """Steady time."""
        return self.clock.read().steady_ms

    def enter(self, step: Step) -> None:
        """From here on records belong to `step`."""
        self.journal.enter(step.phase, step.round)

    def record(self, *records: Record) -> None:
        """Write records that belong together; on return the operating system has them."""
        self.journal.extend(records)
        step = self.step
        envelope = Envelope(0, 0, 0, "", step.phase, step.round)
        for record in records:
            self.history.note(envelope, record)

    async def save(self, *records: Record) -> None:
        """Write records and wait until the disk has them."""
        self.record(*records)
        await self.journal.wait_durable()

    async def keep(self) -> None:
        """Write the journal to disk from here on, with everything it holds so far."""
        if not self._kept:
            self.journal.keep(self._make_sink())
            self._kept = True
        await self.journal.wait_durable()

    async def decline(self, version: str) -> None:
        """Record that the participant declined, and nothing else."""
        if not self._kept:
            journal = Journal(self._make_sink(), self.clock)
            journal.append(replace(self._started, terminal=None, versions=versions(None)))
            self.journal = journal
        self.enter(Step("consent"))
        self.record(Declined(version))
        await self.finish("declined")

    async def allocate(self) -> None:
        """Take a slot, or the one already held. Raises NoPlace if none is left."""
        study, (mode, participant) = self.study, self.identity

        def take() -> Allocated:
            study.freeze()
            settings = study.settings
            taken = study.ledger.allocate(
                participant,
                mode,
                refill=settings.refill_dropouts,
                design=settings.design,
                places=settings.all_places,
            )
            cell, count = taken.cell, len(settings.buildings)
            return Allocated(
                slot=taken.slot,
                refill=taken.refill,
                memorise_ms=settings.memorise_ms(cell.memorise),
                adaptive_first=cell.adaptive_first,
                static_level=cell.static_level,
                buildings=tuple(
                    settings.buildings[(cell.first_building + round_) % count]
                    for round_ in range(settings.rounds)
                ),
                instructors=settings.instructors or (),
            )

        await self.save(await asyncio.to_thread(take))

    async def see_place(self) -> None:
        """Check that the participant has a place or can get one. Raises NoPlace."""
        await asyncio.to_thread(see_place, self.study, self.identity)

    async def turn_away(self) -> None:
        """There is no place for the participant. Without consent, nothing is recorded."""
        if self._kept:
            await self.finish("turned_away")

    async def finish(self, ending: Literal["finished", "declined", "turned_away"]) -> None:
        """End the session, in the journal and in the ledger."""
        self.enter(Step("session"))
        await self.save(SessionEnded(ending))
        await asyncio.to_thread(
            self.study.ledger.end_session, self.identity.participant, self.identity.mode, ending
        )

    def note_defect(self, error: str) -> None:
        """The program failed unexpectedly; noted once."""
        if not self._failed:
            self._failed = True
            self.record(Interruption("defect", error=error))

    def stop(self) -> None:
        """The participant stops, and may come back."""
        self.record(SessionEnded("quit"))


def open_session(
    study: Study,
    identity: Identity,
    terminal: Terminal | None,
    *,
    silent_ms: int | None = None,
    clock: Clock | None = None,
    rescuer: str = PERSON,
    sink: Callable[[Path], Sink] = FileSink.begin,
) -> StudySession:
    """Begin a session, or continue an earlier one; a session that is over stays unchanged.

    The caller holds the session's lock; `silent_ms` is given if it was taken over from a process
    that had been silent for so long. A simulated session gives its `clock` and `MemorySink`.
    Raises JournalError if the journal cannot be written or read, LedgerError if the study was
    changed, NoPlace for a drop-out whose place was given to someone else, and HasWithdrawn.
    """
    clock = clock or SystemClock()
    path = study.home(identity) / JOURNAL
    _admit(study, identity)

    def keep() -> Sink:
        return sink(path)

    if not path.exists() or b"\n" not in read_file(path):
        started = _opening(study, identity, terminal, rescuer)
        journal = Journal.buffered(None, started, clock)
        return StudySession(study, identity, journal, clock, started, keep)
    transcript = read_journal(path)
    started, before = transcript.started, transcript.entries
    if history_of((entry.envelope, entry.record) for entry in before).over:
        journal = Journal.buffered(None, started, clock)
        return StudySession(study, identity, journal, clock, started, keep, before)
    changed = differing(_inputs_before(before), study.inputs)
    news: list[Record] = [] if silent_ms is None else [TakenOver(silent_ms)]
    if changed:
        news.append(
            StudyAmended(study.copy, amendment(study), inputs=dict(study.inputs), changed=changed)
        )
    journal = Journal.resume(path, terminal, clock)
    try:
        session = StudySession(study, identity, journal, clock, started, keep, before)
        for record in news:
            session.record(record)
    except Exception as error:
        journal.append(Interruption("defect", error=where(error)))
        raise
    return session


def see_place(study: Study, identity: Identity) -> None:
    """Check that a participant has a place or can get one. Raises NoPlace; writes nothing."""
    mode, participant = identity
    settings = study.settings
    study.ledger.see_place(
        participant,
        mode,
        refill=settings.refill_dropouts,
        design=settings.design,
        places=settings.all_places,
    )


def _admit(study: Study, identity: Identity) -> None:
    """Check that the ledger lets this participant take part, and let a drop-out come back."""
    participant, mode = identity.participant, identity.mode
    admit_by_roster(study.folder, identity)
    study.freeze()
    ending = ending_of(study.ledger.entries(), participant, mode)
    if ending == "dropped":
        study.ledger.come_back(participant, mode)
    if ending == "withdrawn":
        raise HasWithdrawn(
            f"{participant} has withdrawn from the study",
            place=str(study.folder),
            hint="Use another ID",
        )


def _opening(
    study: Study, identity: Identity, terminal: Terminal | None, rescuer: str
) -> SessionStarted:
    return SessionStarted(
        session=f"{identity.mode}-{identity.participant}",
        mode=identity.mode,
        simulated=rescuer != PERSON,
        rescuer=rescuer,
        participant=identity.participant,
        versions=versions(terminal),
        settings=study.settings.mission,
        seed=session_seed(study, identity),
        terminal=terminal,
        study=study.copy,
        inputs=dict(study.inputs),
    )


def session_seed(study: Study, identity: Identity) -> int:
    """The seed of a participant's session."""
    return number(study.settings.seed, identity.mode, identity.participant, "session")


def _inputs_before(before: Sequence[Entry]) -> dict[str, str]:
    """The inputs that the session was last made from; of an earlier release, study.toml alone."""
    *_, last = (
        entry.record for entry in before if isinstance(entry.record, SessionStarted | StudyAmended)
    )
    copy = last.study
    return last.inputs or ({} if copy is None else {"study.toml": copy.sha256})
