"""A scripted participant who always answers the same and needs no screen."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Literal

import pytest

from game.forms.items import SliderItem
from game.journal.clock import VirtualClock
from game.journal.history import Step
from game.journal.reader import Transcript, read_journal
from game.journal.records import PhaseStarted, Preflighted, Terminal
from game.journal.sink import FileSink, Sink
from game.study.folder import Identity, Study, new_study, open_study
from game.study.protocol.conduct import conduct
from game.study.protocol.study_session import open_session
from game.study.protocol.tasks import Labelling, Memorising, Playing, Sheet
from game.study.study_settings import ScreenSize
from game.study.texts import Consent, Page
from game.world.building import Building
from game.world.events import Action
from game.world.floodfill import cost_to_go
from game.world.geometry import Cell, Heading
from game.world.plan import Plan

TERMINAL = Terminal("xterm-256color", "", 120, 40)
P01 = Identity("pilot", "P01")
MISSION_MS = 6_000


def small_study(folder: Path, **changes: str) -> Study:
    """A study whose timed phases take seconds; `changes` replace values in study.toml, or add
    mission rules that it does not list."""
    new_study(folder, seed=7, blocks=1)
    quick = {
        "memorise_seconds": "[3, 5]",
        "label_seconds": "6",
        "duration_ms": str(MISSION_MS),
    }
    return with_settings(open_study(folder), quick | changes)


def with_settings(study: Study, changes: Mapping[str, str]) -> Study:
    """The study with values in study.toml replaced, and mission rules added that it lacks."""
    values, path = dict(changes), study.folder / "study.toml"
    lines = [
        f"{key} = {values.pop(key)}" if (key := line.partition(" = ")[0]) in values else line
        for line in path.read_text().splitlines()
    ]
    rules = [f"{key} = {value}" for key, value in values.items()]
    first = 1 + next(n for n, line in enumerate(lines) if line.startswith("[mission]"))
    path.write_text("\n".join([*lines[:first], *rules, *lines[first:]]) + "\n")
    return open_study(study.folder)


class Scripted:
    """Agrees, labels every other room correctly, walks north, and rates everything 3 or 42.

    Before each thing it does, `moment` is told what: it may raise to cut the session off there.
    """

    def __init__(
        self,
        clock: VirtualClock,
        *,
        agrees: bool = True,
        labels: bool = True,
        moment: Callable[[str], None] = lambda _: None,
    ) -> None:
        self.clock = clock
        self.agrees = agrees
        self.labels = labels
        self.moment = moment
        self.read_pages: list[Page] = []
        self.slider_pages: list[Page] = []

    async def check(self, needed: ScreenSize) -> Preflighted:
        self._do("check")
        return Preflighted(TERMINAL, "256", keys_work=True, enough=True)

    async def agree(self, page: Consent) -> bool:
        self._do("agree")
        return self.agrees

    async def read(self, page: Page) -> None:
        self._do("read")
        self.read_pages.append(page)

    async def look(self, page: Page, building: Building) -> None:
        self._do("look")

    async def memorise(self, task: Memorising) -> None:
        task.exposure.begin()
        while not task.exposure.over:
            self._do("memorise")
            task.exposure.tick()

    async def label(self, task: Labelling) -> None:
        task.exposure.begin()
        for room in task.rooms[::2] if self.labels else ():
            task.show(room)
            self.clock.now_ms += 100
            task.exposure.tick()
            self.moment("label")
            await task.give(room, room.name)

    async def play(self, task: Playing) -> None:
        run = task.begin()
        zero_ms = self.clock.now_ms
        goal = task.building.victims[0].cell
        while not task.done:
            self._do("play")
            now_ms = self.clock.now_ms - zero_ms
            if task.goals is None:
                run.press(Action.NORTH, now_ms)
                task.tick(now_ms)
            elif run.mission.victim_in_reach() is None:
                run.press(towards(task.building.plan, run.mission.position, goal), now_ms)
            else:
                run.press(Action.TRIAGE, now_ms)

    async def choose(self, page: Page, sheet: Sheet) -> None:
        await self._answer(sheet, 2)

    async def fill(self, page: Page, sheet: Sheet) -> None:
        if any(isinstance(question, SliderItem) for question in sheet.asked):
            self.slider_pages.append(page)
            await self._answer(sheet, 42)
        else:
            await self._answer(sheet, 3)

    async def prefer(self, page: Page, options: tuple[str, str]) -> Literal[1, 2]:
        self._do("prefer")
        return 2

    async def explain(self, page: Page) -> str:
        self._do("explain")
        return "clearer"

    async def _answer(self, sheet: Sheet, value: int) -> None:
        sheet.begin()
        for asked in sheet.missing:
            self._do("answer")
            await sheet.answer(asked, value)

    def _do(self, what: str) -> None:
        self.clock.now_ms += 500
        self.moment(what)


def towards(plan: Plan, here: Cell, goal: Cell) -> Action:
    """The action that leads closer to `goal`."""
    values = cost_to_go(plan, goal)
    best = min(
        (heading for heading in Heading if plan.walkable(heading.from_cell(here))),
        key=lambda heading: values[plan.index(heading.from_cell(here))],
    )
    return Action(best.name.lower())


class QuickSink(FileSink):
    """Passes lines to the operating system and does not wait for the disk."""

    def flush_durably(self) -> None:
        self._check()


def take_part(
    study: Study,
    identity: Identity = P01,
    *,
    sink: Callable[[Path], Sink] = QuickSink.begin,
    agrees: bool = True,
    labels: bool = True,
    moment: Callable[[str], None] = lambda _: None,
    clock: VirtualClock | None = None,
) -> tuple[str, Scripted]:
    """Conduct a scripted participant's session; returns the outcome and the participant."""
    clock = clock or VirtualClock()
    person = Scripted(clock, agrees=agrees, labels=labels, moment=moment)
    session = open_session(study, identity, TERMINAL, clock=clock, sink=sink)
    return asyncio.run(conduct(session, person)), person


def cut_off(study: Study, identity: Identity, *, at: str, since: str = "", times: int = 1) -> None:
    """Cut a participant off when they do `at` so many times after they did `since`."""

    class Cut(Exception):
        pass

    left, counting = times, not since

    def moment(what: str) -> None:
        nonlocal left, counting
        counting |= what == since
        left -= counting and what == at
        if left == 0:
            raise Cut

    with pytest.raises(Cut):
        take_part(study, identity, moment=moment)


def journal_of(study: Study, identity: Identity = P01) -> Transcript:
    return read_journal(study.home(identity) / "journal.jsonl")


def rewind(study: Study, step: Step) -> None:
    """Cut a finished session back to just before `step` begins, as after a kill."""
    entries = journal_of(study).entries
    cut = next(
        number
        for number, entry in enumerate(entries)
        if isinstance(entry.record, PhaseStarted)
        and (entry.envelope.phase, entry.envelope.round) == step
    )
    path = study.home(P01) / "journal.jsonl"
    path.write_bytes(b"".join(path.read_bytes().splitlines(keepends=True)[:cut]))
    ledger = study.folder / "ledger.jsonl"
    lines = ledger.read_bytes().splitlines(keepends=True)
    ledger.write_bytes(b"".join(line for line in lines if b'"session_ended"' not in line))


def finished_study(folder: Path) -> Study:
    """A small study in which one scripted participant has finished."""
    study = small_study(folder)
    assert take_part(study)[0] == "over"
    return study
