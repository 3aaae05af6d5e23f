"""The screens in the running program, by keys."""

from __future__ import annotations

import asyncio
import errno
from pathlib import Path
from typing import Any

import pytest
from textual.containers import VerticalScroll
from textual.pilot import Pilot
from textual.screen import Screen

from game.coach.spec import parse_coach
from game.errors import AnaError
from game.journal.clock import MissionClock
from game.journal.reader import read_journal
from game.journal.records import Paused, SessionEnded, Unpaused
from game.screens.play.app import AnaApp, run_home, run_play
from game.screens.play.free_play_screen import glossed
from game.screens.play.home import HomeScreen
from game.screens.play.journal_list import JournalsScreen
from game.screens.play.mission_screen import MissionScreen
from game.screens.play.options import PlayOptions
from game.screens.play.replay_screen import ReplayScreen
from game.screens.play.result import ResultScreen
from game.screens.play.start_screen import StartScreen
from game.screens.play.watch_screen import WatchScreen
from game.screens.widgets.canvas import Canvas, Row, width
from game.screens.widgets.dialogs import Help, Notice, Pause, Question, TooSmall
from game.screens.widgets.keyline import KeyLine
from game.screens.widgets.stillness import STILL_S
from game.world import load_building
from game.world.building import Building
from game.world.events import Acted, Action
from game.world.geometry import Heading
from game.world.reading import parse_building
from game.world.settings import MissionSettings
from tests.screens.pilots import Open, painted, press, shown, until


def showing(app: AnaApp, screen: Screen[Any]) -> bool:
    """Whether this screen is the one shown."""
    return app.screen is screen


async def test_a_key_acts_is_journalled_and_is_shown(open_app: Open) -> None:
    async with open_app(moves_per_second=100) as (_, pilot):
        mission = await until(pilot, MissionScreen)
        before = mission.view.office.rows
        await press(pilot, "left")
        acted = [e.record for e in read_journal(mission.journal).entries]
        last = [record for record in acted if isinstance(record, Acted)][-1]
        assert last.action is Action.WEST and last.position == (10, 2)
        assert mission.view.office.rows != before


@pytest.mark.parametrize(
    ("keys", "heading"),
    [("up w k", Heading.NORTH), ("right d l", Heading.EAST), ("left a h", Heading.WEST)],
)
async def test_three_sets_of_keys_do_the_same(open_app: Open, keys: str, heading: Heading) -> None:
    for key in keys.split():
        async with open_app() as (_, pilot):
            mission = await until(pilot, MissionScreen)
            await press(pilot, key)
            assert mission.live.run.mission.heading is heading


async def test_turn_controls_turn_and_offer_no_way_back(open_app: Open) -> None:
    async with open_app(controls="turn", moves_per_second=100) as (_, pilot):
        mission = await until(pilot, MissionScreen)
        await press(pilot, "left", "down")
        await asyncio.sleep(0.02)
        await press(pilot, "up")
        assert mission.live.run.mission.heading is Heading.WEST
        assert mission.live.run.mission.position == (10, 2)


async def test_the_bar_shows_the_instruction(open_app: Open) -> None:
    async with open_app() as (_, pilot):
        mission = await until(pilot, MissionScreen)
        guidance = mission.live.observation().guidance
        assert guidance is not None and guidance.text
        assert glossed(guidance.text) in shown(mission)


async def test_free_play_pauses_and_a_study_mission_does_not(open_app: Open) -> None:
    async with open_app() as (app, pilot):
        mission = await until(pilot, MissionScreen)
        await press(pilot, "p")
        assert isinstance(app.screen, Pause) and mission.live.paused
        await press(pilot, "p")
        assert showing(app, mission) and not mission.live.paused
        kinds = [type(e.record) for e in read_journal(mission.journal).entries]
        assert kinds.index(Paused) < kinds.index(Unpaused)
    async with open_app(allow_pause=False) as (app, pilot):
        mission = await until(pilot, MissionScreen)
        await press(pilot, "p")
        assert showing(app, mission)
        await press(pilot, "question_mark")
        assert isinstance(app.screen, Help) and not mission.live.paused


async def test_in_a_pause_there_is_help_and_leaving_is_asked_about(open_app: Open) -> None:
    async with open_app() as (app, pilot):
        mission = await until(pilot, MissionScreen)
        await press(pilot, "p")
        pause = app.screen
        await press(pilot, "question_mark")
        assert isinstance(app.screen, Help)
        await press(pilot, "escape")
        assert showing(app, pause)
        await press(pilot, "q")
        assert isinstance(app.screen, Question)
        await press(pilot, "n")
        assert showing(app, pause) and mission.live.paused
        kinds = [type(e.record) for e in read_journal(mission.journal).entries]
        assert kinds.count(Paused) == 1 and Unpaused not in kinds, "the clock stood still all along"
        await press(pilot, "q", "y")
        for _ in range(100):
            if app.return_code is not None:
                break
            await asyncio.sleep(0.02)
        assert app.return_code == 0


