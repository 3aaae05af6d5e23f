"""A study half-way through, with simulated people, for trying the experimenter's tools."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import partial
from pathlib import Path

from game.journal.history import Step
from game.journal.reader import parse_journal
from game.journal.records import PhaseStarted
from game.rescuers.person import Population
from game.simulation.simulated_session import simulated_now
from game.simulation.simulated_study import Workers, names, simulate
from game.simulation.workers import Journals
from game.study.design import BLOCK
from game.study.folder import Study, new_study
from game.study.ledger import SlotTaken

UNDER_WAY = {
    Step("memorise", 1): 2,
    Step("mission", 1): 400,
    Step("likert", 1): 3,
    Step("label", 2): 12,
    Step("mission", 2): 250,
    Step("preference"): 1,
}
"""Where the last people are, and how many records of that phase they have."""


def demonstrate(
    folder: Path, participants: int, seed: int, population: Population, workers: Workers
) -> Iterator[int]:
    """Make a study in `folder` whose places are about half taken, and yield how many have come.

    The last of them are in the middle of their sessions, and the others have come to the end.
    Raises StudyError unless the folder is new or empty.
    """
    new_study(folder, seed, -(-2 * participants // BLOCK), now=simulated_now)
    last = list(names(participants))[-len(UNDER_WAY) :]
    cut = partial(_cut_short, workers, dict(zip(last, UNDER_WAY, strict=False)))
    return simulate(folder, participants, seed, population, cut)


def _cut_short(
    workers: Workers,
    where: dict[str, Step],
    study: Study,
    work: Sequence[SlotTaken],
    population: Population,
) -> Journals:
    for taken, journal in workers(study, work, population):
        step = where.get(taken.participant)
        yield taken, journal if step is None else _within(journal, step)


def _within(journal: bytes, step: Step) -> bytes:
    """A journal up to the middle of `step`; all of it, where it does not get there."""
    for number, entry in enumerate(parse_journal(journal, "simulated").entries):
        envelope = entry.envelope
        if isinstance(entry.record, PhaseStarted) and (envelope.phase, envelope.round) == step:
            return b"".join(journal.splitlines(keepends=True)[: number + UNDER_WAY[step]])
    return journal
