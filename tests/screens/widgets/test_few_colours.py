"""The screens where colours are few or none: everything can still be seen and read."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import AbstractAsyncContextManager
from pathlib import Path

import pytest
from rich.style import Style
from textual.pilot import Pilot
from textual.widget import Widget

from game.screens.play.app import AnaApp
from game.screens.play.mission_screen import MissionScreen
from game.screens.study.app import StudyApp
from game.screens.study.preflight import Checks, PreflightScreen
from game.screens.widgets.canvas import Canvas, plain
from game.screens.widgets.dialogs import Question
from game.screens.widgets.minimap import MiniMap
from game.screens.widgets.officeview import OfficeView
from game.screens.widgets.planmap import PlanMap
from game.screens.widgets.statuspanel import StatusPanel
from game.world import load_building
from tests.screens.pilots import painted, until
from tests.study.people import P01, small_study

Open = Callable[..., AbstractAsyncContextManager[tuple[AnaApp, Pilot[None]]]]

BLACK, RED, GREEN, YELLOW = range(4)


@pytest.fixture(params=["16", "none"])
def few(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch, open_app: Open) -> str:
    """How many colours the terminal has."""
    monkeypatch.setenv("TERM", "screen")
    if request.param == "none":
        monkeypatch.setenv("NO_COLOR", "1")
    return str(request.param)


def of(ink: Style) -> int | None:
    """The number of a text's colour."""
    return ink.color.number if ink.color is not None else None


def on(ink: Style) -> int | None:
    """The number of its ground's."""
    return ink.bgcolor.number if ink.bgcolor is not None else None


def inks(widget: Widget) -> dict[str, Style]:
    """What a widget's component classes look like."""
    return {name: widget.get_component_rich_style(name) for name in widget.COMPONENT_CLASSES}


async def test_doors_have_a_sign_on_the_small_map(few: str, open_app: Open) -> None:
    async with open_app() as (_, pilot):
        mission = await until(pilot, MissionScreen)
        assert "+" in "".join(plain(mission.query_one(MiniMap).rows))


async def test_what_is_reversed_has_the_grounds_own_colours_and_bold_is_not_black(
    few: str, open_app: Open
) -> None:
    async with open_app() as (_, pilot):
        mission = await until(pilot, MissionScreen)
        for canvas in mission.query(Canvas):
            for name, ink in inks(canvas).items():
                told = f"{type(canvas).__name__} > .{name}: {ink}"
                assert ink.color is not None, told
                assert few == "none" or not ink.reverse or ink.color.is_default, told
                assert few == "none" or not ink.bold or ink.color.number != BLACK, told


async def test_what_is_red_in_a_hurry_is_reversed_without_colours(few: str, open_app: Open) -> None:
    async with open_app() as (_, pilot):
        mission = await until(pilot, MissionScreen)
        hurry = inks(mission.query_one(StatusPanel))["hurry"]
        assert bool(hurry.reverse) is (few == "none")
        assert on(hurry) == RED


async def test_the_pages_of_a_study(few: str, tmp_path: Path) -> None:
    study, building = small_study(tmp_path / "study"), load_building("practice")
    async with StudyApp(study, P01).run_test(size=(120, 40)) as pilot:
        preflight = await until(pilot, PreflightScreen)
        arrived = inks(preflight.query_one(Checks))["arrived"]
        assert bool(arrived.reverse) is (few == "none")
        assert (of(arrived), on(arrived)) == (BLACK, GREEN)

        await preflight.mount(plan := PlanMap(building))
        assert "+" in "".join(plain(plan.rows))
        plan.name_rooms({}, asked=building.rooms[0])
        (question,) = (run for row in plan.rows for run in row if run[0] == "?")
        assert question[1].startswith("asked-name/") and inks(plan)["asked-name"].reverse


async def test_doors_have_a_ground_that_shows_on_dark_and_on_light(
    few: str, open_app: Open
) -> None:
    async with open_app() as (_, pilot):
        mission = await until(pilot, MissionScreen)
        office, small = mission.query_one(OfficeView), mission.query_one(MiniMap)
        for door in (inks(office)["door"], inks(small)["known-door"]):
            assert (of(door), on(door)) == (BLACK, YELLOW)


async def test_a_question_leaves_the_mission_in_sight_and_a_small_window_does_not(
    few: str, open_app: Open
) -> None:
    async with open_app() as (app, pilot):
        await until(pilot, MissionScreen)
        await pilot.press("q")
        await until(pilot, Question)
        assert " left" in painted(app.screen) and "Leave the mission?" in painted(app.screen)
        await pilot.resize_terminal(70, 20)
        await pilot.pause()
        assert "too small" in painted(app.screen) and " left" not in painted(app.screen)
