"""The screens in the running program, by keys."""

from __future__ import annotations

import asyncio
import errno
from collections.abc import Callable
from contextlib import AbstractAsyncContextManager
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from msgspec import structs
from textual import events
from textual.containers import VerticalScroll
from textual.pilot import Pilot
from textual.screen import Screen

from game.coach.records import InstructionIssued, Level, LevelChanged
from game.coach.spec import CoachSpec, parse_coach
from game.errors import AnaError
from game.screens.app import AnaApp, PlayOptions, run_home, run_play
from game.screens.canvas import Canvas, plain, width
from game.screens.charts import Step
from game.screens.dialogs import Help, Notice, Pause, Question, TooSmall
from game.screens.home import HomeScreen
from game.screens.journals import JournalsScreen
from game.screens.keyline import KeyLine
from game.screens.minimap import QUARTER_BLOCKS, MiniMap, map_size
from game.screens.mission import MissionScreen
from game.screens.replay import ReplayScreen, timeline_rows
from game.screens.result import ResultScreen, result_rows
from game.screens.story import tell
from game.screens.watch import WatchScreen
from game.session.play import begin_mission, end_free_play, start_in_memory
from game.session.reader import read_journal
from game.session.records import MissionAbandoned, Paused, SessionEnded, Unpaused
from game.session.replay import Replay
from game.session.run import RunRecord
from game.world import load_building
from game.world.building import Building
from game.world.events import Acted, Action, Expired, Rescued
from game.world.geometry import Heading
from game.world.reading import parse_building
from game.world.settings import MissionSettings
from tests.screens.pilots import until

Open = Callable[..., AbstractAsyncContextManager[tuple[AnaApp, Pilot[None]]]]


async def press(pilot: Pilot[None], *keys: str) -> None:
    """Press keys as the terminal would send them: quicker than `pilot.press`."""
    for key in keys:
        character = " " if key == "space" else key if len(key) == 1 else None
        pilot.app.post_message(events.Key(key, character))
        await pilot.pause()


def showing(app: AnaApp, screen: Screen[Any]) -> bool:
    """Whether this screen is the one shown."""
    return app.screen is screen


def shown(screen: Screen[Any]) -> str:
    """All that the canvases of a screen show."""
    return "\n".join(line for canvas in screen.query(Canvas) for line in plain(canvas.rows))


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
        assert guidance.text in shown(mission)


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
        assert "came too late" in shown(app.screen) and "Utilize medical" in shown(app.screen)


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


def write_two_missions(folder: Path, ward: Building, coach: CoachSpec | None = None) -> Path:
    """A journal of two missions, the first of C1, or of `coach`, and the second of C2."""
    path, settings = folder / "journal.jsonl", MissionSettings()
    spec = coach or parse_coach("static", 1)
    first, journal = start_in_memory(ward, settings, spec, 1, rescuer="literal", path=path)
    first.advance(1_000)
    journal.append(MissionAbandoned(1_000, "quit"))
    second = begin_mission(journal, ward, settings, parse_coach("static", 2), 2)
    second.advance(1_000)
    end_free_play(second, journal, 1_000)
    return path


async def test_a_replay_steps_through_the_missions_of_a_journal(
    open_app: Open, tmp_path: Path, ward: Building
) -> None:
    written = write_two_missions(tmp_path, ward)
    async with open_app(lambda app: app.replay(written)) as (_, pilot):
        replay = await until(pilot, ReplayScreen)
        assert "static C1" in shown(replay) and "1/2" in shown(replay)
        await press(pilot, "left_square_bracket", "right_square_bracket")
        await pilot.pause()
        replay = await until(pilot, ReplayScreen)
        assert "static C2" in shown(replay) and "2/2" in shown(replay)
        await press(pilot, "right_square_bracket")
        assert await until(pilot, ReplayScreen) is replay, "there is no third mission"


@pytest.mark.parametrize(("columns", "rows"), [(77, 22), (117, 38), (197, 58)])
def test_both_charts_stand_on_the_first_page_and_use_its_height(
    tmp_path: Path, ward: Building, columns: int, rows: int
) -> None:
    replay = Replay(read_journal(write_two_missions(tmp_path, ward)))
    replay.seek(replay.duration_ms)
    story = replace(tell(replay), levels=(Step(0, 2), Step(500, 3)))
    lines = plain(result_rows(story, columns, rows, filled=True))
    titles = [i for i, line in enumerate(lines) if "Rescued" in line or "Level of the" in line]
    assert len(titles) == 2 and rows - 18 <= len(lines) <= rows
    assert "Left after 0:01" in lines[2]
    assert [line.split()[0] for line in lines if "Test Lab" in line][-1] == "●", "still waiting"


@pytest.mark.parametrize(("columns", "rows"), [(77, 22), (117, 38), (197, 58)])
def test_a_level_that_never_changed_is_told_in_words(
    tmp_path: Path, ward: Building, columns: int, rows: int
) -> None:
    replay = Replay(read_journal(write_two_missions(tmp_path, ward)))
    replay.seek(replay.duration_ms)
    lines = plain(result_rows(tell(replay), columns, rows, filled=True))
    assert sum("The coach stayed at C1." in line for line in lines) == 1
    assert not any("Level of the coach" in line for line in lines)
    assert len(lines) <= rows and sum("Test Lab" in line for line in lines) >= 1
    assert all(len(line.rstrip()) <= columns for line in lines)


