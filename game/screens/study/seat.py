"""The participant at the screen: each task becomes a screen, and its result an answer."""

from __future__ import annotations

import asyncio
from typing import Literal, TypeVar

from textual.app import App

from game.errors import AnaError
from game.journal.records import Preflighted
from game.screens.study.base import Frame, StudyScreen
from game.screens.study.choice import ChoiceScreen
from game.screens.study.form_screen import FormScreen
from game.screens.study.label import LabelScreen
from game.screens.study.memorise import MemoriseScreen
from game.screens.study.mission_page import StudyMission, StudyMissionScreen
from game.screens.study.pages import PageScreen
from game.screens.study.preflight import PreflightScreen
from game.screens.study.reason import ReasonScreen
from game.screens.widgets.planmap import PlanMap
from game.screens.widgets.signs import Signs
from game.study.protocol.conduct import Stopped
from game.study.protocol.tasks import Labelling, Memorising, Playing, Sheet
from game.study.study_settings import ScreenSize
from game.study.texts import Consent, Page, Texts, followed
from game.world.building import Building
from game.world.settings import MissionSettings

Result = TypeVar("Result")


class ScreenParticipant:
    """A `game.study.protocol.conduct.Participant` who sits at the terminal."""

    def __init__(self, app: App[None], frame: Frame, texts: Texts, rules: MissionSettings) -> None:
        self._app = app
        self._frame = frame
        self._texts = texts
        self._rules = rules
        self._mission_over: asyncio.Future[bool] | None = None

    def mission_ended(self, outcome: bool | AnaError) -> None:
        """The mission on the screen was played to its end, was left (False), or failed."""
        over = self._mission_over
        if over is None or over.done():
            return
        if isinstance(outcome, AnaError):
            over.set_exception(outcome)
        else:
            over.set_result(outcome)

    async def check(self, needed: ScreenSize) -> Preflighted:
        return await self._show(PreflightScreen(self._frame))

    async def agree(self, page: Consent) -> bool:
        options = page.agree, page.decline
        sure = 1, self._frame.decline_question()
        return await self._show(ChoiceScreen(self._frame, page, options, sure=sure)) == 0

    async def read(self, page: Page) -> None:
        if page is self._texts.lessons.walking:
            await self._show(
                PageScreen(self._frame, page, Signs(self._rules, self._frame.words.mission))
            )
        else:
            await self._show(PageScreen(self._frame, page))

    async def look(self, page: Page, building: Building) -> None:
        await self._show(PageScreen(self._frame, page, PlanMap(building)))

    async def memorise(self, task: Memorising) -> None:
        await self._show(MemoriseScreen(self._frame, self._texts.memorise.title, task))

    async def label(self, task: Labelling) -> None:
        await self._show(LabelScreen(self._frame, self._texts.label.title, task))

    async def play(self, task: Playing) -> None:
        app = self._app
        self._mission_over = asyncio.get_running_loop().create_future()
        reminder: Page = self._texts.lessons.walking
        if self._rules.level_key:
            reminder = followed(reminder, self._texts.level_key.text)
        screen = StudyMissionScreen(
            self._frame, StudyMission(task), reminder, self._texts.level_key
        )
        await app.push_screen(screen)
        complete = await self._mission_over
        while app.screen is not screen:
            app.pop_screen()
        app.pop_screen()
        if not complete:
            raise Stopped

    async def choose(self, page: Page, sheet: Sheet) -> None:
        (asked,) = sheet.asked
        sheet.begin()

        async def save(index: int) -> None:
            await sheet.answer(asked, asked.least + index)

        await self._show(
            ChoiceScreen(self._frame, page, asked.anchors, question=asked.text, save=save)
        )

    async def fill(self, page: Page, sheet: Sheet) -> None:
        await self._show(FormScreen(self._frame, page, sheet))

    async def prefer(self, page: Page, options: tuple[str, str]) -> Literal[1, 2]:
        index = await self._show(ChoiceScreen(self._frame, page, options))
        return 1 if index == 0 else 2

    async def explain(self, page: Page) -> str:
        return await self._show(ReasonScreen(self._frame, page))

    async def _show(self, screen: StudyScreen[Result]) -> Result:
        """What the screen is dismissed with. Raises Stopped, or the error that ended it."""
        result = await self._app.push_screen_wait(screen)
        if result is None:
            raise Stopped
        if isinstance(result, AnaError):
            raise result
        return result
