"""The first minute: the page before a mission, and the keys at its foot."""

from __future__ import annotations

import asyncio
from dataclasses import replace
from datetime import UTC, datetime
from pathlib import Path
from time import monotonic

import pytest

from game.coach.spec import parse_coach
from game.journal.history import read_history
from game.journal.reader import read_journal
from game.journal.records import Paused
from game.rescuers.driver import drive
from game.rescuers.literal import LiteralReader
from game.screens.play.app import AnaApp
from game.screens.play.free_play_screen import (
    DIED_MS,
    Gloss,
    Repeats,
    deaths_told,
    glossed,
    mission_keys,
)
from game.screens.play.home import BUILDINGS, HomeScreen, menu_items
from game.screens.play.map_screen import MapScreen
from game.screens.play.menu import menu_rows
from game.screens.play.mission_screen import MissionScreen
from game.screens.play.options import PlayOptions
from game.screens.play.start_screen import StartScreen
from game.screens.widgets.canvas import plain, width
from game.screens.widgets.dialogs import Help, TooSmall
from game.screens.widgets.keyline import KeyLine
from game.screens.widgets.preferences import Preferences
from game.screens.widgets.statuspanel import status_rows
from game.session.playing import start_in_memory
from game.world import load_building
from game.world.building import Building
from game.world.events import Acted, Action
from game.world.observation import Guidance
from game.world.settings import FREE_PLAY, MissionSettings
from game.world.variant import Variant, day_seed, varied
from tests.screens.pilots import Open, painted, press, shown, until


def offered(app: AnaApp) -> None:
    assert app._options is not None
    app.offer_mission(app._options)


async def test_before_a_mission_stands_what_it_is_about(open_app: Open, tmp_path: Path) -> None:
    async with open_app(offered) as (_, pilot):
        card = await until(pilot, StartScreen)
        page = painted(card)
        for words in ("Ward", "3 people", "2 red", "1 blue", "4:00", "yellow bar", "Space"):
            assert words in page
        assert not list(tmp_path.glob("*/journal.jsonl")), "nothing has begun"


@pytest.mark.parametrize("key", ["up", "space", "x", "enter", "f5"])
async def test_the_clock_starts_with_the_first_key(open_app: Open, key: str) -> None:
    async with open_app(offered) as (_, pilot):
        await until(pilot, StartScreen)
        await asyncio.sleep(0.3)
        pressed_s = monotonic()
        await press(pilot, key)
        mission = await until(pilot, MissionScreen)
        assert mission.live.observation().time_ms <= 1000 * (monotonic() - pressed_s)
        kinds = [type(e.record) for e in read_journal(mission.journal).entries]
        assert Paused not in kinds and Acted not in kinds


async def test_help_and_back_are_no_start(open_app: Open, tmp_path: Path) -> None:
    async with open_app(AnaApp.show_home) as (app, pilot):
        await until(pilot, HomeScreen)
        await press(pilot, "enter")
        card = await until(pilot, StartScreen)
        await press(pilot, "question_mark")
        assert isinstance(app.screen, Help)
        await press(pilot, "escape")
        assert app.screen is card
        await press(pilot, "q")
        await until(pilot, HomeScreen)
        assert not list(tmp_path.glob("*/journal.jsonl"))


async def test_from_the_command_line_back_quits_and_a_bad_folder_ends_with_status_2(
    open_app: Open, ward: Building, tmp_path: Path
) -> None:
    async with open_app(offered) as (app, pilot):
        await until(pilot, StartScreen)
        await press(pilot, "escape")
        assert app.return_code == 0
    blocked = tmp_path / "file"
    blocked.write_text("in the way")
    options = PlayOptions(ward, parse_coach("ana"), MissionSettings(), 1, blocked)
    async with open_app(lambda app: app.offer_mission(options)) as (app, pilot):
        await until(pilot, StartScreen)
        await press(pilot, "enter")
        await pilot.pause()
        assert app.return_code == 2 and app.failure is not None


@pytest.mark.parametrize("controls", ["compass", "turn"])
async def test_the_keys_stand_at_the_foot_of_the_smallest_window(
    open_app: Open, controls: str
) -> None:
    rules = {"controls": controls, "level_key": True}
    async with open_app(**rules) as (_, pilot):
        mission = await until(pilot, MissionScreen)
        line = mission.query_one(KeyLine)
        assert (line.region.y, line.region.height) == (23, 1)
        assert width(line.rows[0]) - 2 <= 80
        for key, does in mission_keys(mission.live.settings)[:4]:
            assert f" {key}  {does}" in shown(mission)


def test_only_keys_that_do_something_are_named() -> None:
    named = dict(mission_keys(FREE_PLAY))
    assert set(named) == {"↑↓←→", "Space", "?", "Q", "P", "+ -"}
    assert "P" not in dict(mission_keys(MissionSettings(allow_pause=False)))
    assert "+ -" not in dict(mission_keys(MissionSettings()))


