"""A participant at the screens: every phase, leaving and coming back, and what must not happen."""

from __future__ import annotations

import asyncio
import sys
from pathlib import Path

import pytest

from game.journal.history import Step
from game.journal.records import (
    Exposed,
    MissionAbandoned,
    Paused,
    PhaseEnded,
    PreferenceGiven,
    Preflighted,
    QuizAnswer,
    QuizSubmitted,
    SessionEnded,
    TakenOver,
)
from game.journal.sink import FileSink
from game.screens.study.app import StudyApp
from game.screens.study.choice import ChoiceScreen
from game.screens.study.label import LabelScreen
from game.screens.study.memorise import MemoriseScreen
from game.screens.study.mission_page import Reminder, StudyMissionScreen
from game.screens.study.pages import PageScreen
from game.screens.study.preflight import PreflightScreen
from game.screens.widgets.dialogs import Question
from game.screens.widgets.signs import Signs
from game.study.folder import Study, open_study
from tests.screens.pilots import painted, until
from tests.screens.study.seats import SIZE, at, closed, form, records
from tests.study.people import P01, journal_of, rewind, small_study

pytestmark = pytest.mark.usefixtures("hearing")


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
