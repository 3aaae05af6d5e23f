"""No question is answered unseen: long pages scroll, text wraps, and the active item is in view."""

from __future__ import annotations

from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from types import SimpleNamespace
from typing import Any, cast

import pytest
from rich.cells import cell_len
from textual.pilot import Pilot

from game.forms.items import HeadingItem, Item, ScaleItem, SliderItem
from game.journal.history import History, Step
from game.journal.records import Envelope, QuestionnaireAnswer
from game.screens.study.base import Frame, StudyScreen
from game.screens.study.choice import ChoiceScreen
from game.screens.study.form_screen import TYPED_S, FormScreen
from game.screens.study.rehearsal import Make, Showing, painted, shown
from game.screens.study.standing_head import MORE
from game.screens.widgets.theme import LOOK
from game.study.protocol.study_session import StudySession
from game.study.protocol.tasks import Sheet
from game.study.study_settings import ScreenSize
from game.study.texts import Page, shipped_texts

WORDS = shipped_texts().words
PAGE = Page(title="How was it?", body="Please answer every question.\n\n" * 4)
GERMAN = (
    "überhaupt nicht in der Lage, den Anweisungen der Begleitung zu folgen",
    "jederzeit ohne jede Schwierigkeit in der Lage, den Anweisungen zu folgen",
)
JAPANESE = (
    "まったくそう思わなかったし、指示の意味もよくわからなかった",
    "とてもそう思ったし、すべての指示の意味がよくわかった",
)
POINTS = tuple(
    f"{degree} dieser Aussage ganz und gar zu"
    for degree in ("stimme", "lehne", "weiß", "ja", "nein")
)


class Session:
    """As much of a session as a sheet of questions needs; `kept` are the answers recorded."""

    def __init__(self) -> None:
        self.step = Step("sliders", 1)
        self.history = History()
        self.study = SimpleNamespace(version="v")
        self.kept: list[QuestionnaireAnswer] = []

    def now_ms(self) -> int:
        return 0

    async def save(self, *records: QuestionnaireAnswer) -> None:
        for record in records:
            self.kept.append(record)
            self.history.note(Envelope(0, 0, 0, "", self.step.phase, self.step.round), record)


TEXT = "Wie sehr haben Sie sich während der gesamten Mission von der Begleitung verstanden gefühlt"


def sliders(count: int, anchors: tuple[str, str]) -> tuple[SliderItem, ...]:
    low, high = anchors
    return tuple(
        SliderItem(id=f"item{n}", text=f"{n}. {TEXT}, Teil {n}?", low=low, high=high)
        for n in range(count)
    )


def scales(count: int) -> tuple[ScaleItem, ...]:
    return tuple(
        ScaleItem(id=f"item{n}", text=f"{n}. {TEXT}, Teil {n}?", answers=POINTS)
        for n in range(count)
    )


@asynccontextmanager
async def at(make: Make, columns: int, rows: int) -> AsyncIterator[tuple[Pilot[None], Any]]:
    app = Showing(LOOK)
    async with app.run_test(size=(columns, rows)) as pilot, app.opened(make) as screen:
        deaf_s = cast(StudyScreen[Any], screen).DEAF_S
        await pilot.pause(deaf_s + 0.1 if deaf_s else None)
        yield pilot, screen


def whole(screen: FormScreen, app: Any) -> bool:
    """Whether all words of the active question are in the window; of words that may be broken
    anywhere, all letters."""
    lines = "".join("".join(line.split()) for line in painted(app))
    question = screen.asked
    words = [word for text in (question.text, *question.anchors) for word in text.split()]
    return all(
        word in lines or (ord(word[-1]) > 0x2E80 and all(letter in lines for letter in word))
        for word in words
    )


@pytest.mark.parametrize("size", [(120, 40), (80, 24)])
@pytest.mark.parametrize("anchors", [GERMAN, JAPANESE], ids=["german", "japanese"])
async def test_every_slider_is_in_view_when_it_is_answered(
    anchors: tuple[str, str], size: tuple[int, int]
) -> None:
    session, frame = Session(), Frame(ScreenSize(columns=size[0], rows=size[1]), WORDS)
    sheet = Sheet(cast(StudySession, session), sliders(10, anchors))
    async with at(lambda: FormScreen(frame, PAGE, sheet), *size) as (pilot, screen):
        for number in range(10):
            for _ in range(3):
                await pilot.press("4")
                await pilot.pause(0.02)
                if len(session.kept) > number:
                    break
            assert session.kept[-1].item == f"item{number}"
            assert whole(screen, pilot.app)
            assert all(cell_len(line) <= size[0] for line in painted(pilot.app))
            await pilot.press("enter")
            await pilot.pause(0.02)
    assert [answer.item for answer in session.kept] == [f"item{n}" for n in range(10)]