async def test_the_bar_names_the_key(open_app: Open) -> None:
    async with open_app() as (_, pilot):
        mission = await until(pilot, MissionScreen)
        assert "Utilize medical equipment (space)." in shown(mission)


def test_the_key_is_named_until_it_was_used_once(ward: Building) -> None:
    run, _ = start_in_memory(
        ward, MissionSettings(), parse_coach("static", 1), 1, rescuer="literal"
    )
    gloss = Gloss()

    def bar() -> str:
        guidance = gloss.of(run.observation()).guidance
        assert guidance is not None
        return guidance.text

    for step in range(6):
        assert "(space)" in bar()
        run.press(Action.EAST, 200 * step)
    run.press(Action.TRIAGE, 1_200)
    assert "(space)" in bar(), "what stands there is not said anew"
    run.advance(8_000)
    assert run.mission.rescued == 1
    assert "Utilize medical equipment." in bar() and "(space)" not in bar()


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("Turn left.", "Turn left."),
        ("Stop. Utilize medical equipment.", "Stop. Utilize medical equipment (space)."),
        ("Approach and save the red victim.", "Approach and save the red victim (space)."),
        ("Triage the blue victim.", "Triage the blue victim (space)."),
        ("Go to the Triage Room.", "Go to the Triage Room."),
    ],
)
def test_every_way_of_asking_for_the_key_is_explained(text: str, told: str) -> None:
    assert glossed(text) == told


def with_map(app: AnaApp) -> None:
    assert app._options is not None
    app.offer_mission(replace(app._options, memorise_ms=600))


async def test_a_map_first_goes_by_itself_and_is_recorded(open_app: Open) -> None:
    async with open_app(with_map) as (_, pilot):
        await until(pilot, StartScreen)
        await press(pilot, "space")
        mission = await until(pilot, MissionScreen)
        played = read_history(read_journal(mission.journal)).missions[0]
        assert played.started.memorised_ms == 600
        assert mission.live.observation().time_ms < 1_000


async def test_the_map_can_be_left_early_and_its_time_stands_still_when_covered(
    open_app: Open, ward: Building
) -> None:
    def first(app: AnaApp) -> None:
        assert app._options is not None
        app.offer_mission(replace(app._options, memorise_ms=3_600_000, now=True))

    async with open_app(first, building=load_building("harbour")) as (_, pilot):
        page = await until(pilot, MapScreen)
        assert "Archive" in painted(page) and "Board Room" in painted(page)
        frame = page.query_one(".map")
        await press(pilot, "down", "down", "right")
        assert frame.scroll_y > 0 and frame.scroll_x > 0, "it is larger than the window"
        await pilot.resize_terminal(60, 20)
        await until(pilot, TooSmall)
        before = page._clock.now_ms()
        await asyncio.sleep(0.05)
        assert page._clock.now_ms() == before
        await pilot.resize_terminal(80, 24)
        await until(pilot, MapScreen)
        await press(pilot, "enter")
        mission = await until(pilot, MissionScreen)
        played = read_history(read_journal(mission.journal)).missions[0]
        assert 0 < played.started.memorised_ms < 3_600_000


async def test_back_from_the_map_begins_nothing(open_app: Open, tmp_path: Path) -> None:
    async with open_app(AnaApp.show_home) as (_, pilot):
        home = await until(pilot, HomeScreen)
        home._select("memorise")
        await press(pilot, "right")
        assert home.preferences.memorise == 60
        await press(pilot, "p")
        await until(pilot, MapScreen)
        await press(pilot, "escape")
        await until(pilot, HomeScreen)
        assert not list(tmp_path.glob("*/journal.jsonl"))


async def test_a_seed_is_typed_at_home_and_shown_before_the_mission(open_app: Open) -> None:
    async with open_app(AnaApp.show_home) as (app, pilot):
        home = await until(pilot, HomeScreen)
        await press(pilot, "down", "left")
        assert home.preferences.building == "generated"
        await press(pilot, "1", "2", "3", "backspace", "enter")
        card = await until(pilot, StartScreen)
        assert "Seed 12" in painted(card)
        options = app._options
        assert options is not None and options.building == load_building("generated:12")
        after = options.again()
        assert after.building == load_building("generated:13") and after.about == "Seed 13"


async def test_people_and_difficulty_are_chosen_at_home(open_app: Open) -> None:
    async with open_app(AnaApp.show_home) as (app, pilot):
        home = await until(pilot, HomeScreen)
        for action in ("victims", "difficulty"):
            home._select(action)
            await press(pilot, "right")
        await press(pilot, "7", "p")
        card = await until(pilot, StartScreen)
        page = painted(card)
        assert "victims of seed 7, hard" in page and "25 people" in page and "3:30" in page
        options = app._options
        assert options is not None
        drawn = load_building("harbour")
        assert options.building == varied(drawn, Variant("seeded", "hard"), 7)
        assert options.again().building == varied(drawn, Variant("seeded", "hard"), 8)