def test_only_new_words_count_as_instructions(tmp_path: Path, ward: Building) -> None:
    replay = Replay(read_journal(write_two_missions(tmp_path, ward)))
    replay.seek(replay.duration_ms)
    issued = [r for r in replay.records if isinstance(r, InstructionIssued)]
    assert tell(replay).instructions == 1 == len(issued)

    class Repeated(Replay):
        @property
        def records(self) -> tuple[RunRecord, ...]:
            others = structs.replace(issued[0], text="Something else.")
            return (*super().records, issued[0], others, others, issued[0])

    repeated = Repeated(read_journal(tmp_path / "journal.jsonl"))
    repeated.seek(repeated.duration_ms)
    assert tell(repeated).instructions == 3


async def test_beside_a_coach_that_infers_nothing_nothing_is_awaited(
    open_app: Open, tmp_path: Path, ward: Building
) -> None:
    static = write_two_missions(tmp_path, ward)
    async with open_app(lambda app: app.replay(static)) as (_, pilot):
        replay = await until(pilot, ReplayScreen)
        assert "does not use P(g*)" in shown(replay) and "Walking to" not in shown(replay)
    (tmp_path / "ana").mkdir()
    adaptive = write_two_missions(tmp_path / "ana", ward, parse_coach("ana"))
    async with open_app(lambda app: app.replay(adaptive)) as (_, pilot):
        replay = await until(pilot, ReplayScreen)
        assert "P(g*) not evaluated yet" in shown(replay) and "Walking to" in shown(replay)


def test_on_the_time_line_a_victim_lost_is_never_hidden(tmp_path: Path, ward: Building) -> None:
    lost, saved = Expired(900, "v01"), Rescued(900, "v02")

    class Eventful(Replay):
        @property
        def highlights(self) -> tuple[Rescued | Expired | LevelChanged, ...]:
            return lost, saved, LevelChanged(900, Level.C2, Level.C1, 0.1)

    replay = Eventful(read_journal(write_two_missions(tmp_path, ward)))
    line = plain(timeline_rows(replay, 80, playing=False, speed=1))[2]
    assert "✗" in line and "✓" not in line and "◆" not in line


async def test_the_replay_says_what_space_does_now(
    open_app: Open, tmp_path: Path, ward: Building
) -> None:
    written = write_two_missions(tmp_path, ward)
    async with open_app(lambda app: app.replay(written)) as (_, pilot):
        replay = await until(pilot, ReplayScreen)
        assert " Space  stop" in shown(replay) and "▶ playing" in shown(replay)
        await press(pilot, "space")
        assert " Space  play" in shown(replay) and "■ stopped" in shown(replay)


async def test_the_whole_building_is_on_the_map_of_a_replay(open_app: Open, tmp_path: Path) -> None:
    harbour = load_building("harbour")
    written = write_two_missions(tmp_path, harbour)
    for size in ((120, 40), (160, 50)):
        async with open_app(lambda app: app.replay(written), size=size) as (_, pilot):
            replay = await until(pilot, ReplayScreen)
            await pilot.pause()
            columns, rows = map_size(harbour.plan, QUARTER_BLOCKS)
            shown_map = replay.query_one(MiniMap)
            assert shown_map.size.width >= columns and shown_map.size.height >= rows


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


async def test_a_window_too_small_from_the_start(open_app: Open) -> None:
    async with open_app(size=(50, 10)) as (_, pilot):
        await until(pilot, TooSmall)
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
        assert "journal.jsonl" in page
        await press(pilot, "r")
        assert showing(app, result), "the first keys were meant for the mission"
        await asyncio.sleep(0.9)
        await press(pilot, "r")
        replay = await until(pilot, ReplayScreen)
        await press(pilot, "space", "end")
        assert replay.replay.time_ms == 1_000
        await press(pilot, "home", "right", "q")
        assert showing(app, result)
        await press(pilot, "enter")
        await until(pilot, MissionScreen)


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
        mission = await until(pilot, MissionScreen)
        assert mission.live.run.mission.building == load_building("foundry")
        assert (home.preferences.building, home.preferences.coach) == ("foundry", "static-1")
    async with open_app(AnaApp.show_home) as (_, pilot):
        home = await until(pilot, HomeScreen)
        assert (home.preferences.building, home.preferences.coach) == ("foundry", "static-1")


async def test_a_full_disk_ends_the_mission_with_a_message(
    open_app: Open, monkeypatch: pytest.MonkeyPatch
) -> None:
    async with open_app() as (app, pilot):
        mission = await until(pilot, MissionScreen)

        def full(descriptor: int, lines: object) -> int:
            raise OSError(errno.ENOSPC, "No space left on device")

        with monkeypatch.context() as context:
            context.setattr("game.session.sink.os.write", full)
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
    open_app: Open, ward: Building, size: tuple[int, int]
) -> None:
    """Victims and names out of sight change no character of the first picture."""
    other = parse_building(
        ward.text.replace("*.#\n#", "o.#\n#").replace("Test Lab", "Archive"), "other"
    )
    pictures = []
    for building in (ward, other):
        async with open_app(size=size, building=building) as (_, pilot):
            mission = await until(pilot, MissionScreen)
            view = mission.view
            pictures.append([view.office.rows, view.minimap.rows, view.status.rows])
    assert pictures[0] == pictures[1]