@pytest.mark.parametrize("controls", ["compass", "turn"])
async def test_the_help_fits_the_smallest_screen(open_app: Open, controls: str) -> None:
    async with open_app(controls=controls) as (app, pilot):
        await until(pilot, MissionScreen)
        await press(pilot, "question_mark")
        await pilot.pause()
        (page,) = app.screen.query(VerticalScroll)
        assert page.max_scroll_y == 0
        for canvas in app.screen.query(Canvas):
            assert max(map(width, canvas.rows)) <= canvas.size.width
            assert canvas.size.height >= len(canvas.rows)
        assert "rescued" in shown(app.screen) and "Utilize medical" in shown(app.screen)


@pytest.mark.parametrize("key", ["q", "ctrl+q", "ctrl+c", "escape"])
async def test_leaving_is_asked_about(open_app: Open, key: str) -> None:
    async with open_app() as (app, pilot):
        mission = await until(pilot, MissionScreen)
        await press(pilot, key)
        assert isinstance(app.screen, Question) and mission.live.paused
        await press(pilot, "n")
        assert showing(app, mission)
        await press(pilot, key, "y")
        for _ in range(100):
            if app.return_code is not None:
                break
            await asyncio.sleep(0.02)
        assert app.return_code == 0
        assert isinstance(read_journal(mission.journal).entries[-1].record, SessionEnded)


async def test_a_mission_left_after_something_was_done_comes_to_its_result(open_app: Open) -> None:
    async with open_app() as (_, pilot):
        await until(pilot, MissionScreen)
        await press(pilot, "up")
        await asyncio.sleep(0.3)
        await press(pilot, "q", "y")
        result = await until(pilot, ResultScreen)
        assert "Left after 0:0" in shown(result) and "steps 1" in shown(result)


async def test_the_journals_are_listed_by_what_was_played(open_app: Open, tmp_path: Path) -> None:
    async with open_app(duration_ms=1_000) as (_, pilot):
        await until(pilot, ResultScreen)
    async with open_app() as (app, pilot):
        await until(pilot, MissionScreen)
        app._choose_journal()
        journals = await until(pilot, JournalsScreen)
        await pilot.pause()
        assert "Ward · static C1 · 0 rescued" in shown(journals)


async def test_ctrl_p_opens_nothing(open_app: Open) -> None:
    async with open_app() as (app, pilot):
        mission = await until(pilot, MissionScreen)
        await press(pilot, "ctrl+p")
        assert showing(app, mission)


async def test_a_small_window_pauses_and_goes_on_when_enlarged(open_app: Open) -> None:
    async with open_app() as (_, pilot):
        mission = await until(pilot, MissionScreen)
        await pilot.resize_terminal(60, 20)
        small = await until(pilot, TooSmall)
        assert "60 x 20" in str(small.query_one("Static").render()) and mission.live.paused
        await pilot.resize_terminal(100, 30)
        assert await until(pilot, MissionScreen) is mission and not mission.live.paused
        assert mission.view.office.rows and mission.view.office.size.width > 50


async def test_a_small_window_can_be_left_and_what_was_played_is_kept(open_app: Open) -> None:
    async with open_app() as (app, pilot):
        mission = await until(pilot, MissionScreen)
        await pilot.resize_terminal(60, 20)
        await until(pilot, TooSmall)
        await press(pilot, "ctrl+c")
        await pilot.pause(0.2)
        assert app._exit
    last = read_journal(mission.journal).entries[-1].record
    assert last == SessionEnded("quit")


async def test_a_window_too_small_from_the_start(open_app: Open) -> None:
    async with open_app(size=(50, 10)) as (_, pilot):
        covered = await until(pilot, TooSmall)
        assert "Ctrl+C quits." in " ".join(painted(covered).split()), "no line is cut"
        await pilot.resize_terminal(80, 24)
        mission = await until(pilot, MissionScreen)
        await pilot.pause()
        assert any(row for row in mission.view.office.rows)


async def test_a_mission_ends_in_a_result_that_can_be_replayed(open_app: Open) -> None:
    async with open_app(duration_ms=1_000) as (app, pilot):
        await until(pilot, MissionScreen)
        result = await until(pilot, ResultScreen)
        page = shown(result)
        assert "0 of 3 rescued" in page and "The coach stayed at C1." in page
        assert result.journal.parent.name in page
        await press(pilot, "r")
        assert showing(app, result), "the first keys were meant for the mission"
        await asyncio.sleep(STILL_S + 0.1)
        await press(pilot, "r")
        replay = await until(pilot, ReplayScreen)
        await press(pilot, "space", "end")
        assert replay.replay.time_ms == 1_000
        await press(pilot, "home", "right", "q")
        assert showing(app, result)
        await press(pilot, "enter")
        await until(pilot, StartScreen)


