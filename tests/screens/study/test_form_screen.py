"""A form with every kind of item, driven by keys."""

from __future__ import annotations

from typing import Any, cast

import pytest

from game.forms.items import (
    ChoiceItem,
    Condition,
    HeadingItem,
    Item,
    NumberItem,
    ScaleItem,
    SliderItem,
    TextItem,
)
from game.screens.study.base import Frame
from game.screens.study.form_screen import FormScreen
from game.screens.study.rehearsal import painted
from game.study.languages import languages
from game.study.protocol.study_session import StudySession
from game.study.protocol.tasks import Sheet
from game.study.ready import ready_forms
from game.study.study_settings import ScreenSize
from game.study.texts import Page, shipped_texts
from tests.screens.study.test_in_view import Session, at

WORDS = shipped_texts().words
PAGE = Page(title="About you", body="Please answer.")
ITEMS: tuple[Item, ...] = (
    HeadingItem(text="First things first"),
    NumberItem(id="age", text="How old are you?", from_=18, to=99, unit="years"),
    ChoiceItem(id="plays", text="Do you play?", answers=("never", "often"), other="else:"),
    ChoiceItem(
        id="kinds",
        text="Which?",
        answers=("maps", "puzzles", "sports"),
        several=True,
        shown_when=Condition(item="plays", is_=(2, 3)),
    ),
    ScaleItem(id="seven", text="How good?", answers=tuple("abcdefg")),
    SliderItem(id="warm", text="How warm?", low="cold", high="hot", from_=0, to=10),
    TextItem(id="words", text="Anything else?", length=12, required=False),
)


