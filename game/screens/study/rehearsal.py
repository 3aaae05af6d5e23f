"""Every page of a study as participants will see it, opened without a person: what does not fit,
and a picture of each."""

from __future__ import annotations

import asyncio
import os
import re
from collections.abc import AsyncIterator, Callable, Iterator, Sequence
from contextlib import asynccontextmanager
from dataclasses import dataclass
from functools import partial
from pathlib import Path, PurePath
from typing import Any, ClassVar, Literal

from textual.app import App
from textual.pilot import Pilot
from textual.screen import Screen
from textual.widget import Widget

from game.forms.items import HeadingItem, Item
from game.journal.clock import VirtualClock
from game.journal.records import Preflighted
from game.journal.sink import MemorySink
from game.rescuers.person import POPULATIONS
from game.screens.study.app import StudyApp
from game.screens.study.base import Frame
from game.screens.study.choice import ChoiceScreen
from game.screens.study.form_screen import FormScreen
from game.screens.study.label import LabelScreen
from game.screens.study.memorise import MemoriseScreen
from game.screens.study.mission_rehearsal import legend_words, mission_pages, windows
from game.screens.study.pages import PageScreen
from game.screens.study.preflight import PreflightScreen
from game.screens.study.reason import ReasonScreen
from game.screens.widgets.planmap import PlanMap
from game.screens.widgets.program import Program
from game.screens.widgets.signs import Signs
from game.screens.widgets.theme import Look
from game.simulation.simulated_participant import SimulatedParticipant
from game.simulation.simulated_session import HeldStudy
from game.study.folder import Identity, Study
from game.study.lab.readiness import shortfalls
from game.study.ledger import SlotTaken
from game.study.protocol.conduct import conduct
from game.study.protocol.study_session import StudySession, open_session
from game.study.protocol.tasks import Labelling, Memorising, Playing, Sheet
from game.study.study_settings import ScreenSize
from game.study.texts import Consent, Page, filled, preceded
from game.world.building import Building

MOST_VIEWS = 40
"""So many times a page that is no form is scrolled on at most."""


Make = Callable[[], Screen[Any]]
"""Makes a screen, inside the program that shows it."""


@dataclass(frozen=True)
class Rehearsed:
    """A page: its name, the words that nobody could have read, its pictures as SVG, and the
    questions that are never wholly in view, each with the rows that it has too many."""

    name: str
    missing: tuple[str, ...]
    pictures: tuple[str, ...]
    too_tall: dict[str, int]


_ALL_COLOURS = {"TERM": "xterm-256color", "COLORTERM": "truecolor"}
"""Pages are opened, and drawn for an ethics board, as the best of terminals shows them."""


class Showing(Program, inherit_bindings=False):
    """A program that shows one page after another."""

    CSS_PATH: ClassVar[list[str | PurePath]] = StudyApp.CSS_PATH

    def __init__(self, look: Look) -> None:
        super().__init__("dark", look, environ=_ALL_COLOURS)

    @asynccontextmanager
    async def opened(self, make: Make) -> AsyncIterator[Screen[Any]]:
        """A page, made and shown within the program, and closed afterwards."""
        made: asyncio.Future[Screen[Any]] = asyncio.get_running_loop().create_future()

        async def push() -> None:
            try:
                screen = make()
                await self.push_screen(screen)
            except Exception as error:
                made.set_exception(error)
            else:
                made.set_result(screen)

        self.call_later(push)
        screen = await made
        yield screen
        while screen in self.screen_stack:
            await self.pop_screen()


async def shown(
    pilot: Pilot[None], name: str, make: Make, words: str, *, pictures: bool = True
) -> Rehearsed:
    """Open a page in a `Showing`, look at all of it, and compare it with its `words`; draw it where
    `pictures` of it are wanted."""
    app = pilot.app
    assert isinstance(app, Showing)
    views: list[list[str]] = []
    drawn: list[str] = []
    async with app.opened(make) as screen:
        await pilot.pause()
        most = len(screen.sheet.items) + 1 if isinstance(screen, FormScreen) else MOST_VIEWS
        for _ in range(most):
            view = painted(app)
            if view in views:
                break
            views.append(view)
            if pictures:
                drawn.append(app.export_screenshot(title=name))
            await _go_on(pilot)
        too_tall = screen.too_tall() if isinstance(screen, FormScreen) else {}
    return Rehearsed(name, tuple(_unseen(words, views)), tuple(drawn), too_tall)


