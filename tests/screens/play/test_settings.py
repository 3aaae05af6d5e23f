"""Settings from every screen, and keys of one's own."""

from __future__ import annotations

import asyncio
from pathlib import Path

import pytest

from game.errors import AnaError
from game.screens.play.app import AnaApp
from game.screens.play.home import HomeScreen
from game.screens.play.mission_screen import MissionScreen
from game.screens.play.settings_screen import SettingsScreen
from game.screens.play.start_screen import StartScreen
from game.screens.widgets.dialogs import Help, Question
from game.screens.widgets.keymap import TEMPLATE, USUAL, USUAL_KEYS, read_keys, write_template
from game.screens.widgets.preferences import load_preferences
from game.world.geometry import Heading
from tests.screens.pilots import Open, press, shown, until


async def test_settings_hold_at_once_and_from_one_time_to_the_next(
    open_app: Open, tmp_path: Path
) -> None:
    async with open_app(AnaApp.show_home) as (app, pilot):
        home = await until(pilot, HomeScreen)
        await press(pilot, "f2")
        settings = await until(pilot, SettingsScreen)
        dialog = settings.query_one(".dialog").region
        left, above = dialog.x, dialog.y
        assert left > 5 and above > 0, "in the middle of the window"
        assert abs(80 - dialog.right - left) <= 1 and abs(24 - dialog.bottom - above) <= 1
        await press(
            pilot, "right", "right", "down", "right", "down", "down", "right", "down", "right"
        )
        assert app.theme == "ana-light-256"
        await press(pilot, "escape")
        assert app.screen is home and "← → turn" in shown(home)
        await press(pilot, "p")
        await until(pilot, StartScreen)
        await press(pilot, "x")
        mission = await until(pilot, MissionScreen)
        assert mission.live.settings.controls == "turn"
        assert not mission.view.bar.flashes
    kept = load_preferences(tmp_path / "home.json")
    assert (kept.ground, kept.controls, kept.bell, kept.still) == ("light", "turn", True, True)


async def test_over_a_mission_settings_stop_its_clock(open_app: Open) -> None:
    async with open_app() as (app, pilot):
        mission: MissionScreen = await until(pilot, MissionScreen)
        await press(pilot, "f2")
        await until(pilot, SettingsScreen)
        assert mission.live.paused
        await press(pilot, "escape")
        assert app.screen is mission
        assert not mission.live.paused
        await press(pilot, "p", "f2")
        await until(pilot, SettingsScreen)
        await press(pilot, "escape", "p")
        assert app.screen is mission


async def test_the_bell_rings_only_where_it_is_wanted(
    open_app: Open, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    for wanted in ("false", "true"):
        (tmp_path / "home.json").write_text(f'{{"bell":{wanted}}}')
        rung: list[bool] = []
        monkeypatch.setattr(AnaApp, "bell", lambda _self, rung=rung: rung.append(True))
        async with open_app() as (_, pilot):
            await until(pilot, MissionScreen)
        assert bool(rung) is (wanted == "true")


async def test_keys_of_ones_own_act_and_are_shown(open_app: Open, tmp_path: Path) -> None:
    (tmp_path / "keys.toml").write_text(
        'up = "i"\ndown = "k"\nleft = ["j", "left"]\nright = "l"\ntreat = "t"\nleave = ["x"]\n'
    )
    async with open_app(moves_per_second=100, level_key=True) as (app, pilot):
        mission = await until(pilot, MissionScreen)
        headings = []
        for keys in ("j", "I", "w up d"):
            await press(pilot, *keys.split())
            await asyncio.sleep(0.02)
            headings.append(mission.live.run.mission.heading)
        assert headings == [Heading.WEST, Heading.NORTH, Heading.NORTH], "the usual are no keys"
        page = shown(mission)
        assert " I K J L " in page and " T " in page and "(t)." in page
        await press(pilot, "question_mark")
        assert isinstance(app.screen, Help) and " I K J L " in shown(app.screen)
        await press(pilot, "escape", "x")
        assert isinstance(app.screen, Question)
        await press(pilot, "n", "escape")
        assert isinstance(app.screen, Question), "there is always a way out"


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ('hop = "x"', "nothing called 'hop'"),
        ('tret = "x"', "Did you mean treat"),
        ("treat = 3", "must be a key or a list of keys"),
        ("treat = []", "must be a key or a list of keys"),
        ('treat = "ctrl+hop"', "there is no key 'ctrl+hop'"),
        ('treat = "p"', "given to treat and to pause"),
        ('up = "i"\ndown = "I"', "given to up and to down"),
        ('treat = "escape"', "given to"),
        ("treat = ", "cannot be read"),
    ],
)
def test_a_mistake_in_the_keys_names_the_file(tmp_path: Path, text: str, told: str) -> None:
    path = tmp_path / "keys.toml"
    path.write_text(text)
    with pytest.raises(AnaError, match=r"keys\.toml") as caught:
        read_keys(path)
    assert told in str(caught.value)


def test_the_file_to_be_edited_changes_nothing_by_itself(tmp_path: Path) -> None:
    path = tmp_path / "new" / "keys.toml"
    assert read_keys(path) == USUAL_KEYS
    write_template(path)
    assert path.read_text() == TEMPLATE and read_keys(path).bindings == {}
    told = "\n".join(line.removeprefix("# ") for line in TEMPLATE.splitlines()[4:])
    path.write_text(told)
    write_template(path)
    assert set(read_keys(path).changed) == set(USUAL)
