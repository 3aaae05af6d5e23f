"""The tasks of a participant, and how what they do gets into the journal.

Screens and simulated people work on the same task objects, which do all the recording.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from game.coach.instructions.phrasebook import Phrasebook
from game.coach.spec import CoachSpec
from game.forms.form import shown
from game.forms.items import OTHER, Answer, AnyQuestion, ChoiceItem, HeadingItem, Item, TextItem
from game.journal.records import (
    AnswerCleared,
    ChoicesGiven,
    Exposed,
    FreeText,
    QuestionnaireAnswer,
    QuizAnswer,
    Record,
)
from game.session.playing import begin_mission, leave_mission
from game.session.run import MissionRun
from game.study.chance import number, shuffled
from game.study.protocol.study_session import StudySession
from game.world.building import Building, Room
from game.world.settings import MissionSettings

EXPOSED_EVERY_MS = 1000


class Exposure:
    """How long a timed phase has been on the screen, in all segments together."""

    def __init__(self, session: StudySession, limit_ms: int, before_ms: int = 0) -> None:
        self.limit_ms = limit_ms
        self._session = session
        self._before_ms = min(before_ms, limit_ms)
        self._zero_ms: int | None = None
        self._told_ms = self._before_ms
        self._covered_ms = 0
        self._covered_at: int | None = None

    def cover(self) -> None:
        """Nothing of it can be seen from now on: its clock stands still."""
        self._covered_at = self._session.now_ms()

    def uncover(self) -> None:
        """It can be seen again."""
        if self._covered_at is not None:
            self._covered_ms += self._session.now_ms() - self._covered_at
            self._covered_at = None

    def begin(self) -> None:
        """The task is on the screen from now on."""
        self._zero_ms = self._session.now_ms()
        self._covered_ms = 0
        if self._covered_at is not None:
            self._covered_at = self._zero_ms

    @property
    def seen_ms(self) -> int:
        """How long it has been on the screen, at most the limit."""
        now_ms = self._session.now_ms() if self._covered_at is None else self._covered_at
        since = 0 if self._zero_ms is None else max(0, now_ms - self._zero_ms - self._covered_ms)
        return min(self.limit_ms, self._before_ms + since)

    @property
    def left_ms(self) -> int:
        return self.limit_ms - self.seen_ms

    @property
    def over(self) -> bool:
        return self.left_ms == 0

    def tick(self) -> None:
        """Record the exposure if a second has passed; call this a few times a second."""
        seen_ms = self.seen_ms
        if seen_ms - self._told_ms >= EXPOSED_EVERY_MS:
            self._told_ms = seen_ms - seen_ms % EXPOSED_EVERY_MS
            self._session.record(Exposed(seen_ms))


@dataclass(frozen=True)
class Memorising:
    """A map to look at until `exposure` is over. It shows no victims."""

    building: Building
    exposure: Exposure


class Labelling:
    """Rooms to be named. Each name belongs to one room at most."""

    def __init__(self, session: StudySession, building: Building, exposure: Exposure) -> None:
        seed, round_ = session.seed, session.step.round
        self.building = building
        self.exposure = exposure
        self.rooms: tuple[Room, ...] = shuffled(
            building.rooms, lambda room: room.name, seed, "rooms", round_
        )
        """In the order shown."""
        self.names = tuple(
            room.name
            for room in shuffled(building.rooms, lambda room: room.name, seed, "names", round_)
        )
        self._session = session
        self._shown_ms: dict[str, int] = {}

    @property
    def given(self) -> Mapping[str, str]:
        """The names given so far, by the true names of the rooms."""
        return self._session.history.names_given(self._session.step.round)

    @property
    def right(self) -> int:
        """How many rooms have their true name."""
        return sum(room == name for room, name in self.given.items())

    def show(self, room: Room) -> None:
        """The room is now the one asked about."""
        self._shown_ms[room.name] = self._session.now_ms()

    async def give(self, room: Room, name: str | None) -> None:
        """Give `name` to the room (None: clear its name), and take it from any other room."""
        now_ms = self._session.now_ms()
        response_ms = now_ms - self._shown_ms.get(room.name, now_ms)
        answers = [
            QuizAnswer(other, None, False, response_ms, self._session.study.version)
            for other, given in self.given.items()
            if given == name and other != room.name
        ]
        answers.append(
            QuizAnswer(room.name, name, name == room.name, response_ms, self._session.study.version)
        )
        await self._session.save(*answers)


class Sheet:
    """A page of items, in the order shown, and the answers given so far."""

    def __init__(self, session: StudySession, items: Sequence[Item]) -> None:
        self.items = tuple(items)
        self.questions: tuple[AnyQuestion, ...] = tuple(
            it for it in self.items if not isinstance(it, HeadingItem)
        )
        """Every question, shown or not."""
        self._session = session
        self._shown_ms = session.now_ms()

    def begin(self) -> None:
        """The page is on the screen from now on."""
        self._shown_ms = self._session.now_ms()

    @property
    def shown(self) -> tuple[Item, ...]:
        """The items that are shown, as the answers are now."""
        return shown(self.items, self._earlier)

    @property
    def asked(self) -> tuple[AnyQuestion, ...]:
        """The questions among them."""
        return tuple(it for it in self.shown if not isinstance(it, HeadingItem))

    def value(self, question: AnyQuestion) -> Answer | None:
        """The answer given so far."""
        return self._session.history.answer(self._session.step, question.id)

    def other(self, question: AnyQuestion) -> str:
        """What was written beside the answer `other`."""
        words = self._session.history.words.get((self._session.step, question.id + OTHER))
        return "" if words is None else words.answer

    def answered(self, question: AnyQuestion) -> bool:
        """Whether there is an answer; where something must be written, words as well."""
        value = self.value(question)
        if isinstance(question, TextItem):
            return bool(value)
        if isinstance(question, ChoiceItem) and question.has_other(value):
            return bool(self.other(question)) or not question.required
        return value is not None

    @property
    def missing(self) -> tuple[AnyQuestion, ...]:
        """The questions that must be answered, and are not."""
        return tuple(it for it in self.asked if it.required and not self.answered(it))

    @property
    def complete(self) -> bool:
        return not self.missing

    async def answer(self, question: AnyQuestion, value: Answer) -> None:
        """Record an answer unless it is unchanged. Raises ValueError for one that cannot be."""
        if not question.allows(value):
            raise ValueError(f"{question.id} is not answered by {value!r}")
        if self.value(question) != value:
            await self._session.save(self._record(question, value))
        if isinstance(question, ChoiceItem) and not question.has_other(value):
            await self._clear(question.id + OTHER, hidden=True)

    async def write_other(self, question: ChoiceItem, words: str) -> None:
        """Record what was written beside the answer `other`, unless it is unchanged."""
        if self.other(question) != words:
            await self._session.save(self._words(question.id + OTHER, question.other, words))

    async def clear(self, question: AnyQuestion, *, hidden: bool = False) -> None:
        """Take an answer back, with what was written beside it."""
        for name in (question.id, question.id + OTHER):
            await self._clear(name, hidden=hidden)

    async def _clear(self, name: str, *, hidden: bool) -> None:
        if self._session.history.answer(self._session.step, name) is not None:
            await self._session.save(
                AnswerCleared(
                    item=name,
                    hidden=hidden,
                    response_ms=self._session.now_ms() - self._shown_ms,
                    version=self._session.study.version,
                )
            )

    async def close(self) -> None:
        """Take back what was answered to questions that are no longer shown."""
        asked = {question.id for question in self.asked}
        for question in self.questions:
            if question.id not in asked:
                await self.clear(question, hidden=True)

    def _earlier(self, item: str) -> Answer | None:
        here = self._session.history.answer(self._session.step, item)
        if here is not None:
            return here
        if any(question.id == item for question in self.questions):
            return None
        return self._session.history.latest_answer(item, self._session.step.round)

    def _record(self, question: AnyQuestion, value: Answer) -> Record:
        if isinstance(value, str):
            return self._words(question.id, question.text, value)
        step, history = self._session.step, self._session.history
        before = history.items.get((step, question.id)) or history.choices.get((step, question.id))
        shared: dict[str, Any] = {
            "item": question.id,
            "text": question.text,
            "anchors": question.anchors,
            "place": self.questions.index(question),
            "response_ms": self._session.now_ms() - self._shown_ms,
            "changes": 0 if before is None else before.changes + 1,
            "version": self._session.study.version,
        }
        if isinstance(value, tuple):
            return ChoicesGiven(chosen=value, **shared)
        return QuestionnaireAnswer(value=value, **shared)

    def _words(self, item: str, text: str, words: str) -> FreeText:
        now_ms = self._session.now_ms() - self._shown_ms
        return FreeText(item, text, words, now_ms, version=self._session.study.version)


class Playing:
    """A mission to play. It ends early after `goals` rescues, as a practice leg does (None: it
    runs its full time)."""

    def __init__(
        self,
        session: StudySession,
        building: Building,
        spec: CoachSpec,
        settings: MissionSettings,
        name: str,
        *,
        goals: int | None = None,
    ) -> None:
        self.building = building
        self.spec = spec
        self.settings = settings
        self.goals = goals
        self.home = session.study.home(session.identity)
        self.journal = session.journal
        self.clock = session.clock
        self.run: MissionRun | None = None
        self._session = session
        self._seed = number(session.seed, "mission", name)
        self._told_ms = 0
        self._left = False

    def begin(self) -> MissionRun:
        """Begin the mission, at 0 ms."""
        self.run = begin_mission(
            self.journal, self.building, self.settings, self.spec, self._seed,
            phrases=self.phrases,
        )  # fmt: skip
        return self.run

    @property
    def phrases(self) -> Phrasebook:
        """What the instructor says."""
        return self._session.study.phrases

    @property
    def done(self) -> bool:
        """Whether there is nothing left to do."""
        run = self.run
        if run is None:
            return False
        return run.ended or (self.goals is not None and run.mission.rescued >= self.goals)

    def leave(self, now_ms: int) -> None:
        """Leave the mission at mission time `now_ms`, unless it has ended or been left already."""
        if self.run is not None and not self.run.ended and not self._left:
            self._left = True
            leave_mission(self.run, self.journal, now_ms, "leg_done" if self.done else "quit")

    def tick(self, now_ms: int) -> None:
        """Record how long the mission has been on the screen if a second has passed."""
        if now_ms - self._told_ms >= EXPOSED_EVERY_MS:
            self._told_ms = now_ms - now_ms % EXPOSED_EVERY_MS
            self._session.record(Exposed(now_ms))
