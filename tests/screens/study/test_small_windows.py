"""A window too small for the study: what is asked, which clocks stand still, and leaving."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from textual.screen import Screen

from game.journal.history import Step
from game.journal.records import (
    Covered,
    Phase,
    PhaseEnded,
    QuestionnaireAnswer,
    SessionEnded,
)
from game.screens.study.app import StudyApp
from game.screens.study.choice import ChoiceScreen
from game.screens.study.form_screen import FormScreen
from game.screens.study.label import LabelScreen
from game.screens.study.memorise import MemoriseScreen
from game.screens.study.mission_page import StudyMissionScreen
from game.screens.study.pages import PageScreen
from game.screens.study.preflight import PreflightScreen, WindowTooSmall
from game.study.folder import Study
from game.tables.session_tables import session_tables
from tests.screens.pilots import painted, until
from tests.screens.study.seats import SIZE, at, closed, form, let_go, records
from tests.study.people import P01, journal_of, rewind, small_study

pytestmark = pytest.mark.usefixtures("hearing")


async def test_a_small_window_is_asked_to_grow(study: Study) -> None:
    async with at(study, Step("sliders", 1)) as pilot:
        sliders = await form(pilot, "sliders")
        await pilot.resize_terminal(100, 30)
        await until(pilot, WindowTooSmall)
        assert "100 x 30" in painted(pilot.app.screen)
        assert "120 x 40" in painted(pilot.app.screen)
        await pilot.press("7")
        await pilot.resize_terminal(140, 50)
        assert await form(pilot, "sliders") is sliders
    assert not records(study, QuestionnaireAnswer, "sliders")


@pytest.mark.long
async def test_the_clock_of_the_map_stands_still_while_nothing_can_be_seen(study: Study) -> None:
    async with at(study, Step("memorise", 2)) as pilot:
        await until(pilot, PageScreen)
        await pilot.press("enter")
        memorise = await until(pilot, MemoriseScreen)
        await pilot.resize_terminal(100, 30)
        await until(pilot, WindowTooSmall)
        assert study.texts.words.clock_stopped in painted(pilot.app.screen)
        await pilot.pause(6.0)
        await pilot.resize_terminal(*SIZE)
        assert await until(pilot, MemoriseScreen) is memorise
        await until(pilot, PageScreen)
    (ended,) = records(study, PhaseEnded, "memorise", segment=1)
    assert ended == PhaseEnded("completed", 5_000)
    (covered,) = records(study, Covered, "memorise", segment=1)
    assert covered.covered_ms >= 6_000


async def test_labelling_stands_still_too(study: Study) -> None:
    async with at(study, Step("label", 1)) as pilot:
        await until(pilot, PageScreen)
        await pilot.press("enter")
        label = await until(pilot, LabelScreen)
        await pilot.resize_terminal(100, 30)
        await until(pilot, WindowTooSmall)
        before = label.labelling.exposure.seen_ms
        await pilot.pause(0.5)
        assert label.labelling.exposure.seen_ms == before
        await pilot.resize_terminal(*SIZE)
        await until(pilot, LabelScreen)
        await pilot.pause(0.3)
        assert label.labelling.exposure.seen_ms > before


async def test_a_mission_goes_on_unseen_and_the_tables_say_for_how_long(study: Study) -> None:
    async with at(study, Step("mission", 1)) as pilot:
        await until(pilot, PageScreen)
        await pilot.press("enter")
        await until(pilot, StudyMissionScreen)
        await pilot.resize_terminal(100, 30)
        await until(pilot, WindowTooSmall)
        assert study.texts.words.mission_goes_on in painted(pilot.app.screen)
        await pilot.pause(1.0)
        await pilot.resize_terminal(*SIZE)
        await form(pilot, "sliders")
    (ended,) = records(study, PhaseEnded, "mission", segment=1)
    assert ended == PhaseEnded("completed", 6_000)
    (covered,) = records(study, Covered, "mission", segment=1)
    assert 1_000 <= covered.covered_ms < 6_000
    rows = session_tables(journal_of(study))
    assert rows.rounds[0].mission_covered_ms == covered.covered_ms


async def test_a_mission_that_ends_unseen_has_its_covered_time(study: Study) -> None:
    async with at(study, Step("mission", 1)) as pilot:
        await until(pilot, PageScreen)
        await pilot.press("enter")
        await until(pilot, StudyMissionScreen)
        await pilot.resize_terminal(100, 30)
        await until(pilot, WindowTooSmall)
        while not records(study, PhaseEnded, "mission", segment=1):
            await pilot.pause(0.1)
        await pilot.resize_terminal(*SIZE)
        await form(pilot, "sliders")
    covered = sum(it.covered_ms for it in records(study, Covered, "mission", segment=1))
    assert 3_000 <= covered <= 6_500
    (played,) = session_tables(journal_of(study)).rounds[:1]
    assert played.mission_covered_ms == covered


@pytest.mark.parametrize("phase", ["sliders", "memorise", "mission"])
async def test_a_window_too_small_can_be_left(study: Study, phase: Phase) -> None:
    async with at(study, Step(phase, 1)) as pilot:
        if phase != "sliders":
            await until(pilot, PageScreen)
            await pilot.press("enter")
        kinds: dict[Phase, type[Screen[Any]]] = {
            "sliders": FormScreen,
            "memorise": MemoriseScreen,
        }
        await until(pilot, kinds.get(phase, StudyMissionScreen))
        await pilot.resize_terminal(60, 20)
        await until(pilot, WindowTooSmall)
        assert study.texts.words.leave_now in painted(pilot.app.screen)
        await pilot.press("q")
        await until(pilot, PageScreen)
        goodbye = study.texts.words.goodbye
        shown = painted(pilot.app.screen).split()
        assert [
            word for word in f"{goodbye.title} {goodbye.body}".split() if word not in shown
        ] == []
        await pilot.press("enter")
        await closed(pilot)
    assert records(study, SessionEnded) == [SessionEnded("quit")]


async def test_coming_back_in_a_small_window(study: Study) -> None:
    rewind(study, Step("sliders", 1))
    async with StudyApp(study, P01).run_test(size=(80, 24)) as pilot:
        await until(pilot, WindowTooSmall)
        await pilot.resize_terminal(*SIZE)
        await form(pilot, "sliders")
    await let_go(study)


async def test_preflight_waits_for_a_window_large_enough(tmp_path: Path) -> None:
    study = small_study(tmp_path / "new")
    async with StudyApp(study, P01).run_test(size=(80, 24)) as pilot:
        await until(pilot, PreflightScreen)
        await pilot.press("up", "down", "left", "right", "space", "enter")
        assert "80 x 24" in painted(pilot.app.screen)
        assert "120 x 40" in painted(pilot.app.screen)
        await pilot.resize_terminal(*SIZE)
        assert isinstance(pilot.app.screen, PreflightScreen)
        await pilot.press("enter")
        await until(pilot, ChoiceScreen)


async def test_a_larger_window_has_blank_margins(study: Study) -> None:
    async with at(study, Step("sliders", 1)) as pilot:
        await form(pilot, "sliders")
        await pilot.resize_terminal(160, 50)
        await pilot.pause()
        lines = painted(pilot.app.screen).split("\n")
        assert not "".join(line[:20] + line[140:] for line in lines).strip()
        assert not "".join(lines[:5] + lines[45:]).strip()
