"""An upgrade of the program while it runs: a mission does not notice, and what fails is told."""

from __future__ import annotations

import os
import sys
from pathlib import Path

import pytest

from game.screens.widgets import program
from tests.terminal import Terminal

_NOTHING_MORE = """
import os, sys

class Gone:
    def find_spec(self, name, path=None, target=None):
        if os.path.exists(os.environ["GONE"]):
            raise ImportError(f"{name} is gone")

sys.meta_path.insert(0, Gone())
"""


def test_a_mission_its_result_and_its_replay_import_nothing_more(tmp_path: Path) -> None:
    gone = tmp_path / "gone"
    (tmp_path / "sitecustomize.py").write_text(_NOTHING_MORE)
    paths = os.pathsep.join(filter(None, (str(tmp_path), os.environ.get("PYTHONPATH", ""))))
    env = {"PYTHONPATH": paths, "GONE": str(gone), "XDG_CONFIG_HOME": str(tmp_path)}
    command = [sys.executable, "-m", "game", "play", "--building", "practice", "--minutes", "0.02"]
    with Terminal([*command, "--log", tmp_path / "log", "--coach", "static"], env=env) as terminal:
        terminal.wait_for("Press any key to start")
        terminal.read_for(1.5)
        gone.touch()
        for key, shows in (
            ("x", "0 rescued"),
            ("?", "What you see"),
            ("q", "play again"),
            ("\x1bOQ", "Settings"),
            ("q", "play again"),
        ):
            terminal.press(key)
            terminal.wait_for(shows)
            terminal.read_for(0.2)
        terminal.read_for(0.6)
        for key, shows in (("c", "card.svg"), ("q", "play again"), ("r", "speed")):
            terminal.press(key)
            terminal.wait_for(shows)
        terminal.press("q")
        terminal.read_for(0.8)
        terminal.press("h")
        terminal.wait_for("Mission of the day")
        terminal.press("q")
        assert terminal.wait() == 0


def test_what_could_not_be_imported_is_told_in_plain_words(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(program, "reports_folder", lambda: tmp_path)
    status = program.report(ModuleNotFoundError("No module named 'game.elsewhere'"))
    told = capsys.readouterr().err
    assert status and "changed while it ran" in told and "is saved" in told
    assert "game.elsewhere" in next(tmp_path.glob("fault-*.txt")).read_text()
