"""`ana study demo`: a study half-way through, as an experimenter would look at it."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from game.cli import main
from game.simulation.demonstration import UNDER_WAY

FINISHED = 1


@pytest.fixture(scope="module")
def demo(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("demo") / "study"
    count = str(len(UNDER_WAY) + FINISHED)
    assert main(["study", "demo", str(folder), "--participants", count]) == 0
    return folder


def test_the_status_shows_who_is_where(demo: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["study", "status", str(demo), "--json"]) == 0
    told = json.loads(capsys.readouterr().out)
    assert told["hindrances"] == []
    sessions = told["sessions"]
    assert {it["mode"] for it in sessions} == {"simulated"}
    states = [it["state"] for it in sessions]
    assert states == ["finished"] * FINISHED + ["cut off"] * len(UNDER_WAY)
    assert {it["phase"] for it in sessions[FINISHED:]} == {step.phase for step in UNDER_WAY}


def test_it_verifies_exports_and_is_checked(
    demo: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["verify", str(demo)]) == 0
    out = str(tmp_path / "dataset")
    assert main(["study", "export", str(demo), out, "--mode", "simulated"]) == 0
    assert f"simulated sessions {len(UNDER_WAY) + FINISHED}" in capsys.readouterr().out


def test_a_folder_that_holds_something_is_refused(
    demo: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["study", "demo", str(demo)]) == 2
    assert "the folder is not empty" in capsys.readouterr().err