async def _go_on(pilot: Pilot[None]) -> None:
    """To what stands below: the next question, or a page further."""
    screen = pilot.app.screen
    if isinstance(screen, FormScreen):
        await screen.turn(1)
    else:
        for scrolled in screen.query(Widget):
            if scrolled.max_scroll_y > scrolled.scroll_y:
                scrolled.scroll_page_down(animate=False)
    await pilot.pause()


def painted(app: App[Any]) -> list[str]:
    """The lines in the window."""
    return [strip.text for strip in app.screen._compositor.render_strips(app.size)]


def _unseen(words: str, views: Sequence[Sequence[str]]) -> Iterator[str]:
    """The words that are in no view, whole. A word that is longer than a line, or is written
    without spaces, may be broken between lines."""
    lines = [line for view in views for line in view]
    tokens = {token for line in lines for token in line.split()}
    joined = ["".join(_FRAMES.sub("", line) for line in view) for view in views]
    for word in dict.fromkeys(words.replace("**", "").split()):
        in_a_line = word in tokens or any(word in line for line in lines)
        if not in_a_line and not (_may_break(word) and any(word in one for one in joined)):
            yield word


_FRAMES = re.compile(r"[\s\u2500-\u259f]+")
"""Blanks, and the lines and blocks of a frame."""


def _may_break(word: str) -> bool:
    return len(word) > 40 or any(ord(letter) > 0x2E80 for letter in word)


class _AllShown(Sheet):
    """A page with every item on it, whatever the answers are."""

    @property
    def shown(self) -> tuple[Item, ...]:
        return self.items


class _Rehearsal(SimulatedParticipant):
    """Goes through a session as a simulated person does, and has every page opened on the way."""

    def __init__(
        self,
        session: StudySession,
        clock: VirtualClock,
        frame: Frame,
        pilot: Pilot[None],
        *,
        pictures: bool,
    ) -> None:
        super().__init__(session, clock, POPULATIONS["default"])
        self._pilot = pilot
        self._pictures = pictures
        self.pages: list[Rehearsed] = []
        self._mission_shown = False
        self._frame = frame
        self._study = session.study
        self._mission = session.study.settings.mission

    async def check(self, needed: ScreenSize) -> Preflighted:
        words = self._frame.words
        said = words.preflight, words.size_fine, words.press_keys
        await self._show(words.preflight.title, lambda: PreflightScreen(self._frame), *said)
        return await super().check(needed)

    async def agree(self, page: Consent) -> bool:
        options = page.agree, page.decline
        await self._show(
            page.title, lambda: ChoiceScreen(self._frame, page, options), page, *options
        )
        return await super().agree(page)

    async def read(self, page: Page) -> None:
        walking = page is self._study.texts.lessons.walking

        def made() -> Screen[Any]:
            return PageScreen(
                self._frame,
                page,
                *([Signs(self._mission, self._frame.words.mission)] if walking else []),
            )

        legend = legend_words(self._frame, self._mission) if walking else ()
        await self._show(page.title, made, page, *legend)
        await super().read(page)

    async def look(self, page: Page, building: Building) -> None:
        await self._show(page.title, lambda: PageScreen(self._frame, page, PlanMap(building)), page)
        await super().look(page, building)

    async def choose(self, page: Page, sheet: Sheet) -> None:
        (asked,) = sheet.asked
        name, words = f"{page.title} {asked.id}", (asked.text, *asked.anchors)

        def made() -> Screen[Any]:
            return ChoiceScreen(self._frame, page, asked.anchors, question=asked.text)

        await self._show(name, made, page, *words)
        await super().choose(page, sheet)

    async def fill(self, page: Page, sheet: Sheet) -> None:
        everything = _AllShown(self._session, sheet.items)
        words = [
            word
            for it in everything.items
            for word in (it.text, *(() if isinstance(it, HeadingItem) else it.anchors))
        ]
        await self._show(
            page.title, lambda: FormScreen(self._frame, page, everything), page, *words
        )
        await super().fill(page, sheet)

    async def prefer(self, page: Page, options: tuple[str, str]) -> Literal[1, 2]:
        await self._show(
            page.title, lambda: ChoiceScreen(self._frame, page, options), page, *options
        )
        return await super().prefer(page, options)

    async def explain(self, page: Page) -> str:
        await self._show(page.title, lambda: ReasonScreen(self._frame, page), page)
        return await super().explain(page)

    async def label(self, task: Labelling) -> None:
        words, keys = self._frame.words, self._frame.keys
        title = self._study.texts.label.title
        small = words.choose, words.answer, words.next, words.filter, words.clear, words.finish
        said = (title, words.left, *small, keys.enter, keys.letters, keys.delete, *task.names)
        await self._show(f"{title} 2", lambda: LabelScreen(self._frame, title, task), *said)
        await super().label(task)

    async def play(self, task: Playing) -> None:
        if task.goals is None and not self._mission_shown:
            self._mission_shown = True
            for page in mission_pages(self._frame, self._study, task.building):
                await self._show(page.name, page.make, *page.words)
        await super().play(task)

    async def memorise(self, task: Memorising) -> None:
        title = self._study.texts.memorise.title
        names = [room.name for room in task.building.rooms]

        def made() -> Screen[Any]:
            return MemoriseScreen(self._frame, title, task)

        words = title, self._frame.words.left, *names
        await self._show(f"Map of {task.building.name}", made, *words)
        await super().memorise(task)

    async def _show(self, name: str, make: Make, *words: Page | str) -> None:
        said = "\n".join(it if isinstance(it, str) else f"{it.title}\n{it.body}" for it in words)
        number = f"{len(self.pages) + 1:02} {name}"
        self.pages.append(await shown(self._pilot, number, make, said, pictures=self._pictures))

    async def others(self) -> None:
        """The pages that a session without trouble does not come by."""
        texts, words = self._study.texts, self._study.texts.words
        for page in (
            texts.declined,
            texts.no_place,
            texts.withdrawn,
            words.goodbye,
            filled(words.trouble, problem="study.toml changed after the first participant"),
            preceded(Page(title=texts.mission.title, body=""), texts.cut_off.mission),
        ):
            await self._show(page.title, partial(PageScreen, self._frame, page), page)
        for window in windows(self._frame, texts, self._mission):
            await self._show(window.name, window.make, *window.words)


