"""The tutorial: a study's lessons and legs, from the home screen to its end."""

from __future__ import annotations

import asyncio
from pathlib import Path

import pytest
from textual.pilot import Pilot

from game.coach.acts import InstructionIssued
from game.journal.history import read_history
from game.journal.reader import read_journal
from game.journal.records import SessionEnded
from game.rescuers.literal import LiteralReader
from game.screens.play.app import AnaApp
from game.screens.play.home import HomeScreen
from game.screens.play.journal_list import journal_text
from game.screens.play.lesson_screen import LessonScreen
from game.screens.play.tutorial import DONE, RESCUED, LegScreen
from game.screens.widgets.stillness import STILL_S
from game.session.verification import verify
from game.world import load_building
from game.world.events import Action
from tests.screens.pilots import Open, painted, press, until

KEYS = {
    Action.NORTH: "up", Action.EAST: "right", Action.SOUTH: "down", Action.WEST: "left",
    Action.TRIAGE: "space",
}  # fmt: skip


async def walk(pilot: Pilot[None], leg: LegScreen) -> None:
    """Do what the bar says, by keys, until the leg is over."""
    places = {room.name: room.label for room in load_building("practice").rooms}
    reader = LiteralReader("compass", places)
    while not leg.live.done:
        decided = reader.decide(leg.live.observation())
        if decided is not None:
            await press(pilot, KEYS[decided])
        while leg.live.observation().time_ms < leg.live.run._next_move_ms:
            leg.live.advance()
        leg.live.advance()
        leg.refresh_view()


@pytest.mark.long
async def test_the_tutorial_goes_through_three_ways_of_telling(
    open_app: Open, tmp_path: Path
) -> None:
    rules = {"moves_per_second": 100, "treat_red_ms": 0, "treat_blue_ms": 0}
    titles, legs = [], 0
    async with open_app(AnaApp.teach, **rules) as (app, pilot):
        while app.return_code is None:
            screen = app.screen
            if isinstance(screen, LegScreen):
                legs += 1
                if legs % 2 == 0:
                    assert f"{RESCUED} Find the next one." in painted(screen)
                await walk(pilot, screen)
            elif isinstance(screen, LessonScreen):
                titles.append(screen._page.title)
                await asyncio.sleep(STILL_S + 0.05)
                await press(pilot, "enter")
            await pilot.pause()
    assert legs == 6 and list(dict.fromkeys(titles))[-1] == DONE.title
    (path,) = tmp_path.glob("*/journal.jsonl")
    missions = read_history(read_journal(path)).missions
    told = [
        next(it.level for it in mission.records if isinstance(it, InstructionIssued))
        for mission in missions
    ]
    assert told == [1, 1, 2, 2, 3, 3]
    assert all(len(mission.fates) == 1 for mission in missions)
    assert read_journal(path).entries[-1].record == SessionEnded("finished")
    assert journal_text(path) == "tutorial" and verify(path).reproduced


async def test_the_tutorial_can_be_left_at_any_time(open_app: Open, tmp_path: Path) -> None:
    async with open_app(AnaApp.show_home) as (app, pilot):
        home = await until(pilot, HomeScreen)
        app.on_home_screen_wanted(HomeScreen.Wanted("tutorial", home))
        lesson = await until(pilot, LessonScreen)
        assert "Walking" in painted(lesson) and "clock keeps" not in painted(lesson)
        await press(pilot, "enter")
        assert app.screen is lesson, "keys from before do nothing"
        await asyncio.sleep(STILL_S + 0.05)
        await press(pilot, "q")
        await until(pilot, HomeScreen)
        assert not list(tmp_path.glob("*/journal.jsonl"))
        app.teach()
        while not isinstance(app.screen, LegScreen):
            await until(pilot, LessonScreen)
            await asyncio.sleep(STILL_S + 0.05)
            await press(pilot, "enter")
            await pilot.pause()
        await press(pilot, "q", "y")
        await until(pilot, HomeScreen)
        (path,) = tmp_path.glob("*/journal.jsonl")
        assert isinstance(read_journal(path).entries[-1].record, SessionEnded)
