"""The whole session of one simulated person, conducted like a real participant's."""

from __future__ import annotations

import asyncio
import os
from collections.abc import Mapping
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path

from game.journal.clock import SIMULATED_EPOCH_MS, VirtualClock
from game.journal.records import StudyMode
from game.journal.sink import MemorySink
from game.rescuers.person import Population
from game.simulation.leaver import Leaver, pages_before_leaving
from game.simulation.simulated_participant import SimulatedParticipant
from game.study.folder import LEDGER, Identity, Study
from game.study.ledger import Ledger, LedgerEntry, SessionEnding, SlotTaken
from game.study.protocol.conduct import Participant, conduct
from game.study.protocol.study_session import open_session

_NO_FOLDER = Path(os.devnull)
"""The folder of a session that is returned instead of written; there is nothing in it."""


def simulated_now() -> str:
    """The time stamp of every entry in a simulated study's ledger."""
    return datetime.fromtimestamp(SIMULATED_EPOCH_MS / 1000, UTC).isoformat(timespec="milliseconds")


def rescuer_name(population: Population) -> str:
    """The name that journals give to the people of a population."""
    return f"simulated {population.name}"


def play_session(study: Study, taken: SlotTaken, population: Population) -> bytes:
    """The journal of one simulated participant with the slot `taken`; nothing is written.

    It is the same for the same study, slot and population, wherever it is computed.
    """
    clock, sink = VirtualClock(), MemorySink()
    held = HeldStudy(
        folder=_NO_FOLDER,
        settings=study.settings,
        copy=study.copy,
        texts=study.texts,
        forms=study.forms,
        buildings=study.buildings,
        practice=study.practice,
        inputs=study.inputs,
        taken=taken,
    )
    session = open_session(
        held,
        Identity("simulated", taken.participant),
        None,
        clock=clock,
        rescuer=rescuer_name(population),
        sink=lambda _path: sink,
    )
    person: Participant = SimulatedParticipant(session, clock, population)
    if (pages := pages_before_leaving(session, population)) is not None:
        person = Leaver.of(person, pages)
    asyncio.run(conduct(session, person))
    return bytes(sink.data)


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

    def allocate(self, participant: str, mode: StudyMode, *, refill: bool = False) -> SlotTaken:
        return self._taken

    def end_session(self, participant: str, mode: StudyMode, ending: SessionEnding) -> None:
        pass


@dataclass(frozen=True, kw_only=True)
class HeldStudy(Study):
    """A study as seen by one simulated participant, who already has the slot `taken`."""

    taken: SlotTaken

    def keep_copies(self) -> None:
        pass

    @property
    def ledger(self) -> Ledger:
        return _HeldSlot(self.folder / LEDGER, self.taken)