async def test_every_statement_is_in_view_when_it_is_answered() -> None:
    session, frame = Session(), Frame(ScreenSize(), WORDS)
    sheet = Sheet(cast(StudySession, session), scales(12))
    async with at(lambda: FormScreen(frame, PAGE, sheet), 120, 40) as (pilot, screen):
        for number in range(12):
            for _ in range(3):
                await pilot.press("2")
                await pilot.pause(0.02)
                if len(session.kept) > number:
                    break
            assert session.kept[-1].item == f"item{number}"
            assert whole(screen, pilot.app)
            await pilot.press("down")
        await pilot.press("down", "down")
        assert screen.asked.id == "item11"


@pytest.mark.usefixtures("hearing")
async def test_what_a_question_is_about_stays_in_sight() -> None:
    session, frame = Session(), Frame(ScreenSize(columns=80, rows=24), WORDS)
    long = "Now think of all of it. " * 8
    items: tuple[Item, ...] = (HeadingItem(text="The way"), *sliders(5, ("low", "high")),
             HeadingItem(text=long), *scales(9)[5:])  # fmt: skip
    sheet = Sheet(cast(StudySession, session), items)
    async with at(lambda: FormScreen(frame, PAGE, sheet), 80, 24) as (pilot, _):
        seen = [painted(pilot.app)]
        for _ in sheet.asked[1:]:
            await pilot.press("down")
            await pilot.pause()
            seen.append(painted(pilot.app))
    first, later, last = seen[0], seen[3], seen[-1]
    assert [line.strip() for line in first[:4]] == ["", "", "", PAGE.title]
    assert [line.strip() for line in later[:3]] == [PAGE.title, "The way", ""]
    assert last[1].strip().endswith(MORE)
    assert long.startswith(last[1].strip().removesuffix(MORE))
    for view in seen:
        assert sum(line.strip() == PAGE.title for line in view) == 1


async def test_a_form_of_many_questions_is_looked_at_to_its_end() -> None:
    frame, many = Frame(ScreenSize(), WORDS), scales(45)
    sheet = Sheet(cast(StudySession, Session()), many)
    async with Showing(LOOK).run_test(size=(120, 40)) as pilot:
        words = " ".join(question.text for question in many)
        page = await shown(pilot, "", lambda: FormScreen(frame, PAGE, sheet), words, pictures=False)
    assert page.missing == ()


async def test_digits_belong_together_for_a_while_and_each_is_recorded() -> None:
    session, frame = Session(), Frame(ScreenSize(), WORDS)
    sheet = Sheet(cast(StudySession, session), sliders(2, ("low", "high")))
    async with at(lambda: FormScreen(frame, PAGE, sheet), 120, 40) as (pilot, _):
        await pilot.press("8")
        await pilot.pause(0.7 * TYPED_S)
        await pilot.press("5")
        await pilot.pause(TYPED_S + 0.1)
        await pilot.press("7")
    assert TYPED_S == 1.5
    assert [answer.value for answer in session.kept] == [8, 85, 7]


async def test_a_choice_has_no_wrap_around_and_all_of_it_must_have_been_seen() -> None:
    frame = Frame(ScreenSize(columns=80, rows=24), WORDS)
    options = tuple(f"Answer {number}: {GERMAN[0]}, {GERMAN[1]}" for number in range(8))
    taken: list[int] = []

    async def save(number: int) -> None:
        taken.append(number)

    async with at(lambda: ChoiceScreen(frame, PAGE, options, save=save), 80, 24) as (pilot, screen):
        await pilot.press("down", "up", "up")
        assert screen._choice.chosen == 0
        await pilot.press("enter")
        await pilot.pause()
        assert taken == []
        await pilot.press(*["down"] * 12)
        assert screen._choice.chosen == len(options) - 1
        await pilot.press("1")
        await pilot.pause()
        await pilot.press("enter")
        await pilot.pause()
    assert taken == [0]
