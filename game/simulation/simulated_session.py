"""The whole session of one simulated person, conducted like a real participant's."""

from __future__ import annotations

import asyncio
import os
from collections.abc import Callable, Mapping
from dataclasses import dataclass, fields
from datetime import UTC, datetime
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory

from game.coach.yoke import Yoke
from game.journal.clock import SIMULATED_EPOCH_MS, VirtualClock
from game.journal.folders import JOURNAL
from game.journal.records import StudyMode
from game.journal.sink import FileSink, MemorySink, Sink
from game.rescuers.person import Population
from game.simulation.donor import simulated_donor
from game.simulation.dropped_line import AWAY_MS, DroppingClock, HungUp, drop_of
from game.simulation.leaver import Leaver, pages_before_leaving
from game.simulation.simulated_participant import SimulatedParticipant
from game.study.design import PAPER, Design
from game.study.folder import LEDGER, Identity, Study
from game.study.ledger import Ledger, LedgerEntry, SessionEnding, SlotTaken
from game.study.protocol.conduct import Participant, conduct
from game.study.protocol.study_session import StudySession, open_session, session_seed
from game.world.building import Building

_NO_FOLDER = Path(os.devnull)
"""The folder of a session that is returned instead of written; there is nothing in it."""


def simulated_now() -> str:
    """The time stamp of every entry in a simulated study's ledger."""
    return datetime.fromtimestamp(SIMULATED_EPOCH_MS / 1000, UTC).isoformat(timespec="milliseconds")


def rescuer_name(population: Population) -> str:
    """The name that journals give to the people of a population."""
    return f"simulated {population.name}"


def play_session(study: Study, taken: SlotTaken, population: Population) -> bytes:
    """The journal of one simulated participant with the slot `taken`; nothing is left on the disk.

    It is the same for the same study, slot and population, wherever it is computed.
    """
    identity = Identity("simulated", taken.participant)
    drop_ms = drop_of(session_seed(study, identity), population)
    if drop_ms is None:
        sink, clock = MemorySink(), VirtualClock()
        held = _held(study, taken, _NO_FOLDER)
        session = _opened(held, identity, population, clock, lambda _path: sink)
        simulated = SimulatedParticipant(session, clock, population)
        asyncio.run(conduct(session, _who_may_leave(simulated, session, population)))
        return bytes(sink.data)
    with TemporaryDirectory() as folder:
        held = _held(study, taken, Path(folder))
        _play_with_a_break(held, identity, population, DroppingClock(drop_ms))
        return (held.home(identity) / JOURNAL).read_bytes()


def _play_with_a_break(
    held: HeldStudy, identity: Identity, population: Population, clock: DroppingClock
) -> None:
    """A session whose line drops, and which goes on once the participant has logged in again."""
    session = _opened(held, identity, population, clock, FileSink.begin)
    clock.hang_up = partial(session.journal.interrupt, "SIGHUP")
    simulated = SimulatedParticipant(session, clock, population)
    person = _who_may_leave(simulated, session, population)
    try:
        asyncio.run(conduct(session, person))
    except HungUp:
        clock.now_ms += AWAY_MS
        again = _opened(held, identity, population, clock, FileSink.begin)
        simulated.come_back(again)
        asyncio.run(conduct(again, person))


def _held(study: Study, taken: SlotTaken, folder: Path) -> HeldStudy:
    parts = {part.name: getattr(study, part.name) for part in fields(Study)}
    return HeldStudy(**{**parts, "folder": folder}, taken=taken)


def _opened(
    held: HeldStudy,
    identity: Identity,
    population: Population,
    clock: VirtualClock,
    sink: Callable[[Path], Sink],
) -> StudySession:
    return open_session(
        held, identity, None, clock=clock, rescuer=rescuer_name(population), sink=sink
    )


def _who_may_leave(
    person: SimulatedParticipant, session: StudySession, population: Population
) -> Participant:
    pages = pages_before_leaving(session, population)
    return person if pages is None else Leaver.of(person, pages)


class _HeldSlot(Ledger):
    """A ledger that knows one slot and writes nothing: the process that hands out the work keeps
    the real one."""

    def __init__(self, path: Path, taken: SlotTaken) -> None:
        super().__init__(path, simulated_now)
        self._taken = taken

    def entries(self) -> tuple[LedgerEntry, ...]:
        return (self._taken,)

    def agree(self, inputs: Mapping[str, str]) -> None:
        pass

    def allocate(
        self,
        participant: str,
        mode: StudyMode,
        *,
        refill: bool = False,
        design: Design = PAPER,
        places: int | None = None,
    ) -> SlotTaken:
        return self._taken

    def end_session(self, participant: str, mode: StudyMode, ending: SessionEnding) -> None:
        pass


@dataclass(frozen=True, kw_only=True)
class HeldStudy(Study):
    """A study as seen by one simulated participant, who already has the slot `taken`."""

    taken: SlotTaken

    def keep_copies(self) -> None:
        pass

    def yoke_for(self, identity: Identity, building: Building, memorise_ms: int) -> Yoke:
        """The levels that another simulated person was told: sessions are made at the same time,
        so none of them could be waited for."""
        other = self.settings.yoked_to
        assert other is not None
        who = self.settings.seed, identity.participant, "donor", building.name
        return simulated_donor(self.settings, other, building, memorise_ms, who)

    @property
    def ledger(self) -> Ledger:
        return _HeldSlot(self.folder / LEDGER, self.taken)
