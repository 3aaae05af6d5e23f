"""The tasks of a participant, and how what they do gets into the journal.

Screens and simulated people work on the same task objects, which do all the recording.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from game.coach.instructions.phrasebook import Phrasebook
from game.coach.spec import CoachSpec
from game.journal.records import Exposed, QuestionnaireAnswer, QuizAnswer
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


@dataclass(frozen=True)
class Asked:
    """One questionnaire item as shown; values run from `low` to `high`."""

    item: str
    text: str
    anchors: tuple[str, ...]
    low: int
    high: int


class Sheet:
    """A page of questions, in the order shown."""

    def __init__(self, session: StudySession, asked: tuple[Asked, ...]) -> None:
        self.asked = asked
        self._session = session
        self._shown_ms = session.now_ms()

    def begin(self) -> None:
        """The page is on the screen from now on."""
        self._shown_ms = self._session.now_ms()

    def value(self, asked: Asked) -> int | None:
        """The answer given so far."""
        answer = self._session.history.items.get((self._session.step, asked.item))
        return None if answer is None else answer.value

    @property
    def complete(self) -> bool:
        return all(self.value(asked) is not None for asked in self.asked)

    @property
    def missing(self) -> tuple[Asked, ...]:
        return tuple(asked for asked in self.asked if self.value(asked) is None)

    async def answer(self, asked: Asked, value: int) -> None:
        """Record an answer unless it is unchanged. Raises ValueError if it is out of range."""
        if not asked.low <= value <= asked.high:
            raise ValueError(f"{asked.item} is answered from {asked.low} to {asked.high}")
        before = self._session.history.items.get((self._session.step, asked.item))
        if before is not None and before.value == value:
            return
        await self._session.save(
            QuestionnaireAnswer(
                item=asked.item,
                text=asked.text,
                anchors=asked.anchors,
                place=self.asked.index(asked),
                value=value,
                response_ms=self._session.now_ms() - self._shown_ms,
                changes=0 if before is None else before.changes + 1,
                version=self._session.study.version,
            )
        )


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
