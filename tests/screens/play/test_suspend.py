"""Ctrl+Z: the clock stops, and the shell has its terminal back until it continues the game."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

from game.journal.reader import read_journal
from game.journal.records import Paused, Unpaused
from game.screens.play.mission_screen import MissionScreen
from game.screens.widgets.dialogs import Pause
from tests.screens.pilots import Open, press, until
from tests.terminal import Terminal

SHELL = ("bash", "--norc", "--noprofile", "-i")


def test_the_shell_is_given_the_terminal_and_continues_the_game(tmp_path: Path) -> None:
    command = f"'{sys.executable}' -m game play --now --building practice --coach static"
    with Terminal(SHELL, env={"PS1": "ready> ", "XDG_CONFIG_HOME": str(tmp_path)}) as terminal:
        terminal.wait_for("ready>")
        terminal.press(f"{command} --log '{tmp_path}'", "enter")
        terminal.wait_for("facing")
        terminal.write(b"\x1a")
        terminal.wait_for("Stopped")
        terminal.press("echo still $((40 + 2))", "enter")
        terminal.wait_for("still 42")
        terminal.press("fg", "enter")
        terminal.wait_for("The clock is stopped.")
        terminal.press("p")
        terminal.wait_for("facing")
        terminal.press("q")
        terminal.wait_for("Leave the mission?")
        terminal.press("y")
        terminal.wait_for("ready>")
    (path,) = tmp_path.glob("*/journal.jsonl")
    entries = read_journal(path).entries
    (paused,) = [entry for entry in entries if isinstance(entry.record, Paused)][:1]
    resumed = next(entry for entry in entries if isinstance(entry.record, Unpaused))
    assert isinstance(paused.record, Paused) and isinstance(resumed.record, Unpaused)
    assert paused.record.at_ms == resumed.record.at_ms
    assert resumed.envelope.t_ms > paused.envelope.t_ms


async def test_without_a_shell_it_only_pauses(
    open_app: Open, monkeypatch: pytest.MonkeyPatch
) -> None:
    stopped: list[bool] = []
    monkeypatch.setattr("game.screens.play.app.has_job_control", lambda: False)
    monkeypatch.setattr("game.screens.play.app.suspend_group", lambda: stopped.append(True))
    async with open_app() as (_, pilot):
        await until(pilot, MissionScreen)
        await press(pilot, "ctrl+z")
        await until(pilot, Pause)
        await pilot.pause()
    assert not stopped