async def rehearse(study: Study, *, pictures: bool) -> list[Rehearsed]:
    """Every page of the study, in the order of a session with the longest memorise time, and then
    those that a session without trouble does not come by; drawn where `pictures` are wanted.
    Nothing is written to the study's folder."""
    design, seed = study.settings.design, study.settings.seed
    cells = (design.cell(seed, "pilot", slot) for slot in range(design.block))
    longest = design.memorise - 1
    slot, cell = next((n, it) for n, it in enumerate(cells) if it.memorise == longest)
    held = HeldStudy(
        **{name: getattr(study, name) for name in study.__dataclass_fields__ if name != "folder"},
        folder=Path(os.devnull),
        taken=SlotTaken(participant="CHECK", mode="pilot", slot=slot, cell=cell),
    )
    clock, sink = VirtualClock(), MemorySink()
    session = open_session(
        held, Identity("pilot", "CHECK"), None, clock=clock, rescuer="check", sink=lambda _: sink
    )
    frame = Frame(study.settings.screen, study.texts.words)
    size = frame.size.columns, frame.size.rows
    async with Showing(frame.size.look).run_test(size=size) as pilot:
        person = _Rehearsal(session, clock, frame, pilot, pictures=pictures)
        await conduct(session, person)
        await person.others()
    return person.pages


def rehearsed(study: Study, *, pictures: bool = True) -> list[Rehearsed]:
    """The same, without an event loop around."""
    return asyncio.run(rehearse(study, pictures=pictures))


def found_wrong(study: Study, *, pictures: bool = False) -> tuple[list[str], list[Rehearsed]]:
    """Everything that `ana study check` finds wrong, in words, and the pages that it opened."""
    pages = rehearsed(study, pictures=pictures)
    hidden = [
        f"page {page.name}: these words are cut off or hidden: {' '.join(page.missing)}"
        for page in pages
        if page.missing
    ]
    too_tall = [
        f"page {page.name}: the question {question} has {rows} rows more than fit, so it is never "
        "wholly in view; shorten it"
        for page in pages
        for question, rows in page.too_tall.items()
    ]
    return [*shortfalls(study), *hidden, *too_tall], pages