async def test_the_mission_of_the_day_is_the_same_again(open_app: Open) -> None:
    async with open_app(AnaApp.show_home) as (app, pilot):
        home = await until(pilot, HomeScreen)
        home._select("today")
        await press(pilot, "enter")
        card = await until(pilot, StartScreen)
        seed = day_seed(datetime.now(UTC))
        assert f"Mission of the day {seed}" in painted(card)
        options = app._options
        assert options is not None and options.building == load_building(f"generated:{seed}")
        assert options.again().building == options.building
        assert options.again().seed == options.seed


def test_every_choice_fits_the_smallest_window() -> None:
    for building in BUILDINGS:
        chosen = Preferences(building=building)  # type: ignore[arg-type]
        items = menu_items(chosen, "best 19, last time 17", "123456789")
        rows = menu_rows(items, 0)
        assert len(rows) <= 24 - 6 and all(width(row) <= 80 for row in rows)


async def test_the_deaths_of_red_victims_are_told_and_counted(open_app: Open) -> None:
    async with open_app(duration_ms=60_000, red_expiry_ms=300, show_score=True) as (_, pilot):
        mission = await until(pilot, MissionScreen)
        for _ in range(200):
            if "died" in shown(mission):
                break
            await asyncio.sleep(0.02)
        assert "Time is up for red victims: 2 died." in shown(mission)
        assert "2 died" in " ".join(plain(mission.view.status.rows))
        later = mission.live.observation()._replace(time_ms=300 + DIED_MS)
        mission.show(later)
        assert "red victims:" not in shown(mission) and "2 died" in shown(mission)


def test_nobody_is_said_to_have_died_where_all_reds_were_reached(ward: Building) -> None:
    rules = MissionSettings(duration_ms=60_000, red_expiry_ms=300)
    run, _ = start_in_memory(ward, rules, parse_coach("static", 1), 1, rescuer="literal")
    before = run.observation()
    assert deaths_told(before, rules) is before
    run.advance(400)
    after = run.observation()
    assert deaths_told(after, rules).guidance != after.guidance
    saved = after._replace(lost=0)
    assert deaths_told(saved, rules) is saved
    assert plain(status_rows(saved, rules, 26, deaths=True))[3].endswith("none died")
    assert plain(status_rows(after, rules, 26))[3].endswith("out of time"), "as in a study"


async def test_a_treatment_that_does_not_begin_is_explained(open_app: Open) -> None:
    async with open_app() as (_, pilot):
        mission = await until(pilot, MissionScreen)
        await press(pilot, "space")
        assert "Nobody is in reach" in " ".join(plain(mission.query_one(KeyLine).rows))


async def test_what_the_level_key_asked_for_covers_nothing(open_app: Open) -> None:
    async with open_app(level_key=True) as (_, pilot):
        mission = await until(pilot, MissionScreen)
        await press(pilot, "plus")
        told = mission.asked_words("simpler", answered=False)
        assert told in " ".join(plain(mission.query_one(KeyLine).rows))
        assert not mission.app._notifications, "no toast over the small map"


def test_the_same_words_once_more_are_told_from_those_before(ward: Building) -> None:
    run, _ = start_in_memory(ward, MissionSettings(), parse_coach("static", 1), 1, rescuer="it")
    observation, repeats = run.observation(), Repeats()

    def shown_text(text: str, completed: int) -> str:
        seen = repeats.of(observation._replace(guidance=Guidance(text, completed=completed)))
        assert seen.guidance is not None
        return seen.guidance.text

    walk = "Walk forward 12 steps."
    assert shown_text(walk, 0) == walk and shown_text(walk, 0) == walk
    assert shown_text(walk, 1) == f"Again: {walk}" == shown_text(walk, 1)
    assert repeats.again
    assert shown_text(walk, 2) == f"Again: {walk}"
    assert shown_text("Turn left.", 2) == "Turn left." and not repeats.again
    assert shown_text(walk, 2) == walk, "told the same way again: nothing was carried out"
    assert Guidance(walk, completed=1) == Guidance(walk, completed=2), "to a study"


def test_the_bar_counts_what_was_carried_out(ward: Building) -> None:
    rules = MissionSettings()
    run, _ = start_in_memory(ward, rules, parse_coach("static", 1), 1, rescuer="it")
    first = run.observation().guidance
    drive(run, LiteralReader("compass", {}), done=lambda: run.mission.rescued > 0)
    last = run.observation().guidance
    assert first is not None and last is not None
    assert first.completed == 0 < last.completed
