"""The mouse works on menus, and its reports are nothing elsewhere; help is everywhere."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

from game.screens.play.app import AnaApp
from game.screens.play.home import HomeScreen
from game.screens.play.journal_list import JournalsScreen
from game.screens.play.lesson_screen import LessonScreen
from game.screens.play.map_screen import MapScreen
from game.screens.play.result import ResultScreen
from game.screens.widgets.dialogs import Help
from game.screens.widgets.terminal_driver import CLICKS_OFF, CLICKS_ON
from tests.screens.pilots import Open, press, until
from tests.terminal import Terminal


def click(terminal: Terminal, text: str) -> None:
    """Click where `text` stands on the screen."""
    row, line = next(
        (row, line) for row, line in enumerate(terminal.text().splitlines()) if text in line
    )
    at = f"{line.index(text) + 1};{row + 1}"
    terminal.write(f"\x1b[<0;{at}M\x1b[<0;{at}m".encode())


def sent(terminal: Terminal) -> str:
    return b"".join(chunk.data for chunk in terminal.chunks).decode(errors="replace")


def test_menus_take_clicks_and_a_mission_takes_none(tmp_path: Path) -> None:
    env = {"XDG_CONFIG_HOME": str(tmp_path)}
    with Terminal([sys.executable, "-m", "game"], env=env) as terminal:
        terminal.wait_for("Mission of the day")
        terminal.read_for(0.3)
        click(terminal, "difficulty")
        terminal.wait_for("‹ hard ›")
        click(terminal, "Settings")
        terminal.wait_for("Bell")
        click(terminal, "Bell")
        terminal.wait_for("rings at new words")
        terminal.press("escape")
        terminal.wait_for("Mission of the day")
        click(terminal, "Play")
        terminal.wait_for("Press any key to start.")
        terminal.read_for(0.3)
        assert sent(terminal).rindex(CLICKS_OFF) > sent(terminal).rindex(CLICKS_ON)
        terminal.write(b"\x1b[<0;10;10M\x1b[<0;10;10m")
        terminal.read_for(0.4)
        assert "Press any key to start." in terminal.text()


def test_the_mouse_is_given_back(tmp_path: Path) -> None:
    env = {"XDG_CONFIG_HOME": str(tmp_path)}
    with Terminal([sys.executable, "-m", "game"], env=env) as terminal:
        terminal.wait_for("Mission of the day")
        terminal.read_for(0.3)
        assert CLICKS_ON in sent(terminal)
        click(terminal, "Quit")
        assert terminal.wait() == 0
        assert sent(terminal).rindex(CLICKS_OFF) > sent(terminal).rindex(CLICKS_ON)


@pytest.mark.parametrize(
    "kind", [HomeScreen, JournalsScreen, LessonScreen, MapScreen, ResultScreen]
)
async def test_there_is_help_on_every_screen(open_app: Open, kind: type) -> None:
    async with open_app(AnaApp.show_home, duration_ms=1_000) as (app, pilot):
        home = await until(pilot, HomeScreen)
        if kind is JournalsScreen:
            app._choose_journal()
        elif kind is LessonScreen:
            app.teach()
        elif kind is MapScreen:
            home._select("memorise")
            await press(pilot, "right", "p")
        elif kind is ResultScreen:
            app.play_mission(app._chosen())
        screen = await until(pilot, kind)
        await press(pilot, "question_mark")
        assert isinstance(app.screen, Help) or type(app.screen).__name__ == "HowToScreen"
        await press(pilot, "escape")
        assert app.screen is screen
