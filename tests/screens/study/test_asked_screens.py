"""Sliders, statements, preference and reason at the screens."""

from __future__ import annotations

import pytest
from textual.events import Paste
from textual.widgets import TextArea

from game.journal.history import Step
from game.journal.records import (
    FreeText,
    PreferenceGiven,
    QuestionnaireAnswer,
    SessionEnded,
)
from game.screens.study.choice import ChoiceScreen
from game.screens.study.form_screen import FormScreen
from game.screens.study.pages import PageScreen
from game.screens.study.reason import MOST_LETTERS, ReasonScreen
from game.screens.widgets.dialogs import Question
from game.study.folder import Study
from tests.screens.pilots import painted, until
from tests.screens.study.seats import at, closed, form, records

pytestmark = pytest.mark.usefixtures("hearing")


async def test_sliders_stand_nowhere_until_moved(study: Study) -> None:
    async with at(study, Step("sliders", 1)) as pilot:
        sliders = await form(pilot, "sliders")
        await pilot.press(*["enter"] * 5)
        assert isinstance(pilot.app.screen, FormScreen)
        assert not records(study, QuestionnaireAnswer, "sliders", segment=1)
        await sliders.turn_to(sliders.sheet.asked[0].id)
        await pilot.press("4", "2", "down", "end", "left", "down", "right", "pageup", "down")
        await pilot.press("enter")
        assert pilot.app.screen is sliders
        await pilot.press("home", "enter")
        await form(pilot, "likert")
    last = {a.item: a for a in records(study, QuestionnaireAnswer, "sliders", segment=1)}
    by_place = sorted(last.values(), key=lambda answer: answer.place)
    assert [answer.value for answer in by_place] == [42, 99, 60, 1]
    assert {answer.item for answer in by_place} == {
        it.id for it in study.forms.occasion("sliders").form.questions
    }


async def test_answers_given_before_a_cut_are_still_there(study: Study) -> None:
    async with at(study, Step("sliders", 1)) as pilot:
        await form(pilot, "sliders")
        await pilot.press("7", "down", "8", "down")
        await pilot.pause(0.1)
    async with at(study) as pilot:
        sliders = await form(pilot, "sliders")
        assert [sliders.sheet.value(it) for it in sliders.sheet.asked] == [7, 8, None, None]
        await pilot.press("ctrl+c")
        await until(pilot, Question)
        await pilot.press("n")
        await pilot.press("down", "down", "9", "enter", "9", "enter")
        await form(pilot, "likert")


async def test_statements(study: Study) -> None:
    async with at(study, Step("likert", 2)) as pilot:
        likert = await form(pilot, "likert")
        await pilot.press("5", "enter", "left", "left", "9", "enter", "1")
        await pilot.press("enter", "enter")
        assert pilot.app.screen is likert
        await pilot.press("right", "enter")
        await until(pilot, ChoiceScreen)
    last = {a.item: a for a in records(study, QuestionnaireAnswer, "likert", segment=1)}
    assert [a.value for a in sorted(last.values(), key=lambda a: a.place)] == [5, 2, 1, 3]
    assert all(
        answer.anchors == study.forms.occasion("likert").form.answers for answer in last.values()
    )


async def test_preference_reason_and_the_end(study: Study) -> None:
    async with at(study, Step("preference")) as pilot:
        await until(pilot, ChoiceScreen)
        assert "Instructor Amber" in painted(pilot.app.screen)
        await pilot.press("2", "enter")
        await until(pilot, ReasonScreen)
        await pilot.press(*"no q", "enter")
        await until(pilot, PageScreen)
        session = pilot.app.session  # type: ignore[attr-defined]
        assert session.completion_code in painted(pilot.app.screen)
        assert records(study, SessionEnded) == [SessionEnded("finished")]
        await pilot.press("enter")
        await closed(pilot)
    assert records(study, PreferenceGiven, segment=1)[0].preferred_round == 2
    assert records(study, FreeText, segment=1)[0].answer == "no q"


async def test_too_long_a_reason_is_said_and_nothing_of_it_is_cut(study: Study) -> None:
    async with at(study, Step("preference")) as pilot:
        await until(pilot, ChoiceScreen)
        await pilot.press("1", "enter")
        reason = await until(pilot, ReasonScreen)
        area = reason.query_one(TextArea)
        area.load_text("a" * MOST_LETTERS)
        area.move_cursor((0, MOST_LETTERS))
        await pilot.press("b", "enter")
        assert pilot.app.screen is reason
        assert "2,000" in painted(reason)
        assert "Too many: 1." in painted(reason)
        await pilot.press("backspace", "enter")
        await until(pilot, PageScreen)
    assert records(study, FreeText, segment=1)[0].answer == "a" * MOST_LETTERS


async def test_a_paste_that_does_not_fit_is_left_out_and_said(study: Study) -> None:
    async with at(study, Step("preference")) as pilot:
        await until(pilot, ChoiceScreen)
        await pilot.press("1", "enter")
        reason = await until(pilot, ReasonScreen)
        pilot.app.post_message(Paste("x" * 1_000_000))
        await pilot.pause()
        assert "What you pasted was left out: 998,000 too many." in painted(reason)
        pilot.app.post_message(Paste("clear"))
        await pilot.pause()
        assert "left out" not in painted(reason)
        await pilot.press("enter")
        await until(pilot, PageScreen)
    assert records(study, FreeText, segment=1)[0].answer == "clear"
