"""A participant at the screens: every phase, leaving and coming back, and what must not happen."""

from __future__ import annotations

import asyncio
import sys
from collections.abc import AsyncIterator, Iterator
from contextlib import asynccontextmanager, suppress
from pathlib import Path
from typing import Any

import pytest
from textual.events import Paste
from textual.pilot import Pilot
from textual.screen import Screen
from textual.widgets import TextArea

from game.journal.history import Step
from game.journal.records import (
    Covered,
    Exposed,
    FreeText,
    MissionAbandoned,
    Paused,
    Phase,
    PhaseEnded,
    PreferenceGiven,
    Preflighted,
    QuestionnaireAnswer,
    QuizAnswer,
    QuizSubmitted,
    SessionEnded,
    TakenOver,
)
from game.journal.sink import FileSink
from game.screens.study.app import StudyApp
from game.screens.study.base import StudyScreen
from game.screens.study.choice import ChoiceScreen
from game.screens.study.form_screen import FormScreen
from game.screens.study.label import LabelScreen
from game.screens.study.memorise import MemoriseScreen
from game.screens.study.mission_page import Reminder, StudyMissionScreen
from game.screens.study.pages import PageScreen
from game.screens.study.preflight import PreflightScreen, WindowTooSmall
from game.screens.study.reason import MOST_LETTERS, ReasonScreen
from game.screens.widgets.dialogs import Question
from game.screens.widgets.signs import Signs
from game.study.folder import Study, open_study
from game.study.lock import SessionBusy, SessionLock
from game.tables.session_tables import session_tables
from tests.screens.pilots import painted, until
from tests.study.people import P01, journal_of, rewind, small_study

SIZE = (120, 40)


@pytest.fixture(autouse=True)
def _hearing(monkeypatch: pytest.MonkeyPatch) -> None:
    """Screens accept keys at once."""
    for screen in _kinds_of(StudyScreen):
        monkeypatch.setattr(screen, "DEAF_S", 0.0)


def _kinds_of(screen: type[StudyScreen[Any]]) -> Iterator[type[StudyScreen[Any]]]:
    yield screen
    for kind in screen.__subclasses__():
        yield from _kinds_of(kind)


@asynccontextmanager
async def at(study: Study, step: Step | None = None) -> AsyncIterator[Pilot[None]]:
    if step is not None:
        rewind(study, step)
    async with StudyApp(study, P01).run_test(size=SIZE) as pilot:
        yield pilot
    await let_go(study)


async def let_go(study: Study) -> None:
    """Wait until the session's lock is free, as it is as soon as its process ends."""
    for _ in range(250):
        with suppress(SessionBusy):
            SessionLock(study.home(P01)).release()
            return
        await asyncio.sleep(0.02)
    raise AssertionError("the lock is still held")


async def closed(pilot: Pilot[Any]) -> None:
    """Wait for the program to end."""
    for _ in range(500):
        if pilot.app._exit:
            return
        await pilot.pause(0.02)
    raise AssertionError("it goes on")


async def form(pilot: Pilot[None], phase: str) -> FormScreen:
    """The form of a phase, once it is on the screen."""
    for _ in range(1000):
        session = pilot.app.session  # type: ignore[attr-defined]
        if session is not None and session.step.phase == phase:
            shown: FormScreen = await until(pilot, FormScreen)
            return shown
        await pilot.pause(0.02)
    raise AssertionError(f"{pilot.app.screen} is shown, not {phase}")


def records(study: Study, kind: type, phase: str = "", segment: int | None = None) -> list[Any]:
    return [
        entry.record
        for entry in journal_of(study).entries
        if isinstance(entry.record, kind)
        and phase in ("", entry.envelope.phase)
        and segment in (None, entry.envelope.segment)
    ]


async def test_from_login_to_practice(tmp_path: Path) -> None:
    study = small_study(tmp_path / "new")
    async with StudyApp(study, P01).run_test(size=SIZE) as pilot:
        await until(pilot, PreflightScreen)
        await pilot.press("enter", "up", "down", "left", "right", "enter")
        assert isinstance(pilot.app.screen, PreflightScreen)
        await pilot.press("space", "enter")
        await until(pilot, ChoiceScreen)
        await pilot.press("enter")
        assert isinstance(pilot.app.screen, ChoiceScreen)
        assert not study.home(P01).joinpath("journal.jsonl").exists()
        await pilot.press("down", "enter")
        page = await until(pilot, PageScreen)
        await pilot.press("enter")
        await pilot.pause(0.05)
        assert await until(pilot, PageScreen) is not page
        assert pilot.app.screen.query(Signs)
    (checked,) = records(study, Preflighted)
    assert (checked.enough, checked.keys_work) == (True, True)
    assert (checked.terminal.columns, checked.terminal.rows) == SIZE


