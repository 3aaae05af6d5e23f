"""A fault of ours, anywhere: what the participant sees, and what is left behind."""

from __future__ import annotations

import shutil
from itertools import count, islice
from pathlib import Path
from random import Random

import pytest

from game.journal.history import Step
from game.journal.records import Interruption, Resumed
from game.study.folder import Study, open_study
from game.study.lock import SessionLock
from tests.screens.study.faulty import run_with_fault
from tests.study.people import P01, journal_of, rewind

QUICK, MANY = 6, 200
STEPS = (
    Step("memorise", 1),
    Step("label", 1),
    Step("mission", 1),
    Step("sliders", 1),
    Step("likert", 2),
    Step("preference"),
    Step("debrief"),
)
MOST_CALLS = 600
"""Random keys lead to about so many counted calls, and often to more."""


def survives(finished: Study, folder: Path, seed: int) -> str:
    """Let a fault be raised, and check what follows; where it was raised."""
    shutil.copytree(finished.folder, folder)
    study = open_study(folder)
    random = Random(seed)
    rewind(study, random.choice(STEPS))
    before = len(journal_of(study).entries)
    outcome = run_with_fault(study, random.randrange(1, MOST_CALLS), seed)
    seen = outcome.output.decode(errors="replace")
    assert "Traceback" not in seen and "ZeroDivisionError" not in seen, outcome.place
    SessionLock(study.home(P01)).release()
    after = [entry.record for entry in journal_of(study).entries[before:]]
    if outcome.place:
        assert outcome.status == 1, outcome.place
        assert outcome.output.count(b"\x1b[?1049h") == outcome.output.count(b"\x1b[?1049l")
        assert outcome.output.rfind(b"\x1b[?1007h") >= outcome.output.rfind(b"\x1b[?1007l")
        assert "The study cannot continue here" in seen, outcome.place
        if (
            any(isinstance(record, Resumed) for record in after)
            and "/journal/" not in outcome.place
        ):
            noted = [it.kind for it in after if isinstance(it, Interruption)]
            assert noted == ["defect"], outcome.place
    return outcome.place


@pytest.mark.parametrize("seed", range(QUICK))
def test_a_fault_at_a_random_place(finished: Study, tmp_path: Path, seed: int) -> None:
    survives(finished, tmp_path / "study", seed)


@pytest.mark.slow
def test_two_hundred_faults_at_random_places(finished: Study, tmp_path: Path) -> None:
    raised = (survives(finished, tmp_path / str(seed), seed) for seed in count(QUICK))
    places = list(islice(filter(None, raised), MANY))
    assert len(set(places)) > MANY / 3
