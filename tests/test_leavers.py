"""Simulated people who leave a study early, or are cut off."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from game.journal.folders import transcripts
from game.journal.history import read_history
from game.rescuers.person import POPULATIONS
from game.session.verification import verify
from game.simulation.simulated_study import simulate
from game.simulation.workers import here
from game.study.folder import LEDGER, new_study
from game.study.ledger import Ledger, ending_of
from tests.study.people import small_study


def test_whoever_leaves_has_a_place_and_no_end(tmp_path: Path) -> None:
    folder = tmp_path / "study"
    small_study(folder)
    leaving = replace(POPULATIONS["default"], name="leaving", leaving=1.0)
    for _ in range(2):
        for _ in simulate(folder, 6, 7, leaving, here):
            pass
    entries = Ledger(folder / LEDGER).entries()
    phases = set()
    for transcript in transcripts(folder, "simulated"):
        history = read_history(transcript)
        assert history.allocated is not None
        assert history.ending == "unfinished"
        assert history.left is not None and history.left.reason == "quit"
        assert ending_of(entries, transcript.started.participant, "simulated") is None
        phases.add(history.step)
    assert len(phases) > 2


def test_most_stay(tmp_path: Path) -> None:
    folder = tmp_path / "study"
    small_study(folder)
    for _ in simulate(folder, 3, 7, POPULATIONS["default"], here):
        pass
    ended = [read_history(it).ending for it in transcripts(folder, "simulated")]
    assert ended == ["finished"] * 3


def test_whoever_is_cut_off_comes_back_and_finishes(tmp_path: Path) -> None:
    folder = tmp_path / "study"
    new_study(folder, seed=7, blocks=1)
    dropping = replace(POPULATIONS["default"], name="dropping", cut_off=1.0)
    for _ in simulate(folder, 3, 7, dropping, here):
        pass
    broken = set()
    for transcript in transcripts(folder, "simulated"):
        history = read_history(transcript)
        assert (history.ending, history.interruptions) == ("finished", 1)
        again = next(it.envelope for it in transcript.entries if it.envelope.segment == 1)
        broken.add((again.phase, again.round))
        assert verify(Path(transcript.source)).difference is None
    assert len(broken) > 1
    ledger = Ledger(folder / LEDGER).entries()
    assert ending_of(ledger, "S0001", "simulated") == "finished"
