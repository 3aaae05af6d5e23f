"""One simulated person's whole session, led by the same conductor as anybody's."""

from __future__ import annotations

import asyncio
import os
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path

from game.journal.clock import SIMULATED_EPOCH_MS, VirtualClock
from game.journal.sink import MemorySink
from game.rescuers.person import Population
from game.simulation.simulated_participant import SimulatedParticipant
from game.study.conduct import conduct
from game.study.folder import LEDGER, Identity, Study
from game.study.ledger import Ending, Ledger, LedgerEntry, Mode, SlotTaken
from game.study.study_session import open_session

NOWHERE = Path(os.devnull)
"""The folder of a session that is handed back and not written; there is nothing in it."""


def simulated_now() -> str:
    """The time of everything in a simulated study's ledger."""
    return datetime.fromtimestamp(SIMULATED_EPOCH_MS / 1000, UTC).isoformat(timespec="milliseconds")


def rescuer_name(population: Population) -> str:
    """What journals call the people of a population."""
    return f"simulated {population.name}"


def play_session(study: Study, taken: SlotTaken, population: Population) -> bytes:
    """The journal of one simulated participant, who holds the slot `taken`; nothing is written.

    The same for the same study, slot and population, wherever it is computed.
    """
    clock, sink = VirtualClock(), MemorySink()
    held = HeldStudy(
        folder=NOWHERE,
        settings=study.settings,
        copy=study.copy,
        texts=study.texts,
        items=study.items,
        buildings=study.buildings,
        practice=study.practice,
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
    asyncio.run(conduct(session, SimulatedParticipant(session, clock, population)))
    return bytes(sink.data)


class _HeldSlot(Ledger):
    """A ledger of which one slot is known, and in which nothing is written: whoever handed the
    work out keeps the real one."""

    def __init__(self, path: Path, taken: SlotTaken) -> None:
        super().__init__(path, simulated_now)
        self._taken = taken

    def entries(self) -> tuple[LedgerEntry, ...]:
        return (self._taken,)

    def agree(self, settings_hash: str) -> None:
        pass

    def allocate(self, participant: str, mode: Mode, *, refill: bool = False) -> SlotTaken:
        return self._taken

    def end_session(self, participant: str, mode: Mode, ending: Ending) -> None:
        pass


@dataclass(frozen=True, kw_only=True)
class HeldStudy(Study):
    """A study as one simulated participant sees it, whose slot is `taken` already."""

    taken: SlotTaken

    @property
    def ledger(self) -> Ledger:
        return _HeldSlot(self.folder / LEDGER, self.taken)
