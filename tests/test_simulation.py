"""Whole simulated studies: the same bytes for a seed wherever they are computed, complete after an
interruption, and labelled as simulated."""

from __future__ import annotations

import importlib.util
import json
import socket
from collections.abc import Sequence
from functools import partial
from pathlib import Path

import pytest

from game.cli import main
from game.errors import AnaError
from game.journal.reader import read_journal
from game.journal.records import Allocated, QuizSubmitted, SessionEnded
from game.rescuers.person import POPULATIONS, Population
from game.session.verification import verify
from game.simulation.comparison import Plan, trials
from game.simulation.contenders import contender
from game.simulation.simulated_study import Workers, names, simulate
from game.simulation.workers import Journals, SchedulerError, here, on_cluster, on_cores
from game.study.design import design_cell
from game.study.folder import Study, open_study
from game.study.ledger import SlotTaken, ending_of

SEED, PEOPLE = 5, 3
DEFAULT = POPULATIONS["default"]

needs_cluster = pytest.mark.skipif(
    importlib.util.find_spec("distributed") is None, reason="the extra `cluster` is not installed"
)


def made(folder: Path, workers: Workers = here, people: int = PEOPLE) -> Path:
    for _ in simulate(folder, people, SEED, DEFAULT, workers):
        pass
    return folder


def files(folder: Path) -> dict[str, bytes]:
    return {
        str(path.relative_to(folder)): path.read_bytes()
        for path in sorted(folder.rglob("*"))
        if path.is_file()
    }


@pytest.fixture(scope="module")
def study(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return made(tmp_path_factory.mktemp("simulated") / "study")


def test_two_processes_write_the_same_bytes_as_one(study: Path, tmp_path: Path) -> None:
    assert files(made(tmp_path / "study", partial(on_cores, jobs=2))) == files(study)


@needs_cluster
def test_a_cluster_writes_the_same_bytes(study: Path, tmp_path: Path) -> None:
    from distributed import LocalCluster

    with LocalCluster(n_workers=1, threads_per_worker=1, dashboard_address=None) as cluster:
        workers = partial(on_cluster, address=cluster.scheduler_address)
        assert files(made(tmp_path / "study", workers)) == files(study)
        compared = Plan(
            (contender("static:1"),), {"default": DEFAULT}, ("practice",), 2, 3, "choosing"
        )
        alone = trials(compared, 1, lambda _done, _of: None)
        assert trials(compared, 1, lambda _done, _of: None, cluster.scheduler_address) == alone


@needs_cluster
def test_a_missing_scheduler_is_named(tmp_path: Path) -> None:
    with socket.socket() as unused:
        unused.bind(("127.0.0.1", 0))
        port = unused.getsockname()[1]
    workers = partial(on_cluster, address=f"tcp://127.0.0.1:{port}", timeout_s=1)
    with pytest.raises(SchedulerError, match=str(port)):
        made(tmp_path / "study", workers)


def test_an_interrupted_simulation_continues(study: Path, tmp_path: Path) -> None:
    folder = tmp_path / "study"
    going = simulate(folder, PEOPLE, SEED, DEFAULT, here)
    assert [next(going), next(going)] == [0, 1]
    del going
    assert len(list(folder.rglob("journal.jsonl"))) == 1
    assert next(simulate(folder, PEOPLE, SEED, DEFAULT, here)) == 1
    assert files(made(folder)) == files(study)


def test_an_interrupt_leaves_only_complete_journals(study: Path, tmp_path: Path) -> None:
    def interrupted(study: Study, work: Sequence[SlotTaken], people: Population) -> Journals:
        yield next(here(study, work, people))
        raise KeyboardInterrupt

    folder = tmp_path / "study"
    with pytest.raises(KeyboardInterrupt):
        made(folder, interrupted)
    assert len(list(folder.rglob("journal.jsonl*"))) == 1
    assert files(made(folder)) == files(study)


def test_adding_people_leaves_earlier_ones_unchanged(study: Path, tmp_path: Path) -> None:
    more = files(made(tmp_path / "study", people=PEOPLE + 1))
    for name, data in files(study).items():
        if name.startswith("sessions"):
            assert more[name] == data


def test_journals_say_that_they_are_simulated_and_replay(study: Path) -> None:
    for name in names(PEOPLE):
        path = study / "sessions" / "simulated" / name / "journal.jsonl"
        started = read_journal(path).started
        assert started.simulated
        assert started.mode == "simulated"
        assert started.rescuer == "simulated default"
        assert started.participant == name
        assert verify(path).difference is None


def test_slots_are_those_of_the_allocation_in_the_order_of_participants(study: Path) -> None:
    entries = open_study(study).ledger.entries()
    taken = [entry for entry in entries if isinstance(entry, SlotTaken)]
    assert [slot.participant for slot in taken] == list(names(PEOPLE))
    for number, slot in enumerate(taken):
        assert slot.slot == number
        assert slot.cell == design_cell(SEED, "simulated", number)
        assert ending_of(entries, slot.participant, "simulated") == "finished"


def test_a_session_has_all_its_phases(study: Path) -> None:
    for path in study.rglob("journal.jsonl"):
        records = [entry.record for entry in read_journal(path).entries]
        quizzes = [record for record in records if isinstance(record, QuizSubmitted)]
        allocated = next(record for record in records if isinstance(record, Allocated))
        assert len(quizzes) == 2
        assert all(0 <= quiz.right <= quiz.asked == 20 for quiz in quizzes)
        assert records[-1] == SessionEnded("finished")
        items = [
            (entry["round"], entry["item"])
            for entry in map(json.loads, path.read_text().splitlines())
            if entry["type"] == "questionnaire_answer" and entry["round"]
        ]
        assert len(items) == len(set(items)) == 16
        assert allocated.memorise_ms in (60_000, 180_000)


def test_no_file_names_the_machine_or_the_folder(study: Path) -> None:
    for data in files(study).values():
        assert str(study.parent).encode() not in data
        assert socket.gethostname().encode() not in data or len(socket.gethostname()) < 4


def test_another_seed_people_or_preset_are_refused_in_a_folder(study: Path) -> None:
    refusals: list[tuple[dict[str, object], str]] = [
        ({"seed": SEED + 1}, "seed 5"),
        ({"population": POPULATIONS["hasty"]}, "simulated default"),
        ({"preset": "literal"}, "preset floodfill"),
    ]
    before = files(study)
    for change, named in refusals:
        asked = {"seed": SEED, "population": DEFAULT, "preset": None} | change
        with pytest.raises(AnaError, match=named):
            next(simulate(study, PEOPLE, workers=here, **asked))  # type: ignore[arg-type]
    assert files(study) == before


def test_the_command(study: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    folder = tmp_path / "study"
    asked = [str(folder), "--participants", "1", "--seed", "6", "--jobs", "1"]
    assert main(["simulate", *asked, "--preset", "fig10"]) == 0
    assert "1 simulated participants" in capsys.readouterr().out
    assert open_study(folder).settings.preset == "fig10"
    assert main(["simulate", *asked, "--preset", "literal"]) == 2
    assert "--preset fig10" in capsys.readouterr().err