async def test_watching_is_said_to_be_simulated_and_comes_to_a_result(open_app: Open) -> None:
    async with open_app(lambda app: app.watch_mission(app._options)) as (_, pilot):
        watch = await until(pilot, WatchScreen)
        assert "SIMULATED" in shown(watch)
        assert all(width(row) <= 80 for row in watch.query_one(KeyLine).rows)
        await press(pilot, "up", "up", "up")
        assert watch.live.pace.speed == 8
        await asyncio.sleep(1.5)
        assert watch.live.run.mission.time_ms > 4_000
        assert watch.live.run.mission.position != (11, 2)
        beside = watch.view.office.size.width
        await press(pilot, "c")
        await pilot.pause()
        assert not watch.query_one("CoachPanel").display
        assert watch.view.office.size.width > beside
        assert watch.view.minimap.size.height > 10, "the rest of the panel is the map's again"


async def test_home_enter_plays_and_choices_are_remembered(open_app: Open, tmp_path: Path) -> None:
    async with open_app(AnaApp.show_home) as (_, pilot):
        home = await until(pilot, HomeScreen)
        await press(pilot, "down", "right", "down", "right", "up", "up", "enter")
        await until(pilot, StartScreen)
        await press(pilot, "enter")
        mission = await until(pilot, MissionScreen)
        assert mission.live.run.mission.building == load_building("foundry")
        assert (home.preferences.building, home.preferences.coach) == ("foundry", "knowledge")
    async with open_app(AnaApp.show_home) as (_, pilot):
        home = await until(pilot, HomeScreen)
        assert (home.preferences.building, home.preferences.coach) == ("foundry", "knowledge")


async def test_a_full_disk_ends_the_mission_with_a_message(
    open_app: Open, monkeypatch: pytest.MonkeyPatch
) -> None:
    async with open_app() as (app, pilot):
        mission = await until(pilot, MissionScreen)

        def full(descriptor: int, lines: object) -> int:
            raise OSError(errno.ENOSPC, "No space left on device")

        with monkeypatch.context() as context:
            context.setattr("game.journal.sink.os.write", full)
            await press(pilot, "left")
        notice = await until(pilot, Notice)
        text = "\n".join(str(part.render()) for part in notice.query("Static"))
        assert "full" in text
        assert mission.journal.parent.name in text
        await press(pilot, "enter")
        assert app.return_code == 2 and app.failure is not None


async def test_an_unwritable_folder_is_told_of(
    open_app: Open, ward: Building, tmp_path: Path
) -> None:
    blocked = tmp_path / "file"
    blocked.write_text("in the way")
    options = PlayOptions(ward, parse_coach("ana"), MissionSettings(), 1, blocked)
    async with open_app(lambda app: app.play_mission(options)) as (app, pilot):
        await pilot.pause()
        assert app.return_code == 2 and isinstance(app.failure, AnaError)


def test_without_a_terminal_it_says_so(ward: Building, tmp_path: Path) -> None:
    options = PlayOptions(ward, parse_coach("ana"), MissionSettings(), 1, tmp_path)
    for run in (run_home, lambda: run_play(options)):
        with pytest.raises(AnaError, match="not a terminal"):
            run()
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("size", [(80, 24), (120, 40), (200, 60)])
async def test_the_screen_tells_nothing_but_the_observation(
    open_app: Open, ward: Building, size: tuple[int, int], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Victims and names out of sight change no character of the first picture."""
    monkeypatch.setattr(MissionClock, "now_ms", lambda _: 0)
    other = parse_building(
        ward.text.replace("*.#\n#", "o.#\n#").replace("Test Lab", "Archive"), "other"
    )
    pictures = []
    for building in (ward, other):
        async with open_app(size=size, building=building) as (_, pilot):
            mission = await until(pilot, MissionScreen)
            pictures.append(await settled(pilot, mission))
    assert pictures[0] == pictures[1]


async def settled(pilot: Pilot[None], mission: MissionScreen) -> list[list[Row]]:
    """The first picture, once the space has been divided and it changes no more."""
    view, before = mission.view, None
    while True:
        await pilot.pause()
        shown = [view.office.rows, view.minimap.rows, view.status.rows]
        if shown == before and all(shown):
            return shown
        before = shown


@pytest.mark.parametrize(
    ("size", "large"), [((80, 24), False), ((120, 40), False), ((160, 50), True), ((200, 60), True)]
)
async def test_cells_are_large_where_there_is_room(
    open_app: Open, size: tuple[int, int], large: bool
) -> None:
    async with open_app(size=size) as (_, pilot):
        mission = await until(pilot, MissionScreen)
        await settled(pilot, mission)
        office = mission.view.office
        player = [run[0] for row in office.rows for run in row if run[1] == "player"]
        assert (len(player), {len(text) for text in player}) == ((2, {4}) if large else (1, {2}))