async def test_a_long_consent_can_be_read_and_answered(tmp_path: Path) -> None:
    study = small_study(tmp_path / "new")
    path = study.folder / "texts.toml"
    path.write_text(
        path.read_text().replace("You must be 18", "On and on.\n\n" * 40 + "You must be 18")
    )
    async with StudyApp(open_study(study.folder), P01).run_test(size=SIZE) as pilot:
        await until(pilot, PreflightScreen)
        await pilot.press("up", "down", "left", "right", "space", "enter")
        await until(pilot, ChoiceScreen)
        await pilot.pause()
        assert "PgDn" in painted(pilot.app.screen)
        assert study.texts.consent.agree not in painted(pilot.app.screen)
        await pilot.press("down")
        await pilot.pause()
        assert study.texts.consent.agree in painted(pilot.app.screen)
        await pilot.press("enter")
        await until(pilot, PageScreen)


async def test_declining(tmp_path: Path) -> None:
    study = small_study(tmp_path / "new")
    async with StudyApp(study, P01).run_test(size=SIZE) as pilot:
        await until(pilot, PreflightScreen)
        await pilot.press("up", "down", "left", "right", "space", "enter")
        choice = await until(pilot, ChoiceScreen)
        await pilot.press("up", "enter")
        assert choice._choice.chosen is None
        assert isinstance(pilot.app.screen, ChoiceScreen)
        await pilot.press("down", "down", "enter")
        await until(pilot, Question)
        await pilot.press("n")
        await until(pilot, ChoiceScreen)
        await pilot.press("enter")
        await until(pilot, Question)
        assert study.texts.words.decline_title in painted(pilot.app.screen)
        await pilot.press("y")
        await until(pilot, PageScreen)
        assert study.texts.declined.title in painted(pilot.app.screen)
        await pilot.press("enter")
        await closed(pilot)
    assert len(journal_of(study).entries) == 3


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


async def test_the_map_stays_for_its_whole_time_and_no_key_ends_it(study: Study) -> None:
    async with at(study, Step("memorise", 2)) as pilot:
        await until(pilot, PageScreen)
        await pilot.press("enter")
        memorise = await until(pilot, MemoriseScreen)
        for name in ("Lobby", "Canteen", "Kitchen"):
            assert name in painted(pilot.app.screen)
        await pilot.press("enter", "space", "escape", "q", "ctrl+d", "ctrl+z", "ctrl+p")
        assert pilot.app.screen is memorise
        await until(pilot, PageScreen)
    (ended,) = records(study, PhaseEnded, "memorise", segment=1)
    assert ended == PhaseEnded("completed", 5_000)
    assert len(records(study, Exposed, "memorise", segment=1)) == 5


async def test_labelling(study: Study) -> None:
    async with at(study, Step("label", 1)) as pilot:
        await until(pilot, PageScreen)
        await pilot.press("enter")
        label = await until(pilot, LabelScreen)
        first = label.room
        await pilot.press(*first.name[:6].lower().replace(" ", "_").split("_")[0])
        await pilot.press("enter")
        assert label.room is not first
        await pilot.press("left", "delete")
        assert label.room is first
        assert not label.labelling.given
        await pilot.press("up", "enter")
        await until(pilot, Question)
        assert "20" in painted(pilot.app.screen)
        await pilot.press("y")
        await until(pilot, PageScreen)
    given = records(study, QuizAnswer, "label", segment=1)
    assert [(answer.room, answer.answer) for answer in given] == [
        (first.name, first.name),
        (first.name, None),
    ]
    assert records(study, QuizSubmitted, "label", segment=1) == [QuizSubmitted(0, 20)]


async def test_labelling_ends_by_itself_even_under_a_question(study: Study) -> None:
    async with at(study, Step("label", 1)) as pilot:
        await until(pilot, PageScreen)
        await pilot.press("enter")
        label = await until(pilot, LabelScreen)
        await pilot.press("enter", "ctrl+c")
        await until(pilot, Question)
        await until(pilot, PageScreen)
        assert label not in pilot.app.screen_stack
    (ended,) = records(study, PhaseEnded, "label", segment=1)
    assert ended == PhaseEnded("timed_out", 6_000)


