"""A simulated participant of a study, who reads, memorises, labels, plays and answers."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Literal

from game.forms.items import (
    Answer,
    AnyQuestion,
    ChoiceItem,
    NumberItem,
    ScaleItem,
    SliderItem,
    TextItem,
    Weights,
)
from game.journal.clock import VirtualClock
from game.journal.records import ROUNDS, Preflighted, Terminal
from game.rescuers.driver import drive
from game.rescuers.interpreter import interpreted
from game.rescuers.person import BoundedPerson, MapMemory, Population, drawn, memorised
from game.rescuers.person.experience import Experience
from game.rescuers.person.memory import nothing_memorised
from game.rescuers.person.quiz import labels
from game.rescuers.person.randomness import stream
from game.rescuers.person.responses import Respondent
from game.study.protocol.study_session import StudySession
from game.study.protocol.tasks import Exposure, Labelling, Memorising, Playing, Sheet
from game.study.study_settings import ScreenSize
from game.study.texts import Consent, Page
from game.world.building import Building

TICK_MS = 1_000
LOOK_MS = 30_000
"""How long they look at the map of the practice building."""
ANSWER_MS = 2_500
"""The time to read an item and decide on an answer."""
UNDERSTOOD = 0.9
"""The probability of a right answer to each question of the practice check."""
ATTENTIVE = 0.95
"""The probability of a right answer to a question in a form that has one."""
WRITTEN = "simulated"
"""What they write where something must be written."""
SECOND_ROUND_WEARINESS = 0.5


class SimulatedParticipant:
    """One person of `population`, drawn by the session's seed, who advances `clock` by the time
    that everything takes."""

    def __init__(self, session: StudySession, clock: VirtualClock, population: Population) -> None:
        self._session = session
        self._clock = clock
        self._seed = session.seed, "person"
        self._traits = drawn(population, *self._seed)
        self._respondent = Respondent(population, self._traits, *self._seed)
        self._maps: dict[str, MapMemory] = {}
        self._experiences: dict[int, Experience] = {}
        self._legs = 0

    def come_back(self, session: StudySession) -> None:
        """Take part in what is left of the session, after a break."""
        self._session = session

    async def check(self, needed: ScreenSize) -> Preflighted:
        self._pass(5 * TICK_MS)
        terminal = Terminal("simulated", "", needed.columns, needed.rows)
        return Preflighted(terminal, "none", keys_work=True, enough=True)

    async def agree(self, page: Consent) -> bool:
        self._read(page)
        return True

    async def read(self, page: Page) -> None:
        self._read(page)

    async def look(self, page: Page, building: Building) -> None:
        self._read(page)
        self._pass(LOOK_MS)
        self._memorise(building, LOOK_MS)

    async def memorise(self, task: Memorising) -> None:
        self._memorise(task.building, task.exposure.left_ms)
        task.exposure.begin()
        while not task.exposure.over:
            self._pass(TICK_MS)
            task.exposure.tick()

    async def label(self, task: Labelling) -> None:
        memory = self._map_of(task.building)
        chance = stream(*self._seed, "quiz", self._round)
        given = labels(memory, self._traits, task.rooms, task.names, chance)
        task.exposure.begin()
        for room in task.rooms:
            task.show(room)
            self._pass_within(task.exposure, round(self._traits.recall_quiz_ms))
            if task.exposure.over:
                return
            name = given.get(room.label)
            if name is not None:
                await task.give(room, name)

    async def play(self, task: Playing) -> None:
        run = task.begin()
        zero_ms = self._clock.now_ms
        if task.goals is None:
            purpose: tuple[object, ...] = ("mission", self._round)
        else:
            self._legs += 1
            purpose = ("practice", self._legs)
        second = self._round > ROUNDS[0]
        person = BoundedPerson(
            self._traits,
            self._map_of(task.building),
            task.settings.controls,
            stream(*self._seed, *purpose),
            weariness=SECOND_ROUND_WEARINESS if second else 0.0,
        )

        def passing(now_ms: int) -> None:
            self._clock.now_ms = zero_ms + now_ms
            if task.goals is None:
                task.tick(now_ms)

        if task.goals is None:
            self._experiences[self._round] = person.experience
        reader = interpreted(person, self._session.study.phrases, task.building)
        drive(run, reader, passing=passing, done=lambda: task.done)

    async def choose(self, page: Page, sheet: Sheet) -> None:
        for question in self._asked(page, sheet):
            chance = stream(*self._seed, "check", question.id)
            right = question.rights[0]
            wrong = [v for v in range(question.least, question.most + 1) if v != right]
            understood = chance.random() < UNDERSTOOD
            await sheet.answer(question, right if understood else chance.choice(wrong))

    async def fill(self, page: Page, sheet: Sheet) -> None:
        for question in self._asked(page, sheet):
            value = self._answer(question)
            if value is not None:
                await sheet.answer(question, value)
            if isinstance(question, ChoiceItem) and question.has_other(value) and question.required:
                await sheet.write_other(question, WRITTEN)

    async def prefer(self, page: Page, options: tuple[str, str]) -> Literal[1, 2]:
        self._read(page)
        first, second = (self._experiences[round_] for round_ in ROUNDS)
        return self._respondent.preferred(first, second)

    async def explain(self, page: Page) -> str:
        self._read(page)
        return ""

    # --- time and memory ------------------------------------------------------------------------

    @property
    def _round(self) -> int:
        return self._session.step.round

    def _memorise(self, building: Building, looked_ms: int) -> None:
        chance = stream(*self._seed, "map", building.name, self._round)
        self._maps[building.name] = memorised(building, looked_ms, self._traits, chance)

    def _map_of(self, building: Building) -> MapMemory:
        return self._maps.get(building.name) or nothing_memorised(building)

    def _asked(self, page: Page, sheet: Sheet) -> Iterator[AnyQuestion]:
        """The questions still to be answered, each after the time it takes to answer."""
        self._read(page)
        sheet.begin()
        met = {it.id for it in sheet.asked if sheet.answered(it)}
        while (question := next((it for it in sheet.asked if it.id not in met), None)) is not None:
            met.add(question.id)
            self._pass(ANSWER_MS)
            yield question

    def _answer(self, question: AnyQuestion) -> Answer | None:
        """An answer; what is no slider or scale is answered at random, and rightly if there is a
        right answer. TextItem are written only where they must be."""
        step = self._session.step
        occasion = step.round or (0 if "." not in step.phase else step.phase)
        happened = self._experiences.get(step.round)
        chance = stream(*self._seed, "answer", question.id, occasion)
        if question.right is not None and chance.random() < ATTENTIVE:
            several = isinstance(question, ChoiceItem) and question.several
            return question.rights if several else question.rights[0]
        weights = None
        if isinstance(question, SliderItem | ScaleItem):
            weights = question.weights or (Weights(valence=-1) if question.reverse else None)
        match question:
            case SliderItem():
                ends = question.least, question.most
                return self._respondent.slider(question.id, occasion, happened, ends, weights)
            case ScaleItem():
                return self._respondent.scale(
                    question.id, occasion, happened, question.most, weights
                )
            case ChoiceItem(several=True):
                positions = range(question.least, question.most + 1)
                return tuple(n for n in positions if chance.random() < 0.5) or (question.least,)
            case ChoiceItem() | NumberItem():
                return chance.randint(question.least, question.most)
            case TextItem():
                return WRITTEN[: question.length] if question.required else None

    def _read(self, page: Page) -> None:
        words = len(page.title.split()) + len(page.body.split())
        self._pass(round(words * self._traits.ms_per_word + self._traits.reaction_ms))

    def _pass(self, ms: int) -> None:
        self._clock.now_ms += ms

    def _pass_within(self, exposure: Exposure, ms: int) -> None:
        """Let time pass in a timed phase, second by second, but no longer than it lasts."""
        until_ms = self._clock.now_ms + min(ms, exposure.left_ms)
        while self._clock.now_ms < until_ms:
            self._pass(min(TICK_MS, until_ms - self._clock.now_ms))
            exposure.tick()
