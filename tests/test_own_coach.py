"""The examples of docs/write-your-own-coach.md work as they stand."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from game.coach.spec import parse_coach
from game.errors import AnaError
from game.rescuers.catalogue import character
from game.rescuers.driver import drive
from game.rescuers.literal import LiteralReader
from game.session.playing import start_in_memory
from game.session.verification import verify
from game.world import load_building
from game.world.settings import MissionSettings

PAGE = Path(__file__).parents[1] / "docs" / "write-your-own-coach.md"
EXAMPLE, GUIDED, COMPARISON = re.findall(r"```python\n(.*?)```", PAGE.read_text(), re.DOTALL)


@pytest.fixture(autouse=True)
def _in_a_folder_with_the_example(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "nearest.py").write_text(EXAMPLE)
    (tmp_path / "patient.py").write_text(GUIDED)
    monkeypatch.chdir(tmp_path)


def test_the_example_coaches_a_mission_that_verifies(tmp_path: Path) -> None:
    building, settings = load_building("practice"), MissionSettings()
    spec = parse_coach("nearest.py:NearestCoach")
    path = tmp_path / "journal.jsonl"
    run, journal = start_in_memory(building, settings, spec, 1, rescuer="literal", path=path)
    drive(run, LiteralReader("compass", {room.name: room.label for room in building.rooms}))
    journal.close()
    assert run.mission.rescued == len(building.victims)
    assert verify(path).reproduced
    (tmp_path / "nearest.py").write_text(EXAMPLE + "\n")
    changed = verify(path)
    assert not changed.reproduced
    assert "has changed since the mission" in str(changed.difference)


def test_a_coach_on_the_guide_loads_with_dataclasses_and_postponed_annotations(
    tmp_path: Path,
) -> None:
    spec = parse_coach("patient.py:PatientCoach")
    path = tmp_path / "journal.jsonl"
    building, settings = load_building("harbour"), MissionSettings()
    run, journal = start_in_memory(building, settings, spec, 1, rescuer="literal", path=path)
    drive(run, character("stranger").make(building, settings, 1))
    journal.close()
    text = path.read_text()
    assert '"level_changed"' in text
    assert '"comprehension":null' in text
    assert verify(path).reproduced


def test_the_comparison_runs_and_ana_plans_better(capsys: pytest.CaptureFixture[str]) -> None:
    exec(compile(COMPARISON, str(PAGE), "exec"), {})
    rescued = dict(line.rsplit(" ", 1) for line in capsys.readouterr().out.splitlines())
    assert int(rescued["ana"]) > int(rescued["nearest.py:NearestCoach"]) > 0


def test_the_example_is_as_long_as_it_says() -> None:
    body = EXAMPLE[EXAMPLE.index("class NearestCoach") :]
    assert len([line for line in body.splitlines() if line.strip()]) <= 30


@pytest.mark.parametrize(
    ("source", "told"),
    [
        ("nowhere.py:Coach", "cannot be read"),
        ("nearest.py:NearestCoch", "Did you mean NearestCoach"),
        ("nearest.py:Level", "cannot be made"),
        ("broken.py:Coach", "cannot be run"),
        ("idle.py:Idle", "lacks guidance"),
    ],
)
def test_a_bad_coach_is_told_with_its_hint(tmp_path: Path, source: str, told: str) -> None:
    (tmp_path / "broken.py").write_text("1 / 0")
    (tmp_path / "idle.py").write_text("class Idle:\n    def __init__(self, briefing): pass\n")
    building = load_building("practice")
    with pytest.raises(AnaError, match=told):
        start_in_memory(building, MissionSettings(), parse_coach(source), 1, rescuer="literal")