async def test_a_name_belongs_to_one_room(study: Study) -> None:
    async with at(study, Step("label", 1)) as pilot:
        await until(pilot, PageScreen)
        await pilot.press("enter")
        label = await until(pilot, LabelScreen)
        first, second = label.labelling.rooms[:2]
        name = label.labelling.names[0]
        await pilot.press("enter")
        assert label.labelling.given == {first.name: name}
        await pilot.press("up", "enter")
        assert label.labelling.given == {second.name: name}
    taken, given = records(study, QuizAnswer, "label", segment=1)[-2:]
    assert (taken.room, taken.answer) == (first.name, None)
    assert (given.room, given.answer) == (second.name, name)


async def test_a_mission_is_played_to_its_end(study: Study) -> None:
    async with at(study, Step("mission", 1)) as pilot:
        await until(pilot, PageScreen)
        await pilot.press("enter")
        mission = await until(pilot, StudyMissionScreen)
        await pilot.press("up", "p", "ctrl+p", "ctrl+z", "ctrl+backslash")
        assert pilot.app.screen is mission
        text = painted(pilot.app.screen)
        await pilot.press("question_mark")
        await until(pilot, Reminder)
        text += painted(pilot.app.screen)
        assert study.texts.lessons.walking.title in text
        await pilot.press("enter")
        assert pilot.app.screen is mission
        assert not any(word in text for word in ("C1", "C2", "C3", "static", "adaptive", "points"))
        await pilot.press("q")
        await until(pilot, Question)
        await pilot.press("n")
        assert pilot.app.screen is mission
        await form(pilot, "sliders")
    (ended,) = records(study, PhaseEnded, "mission", segment=1)
    assert ended == PhaseEnded("completed", 6_000)
    assert not records(study, Paused)


async def test_leaving_a_mission_ends_it_and_the_sliders_follow(study: Study) -> None:
    async with at(study, Step("mission", 1)) as pilot:
        await until(pilot, PageScreen)
        await pilot.press("enter")
        await until(pilot, StudyMissionScreen)
        await pilot.press("ctrl+c")
        await until(pilot, Question)
        await pilot.press("y")
        await until(pilot, PageScreen)
        assert study.texts.words.goodbye.title in painted(pilot.app.screen)
        await pilot.press("enter")
        await closed(pilot)
    assert records(study, MissionAbandoned, "mission")
    assert records(study, SessionEnded) == [SessionEnded("quit")]
    async with at(study) as pilot:
        await form(pilot, "sliders")
    (ended,) = records(study, PhaseEnded, "mission")
    assert ended.ending == "interrupted"


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


async def test_a_full_disk_is_told_and_nothing_goes_on(
    study: Study, monkeypatch: pytest.MonkeyPatch
) -> None:
    rewind(study, Step("preference"))
    write = FileSink.write

    def full(sink: FileSink, lines: bytes) -> None:
        if b'"preference"' in lines and b'"preferred_round"' in lines:
            raise sink._failed(OSError(28, "No space left on device"))
        write(sink, lines)

    monkeypatch.setattr(FileSink, "write", full)
    async with at(study) as pilot:
        await until(pilot, ChoiceScreen)
        await pilot.press("1", "enter")
        await until(pilot, PageScreen)
        assert "the disk is full" in painted(pilot.app.screen)
        await pilot.press("enter")
        await closed(pilot)
        assert pilot.app.return_code == 2
    assert not records(study, PreferenceGiven)


async def test_a_second_login_may_take_over(study: Study) -> None:
    rewind(study, Step("sliders", 1))
    program = (
        "import sys, time; from pathlib import Path; from game.study.lock import SessionLock\n"
        "lock = SessionLock(Path(sys.argv[1])); print('held', flush=True); time.sleep(60)"
    )
    other = await asyncio.create_subprocess_exec(
        sys.executable, "-c", program, str(study.home(P01)), stdout=asyncio.subprocess.PIPE
    )
    assert other.stdout is not None
    await other.stdout.readline()
    async with StudyApp(study, P01).run_test(size=SIZE) as pilot:
        await until(pilot, Question)
        assert study.texts.words.busy.title in painted(pilot.app.screen)
        await pilot.press("n")
        await closed(pilot)
    assert other.returncode is None
    async with at(study) as pilot:
        await until(pilot, Question)
        await pilot.press("y")
        await form(pilot, "sliders")
    assert await other.wait() != 0
    assert len(records(study, TakenOver)) == 1