@pytest.fixture(autouse=True)
def _hearing(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(FormScreen, "DEAF_S", 0.0)


def made(session: Session, items: tuple[Item, ...] = ITEMS, page: Page = PAGE) -> Any:
    sheet = Sheet(cast(StudySession, session), items)
    return lambda: FormScreen(Frame(ScreenSize(), WORDS), page, sheet)


def answers(session: Session) -> dict[str, Any]:
    names = {name for _, name in session.history.items} | {
        name for kept in (session.history.choices, session.history.words) for _, name in kept
    }
    return {name: session.history.answer(session.step, name) for name in names}


async def test_every_kind_is_answered_by_its_keys_in_one_go() -> None:
    session = Session()
    async with at(made(session), 120, 40) as (pilot, screen):
        assert screen.asked.id == "age"
        await pilot.press("3", "5", "backspace", "4", "down", "3", *"flute", "down")
        await pilot.press("1", "right", "right", "space", "down", "6", "left")
        await pilot.press("down", "right", "right", "enter", *"hello you", "enter")
        await pilot.pause()
        assert screen._done
    assert answers(session) == {
        "age": 34,
        "plays": 3,
        "plays_other": "flute",
        "kinds": (1, 3),
        "seven": 5,
        "warm": 6,
        "words": "hello you",
    }


async def test_a_number_out_of_range_is_refused_and_said() -> None:
    session = Session()
    async with at(made(session), 120, 40) as (pilot, screen):
        await pilot.press("7", "down")
        assert screen.asked.id == "age"
        assert "a whole number from 18 to 99" in "\n".join(painted(pilot.app))
        await pilot.press("7", "down")
        assert screen.asked.id == "plays"
    assert answers(session) == {"age": 77}


async def test_what_is_too_long_is_not_cut() -> None:
    session = Session()
    item = TextItem(id="words", text="Anything?", length=5)
    async with at(made(session, (item,)), 120, 40) as (pilot, screen):
        await pilot.press(*"longsx", "enter")
        assert not screen._done
        assert "Too many: 1" in "\n".join(painted(pilot.app))
        await pilot.press("backspace", "enter")
        await pilot.pause()
        assert screen._done
    assert answers(session) == {"words": "longs"}


async def test_a_question_is_shown_only_where_its_condition_holds() -> None:
    session = Session()
    async with at(made(session), 120, 40) as (pilot, screen):
        await pilot.press("4", "0", "down", "2", "down", "2")
        assert answers(session)["kinds"] == (2,)
        await pilot.press("up", "1")
        await pilot.pause()
        assert "Which?" not in "\n".join(painted(pilot.app))
        await pilot.press("down")
        assert screen.asked.id == "seven"
        await screen.sheet.close()
    assert "kinds" not in answers(session)
    assert answers(session)["plays"] == 1


async def test_optional_questions_are_visited_and_can_be_cleared() -> None:
    session = Session()
    items = (
        ScaleItem(id="a", text="A?", answers=("no", "yes"), required=False),
        ScaleItem(id="b", text="B?", answers=("no", "yes"), required=False),
    )
    async with at(made(session, items), 120, 40) as (pilot, screen):
        await pilot.press("2", "delete", "enter")
        assert screen.asked.id == "b"
        assert not screen._done
        await pilot.press("enter")
        await pilot.pause()
        assert screen._done
    assert answers(session) == {}


async def test_a_question_taller_than_the_window_is_told() -> None:
    session = Session()
    many = tuple(f"answer {n}" for n in range(39))
    items = (ChoiceItem(id="country", text="Where?", answers=many),)
    async with at(made(session, items), 120, 40) as (_, screen):
        assert screen.too_tall() == {"country": 5}


async def test_a_number_below_nothing_can_be_typed() -> None:
    session = Session()
    items = (NumberItem(id="change", text="By how much?", from_=-20, to=20, required=False),)
    async with at(made(session, items), 120, 40) as (pilot, screen):
        await pilot.press("minus", "enter")
        assert not screen._done
        await pilot.press("7", "enter")
        await pilot.pause()
        assert screen._done
    assert answers(session) == {"change": -7}


async def test_beside_other_is_written_and_the_rest_can_still_be_marked() -> None:
    session = Session()
    answers_ = ("maps", "puzzles")
    items = (ChoiceItem(id="k", text="Which?", answers=answers_, other="else:", several=True),)
    async with at(made(session, items), 120, 40) as (pilot, screen):
        await pilot.press("3", *"a 1", "left", "space", "1")
        assert answers(session) == {"k": (1, 2, 3), "k_other": "a 1"}
        await pilot.press("right", "right", *["backspace"] * 4)
        await pilot.pause()
        assert answers(session) == {"k": (1, 2)}
        await pilot.press("enter")
        await pilot.pause()
        assert screen._done


async def test_left_marks_nothing_where_nothing_is_marked() -> None:
    session = Session()
    items = (ChoiceItem(id="k", text="Which?", answers=("maps", "I would rather not say")),)
    async with at(made(session, items), 120, 40) as (pilot, _):
        await pilot.press("left")
        assert answers(session) == {}
        await pilot.press("right", "left")
        await pilot.pause()
    assert answers(session) == {"k": 1}


@pytest.mark.parametrize("language", languages())
async def test_ready_forms_are_wholly_in_view_and_no_age_is_needed(language: str) -> None:
    forms = [*ready_forms("demographics", language).forms, *ready_forms("nasa-tlx", language).forms]
    for form in forms:
        page = Page(title=form.title, body=form.body)
        async with at(made(Session(), form.items, page), 120, 40) as (pilot, screen):
            await pilot.pause()
            assert not screen.scrolls
            assert "age" not in {it.id for it in screen.sheet.missing}


async def test_what_was_written_goes_with_the_answer_other() -> None:
    session = Session()
    items = (
        ChoiceItem(id="k", text="Which?", answers=("maps", "puzzles"), other="else:"),
        ScaleItem(id="s", text="How?", answers=("badly", "well")),
    )
    async with at(made(session, items), 120, 40) as (pilot, _):
        await pilot.press("3", "x", "down")
        assert answers(session) == {"k": 3, "k_other": "x"}
        await pilot.press("up", "left")
        await pilot.pause()
    assert answers(session) == {"k": 2}
