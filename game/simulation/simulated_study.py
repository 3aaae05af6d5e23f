"""Simulating a study in a folder: begun or continued, and the same for the same seed."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path

from game.coach.spec import DEFAULT_PRESET
from game.errors import AnaError
from game.journal.folders import JOURNAL
from game.journal.reader import read_journal
from game.rescuers.person import Population
from game.simulation.simulated_session import rescuer_name, simulated_now
from game.simulation.workers import Journals
from game.study.design import BLOCK
from game.study.folder import LEDGER, SETTINGS, Identity, Study, StudyError, new_study, open_study
from game.study.ledger import Ledger, SlotTaken, ending_of
from game.study.study_settings import ADAPTIVE

Workers = Callable[[Study, Sequence[SlotTaken], Population], Journals]
_PART = ".part"


def simulate(
    folder: Path,
    participants: int,
    seed: int,
    population: Population,
    workers: Workers,
    preset: str | None = None,
    coach: str | None = None,
) -> Iterator[int]:
    """Simulate the first `participants` of a study in `folder`, which is made if it is new.

    Yields how many are finished, first and after each participant. Finished sessions stay as they
    are, so an interrupted simulation continues where it stopped. Slots are taken in the order of
    participants before any work is handed out. Raises StudyError for a folder of another seed,
    preset, coach or kind of people, AnaError's other relatives for what cannot be read or written.
    """
    study = _opened(folder, seed, participants, preset, coach)
    ledger = Ledger(folder / LEDGER, simulated_now)
    ledger.agree(study.inputs)
    study.keep_copies()
    _same_people(study, population)
    design = study.settings.design
    slots = [ledger.allocate(it, "simulated", design=design) for it in names(participants)]
    finished = [taken for taken in slots if _journal_of(study, taken).exists()]
    for taken in finished:
        _end(ledger, taken, _journal_of(study, taken).read_bytes())
    done = len(finished)
    yield done
    work = [taken for taken in slots if taken not in finished]
    for taken, journal in workers(study, work, population):
        _write(_journal_of(study, taken), journal)
        _end(ledger, taken, journal)
        done += 1
        yield done


def names(participants: int) -> Iterator[str]:
    """The names of simulated participants: S0001, S0002, ..."""
    return (f"S{number:04}" for number in range(1, participants + 1))


def _opened(
    folder: Path, seed: int, participants: int, preset: str | None, coach: str | None
) -> Study:
    if not (folder / SETTINGS).exists():
        blocks = -(-participants // BLOCK)
        new_study(folder, seed, blocks, preset or DEFAULT_PRESET, coach or ADAPTIVE, simulated_now)
    study = open_study(folder)
    settings = study.settings
    for name, asked, there in (
        ("seed", seed, settings.seed),
        ("preset", preset or settings.preset, settings.preset),
        ("coach", coach or settings.coach, settings.coach),
    ):
        if asked != there:
            raise StudyError(
                f"the study in this folder has the {name} {there}",
                place=str(folder),
                hint=f"Give --{name} {there}, or another folder",
            )
    return study


def _same_people(study: Study, population: Population) -> None:
    """Check that anyone in the study already comes from the same population."""
    home = study.home(Identity("simulated", "any")).parent
    for path in sorted(home.glob(f"*/{JOURNAL}"))[:1]:
        there = read_journal(path).started.rescuer
        if there != rescuer_name(population):
            raise StudyError(
                f"the people in this study are '{there}'",
                place=str(study.folder),
                hint="Give their population with --population, or another folder",
            )


def _journal_of(study: Study, taken: SlotTaken) -> Path:
    return study.home(Identity("simulated", taken.participant)) / JOURNAL


def _end(ledger: Ledger, taken: SlotTaken, journal: bytes) -> None:
    """Note that a session has ended; whoever left or is in the middle has not ended it."""
    last = journal.splitlines()[-1]
    ended = b'"type":"session_ended"' in last and b'"reason":"quit"' not in last
    if ended and ending_of(ledger.entries(), taken.participant, "simulated") is None:
        ledger.end_session(taken.participant, "simulated", "finished")


def _write(path: Path, journal: bytes) -> None:
    """Write the whole journal or nothing. Raises AnaError."""
    part = path.with_name(path.name + _PART)
    try:
        path.parent.mkdir(mode=0o700, parents=True, exist_ok=True)
        part.touch(mode=0o600)
        with part.open("wb") as file:
            file.write(journal)
            file.flush()
            os.fsync(file.fileno())
        part.replace(path)
    except OSError as error:
        raise AnaError(
            f"the journal cannot be written ({error.strerror})",
            place=str(path),
            hint="Free some space or choose another folder, then run the same command to continue",
        ) from error
