"""What happened, according to a journal: the one place that adds up its records.

A live session and the experimenter's screen feed a `History` record by record; `read_history` makes
one from a whole journal. Everything else asks these.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from typing import Literal, NamedTuple

from game.coach.acts import (
    CoachAct,
    Disobeyed,
    InstructionIssued,
    Level,
    LevelChanged,
    LostNoticed,
    Misstep,
)
from game.journal.reader import Entry, Transcript
from game.journal.records import (
    Allocated,
    AnswerCleared,
    ChoicesGiven,
    Consented,
    Covered,
    Declined,
    Envelope,
    Exposed,
    FreeText,
    Interruption,
    MissionAbandoned,
    MissionStarted,
    Phase,
    PhaseEnded,
    PhaseStarted,
    PracticeChecked,
    PreferenceGiven,
    QuestionnaireAnswer,
    QuizAnswer,
    QuizSubmitted,
    Record,
    Resumed,
    RunRecord,
    SessionEnded,
    SessionStarted,
    StepEnding,
    StudyAmended,
    TakenOver,
    Terminal,
    Versions,
    Withdrawn,
)
from game.world.building import Building
from game.world.events import Acted, Event, Expired, MissionEnded, Outcome, Rescued
from game.world.geometry import Cell
from game.world.reading import kept_building

PhaseEnding = Literal["completed", "timed_out", "interrupted", "void"]


class Step(NamedTuple):
    """One phase of a session; `round` is 0 outside the rounds."""

    phase: Phase
    round: int = 0


class Happening(NamedTuple):
    """A mission event or coach record, and its line in the journal."""

    line: int
    record: RunRecord


class LevelSpan(NamedTuple):
    """A stretch of a mission at one level, in mission time; `comprehension` is what led to it,
    None for the first level and for a coach that does not judge by it."""

    level: Level
    from_ms: int
    until_ms: int
    comprehension: float | None


@dataclass
class MissionHistory:
    """One mission, as far as its records have been noted.

    `end` is `ended`, `abandoned` (the player left it at `until_ms`), `cut` (the process ended; the
    last events may be missing) or `dropped` (the session continued without either, which no game
    does). `until_ms` is the mission time of its end so far. `path` holds the cells walked to,
    `fates` when each victim was rescued or expired, `disobeyed` the kinds of disobedience in order.
    `texts` counts how often the words on the bar changed. `level_changes` holds when each level
    came into force, the level, and the comprehension that led to it.
    """

    line: int
    step: Step
    started: MissionStarted
    happened: list[Happening] = field(default_factory=list)
    end: Literal["ended", "abandoned", "cut", "dropped"] = "cut"
    until_ms: int = 0
    path: list[Cell] = field(default_factory=list)
    fates: dict[str, tuple[Literal["rescued", "expired"], int]] = field(default_factory=dict)
    actions: int = 0
    missteps: int = 0
    lost: int = 0
    disobeyed: list[str] = field(default_factory=list)
    texts: int = 0
    level_changes: list[tuple[int, Level, float | None]] = field(default_factory=list)
    _text: str = ""

    def note(self, line: int, record: RunRecord) -> None:
        """Take account of one record of the mission."""
        self.happened.append(Happening(line, record))
        self.until_ms = max(self.until_ms, record.at_ms)
        match record:
            case Acted():
                self.actions += 1
                if record.outcome is Outcome.MOVED:
                    self.path.append(record.position)
            case Rescued():
                self.fates[record.victim] = "rescued", record.at_ms
            case Expired():
                self.fates[record.victim] = "expired", record.at_ms
            case InstructionIssued():
                if not self.level_changes:
                    self.level_changes.append((record.at_ms, record.level, None))
                self.texts += record.text != self._text
                self._text = record.text
            case LevelChanged():
                self.level_changes.append((record.at_ms, record.after, record.comprehension))
            case Misstep():
                self.missteps += 1
            case LostNoticed():
                self.lost += 1
            case Disobeyed():
                self.disobeyed.append(record.kind)
            case MissionEnded():
                self.end = "ended"
            case _:
                pass

    @property
    def records(self) -> Iterator[RunRecord]:
        return (happening.record for happening in self.happened)

    def levels(self) -> Iterator[LevelSpan]:
        """The stretches at one level; empty ones are left out."""
        ends = [*(at_ms for at_ms, _, _ in self.level_changes[1:]), self.until_ms]
        for (from_ms, level, comprehension), end_ms in zip(self.level_changes, ends, strict=False):
            if end_ms > from_ms:
                yield LevelSpan(level, from_ms, end_ms, comprehension)

    def drop(self) -> None:
        """The session continued although the mission had no end."""
        if self.end == "cut":
            self.end = "dropped"


@dataclass
class PhaseSpan:
    """How one phase went; `starts` counts how often it was started or continued."""

    started_utc: str
    ended_utc: str | None = None
    ending: StepEnding = "unfinished"
    exposure_ms: int = 0
    starts: int = 0
    covered_ms: int = 0

    @property
    def broke_off(self) -> bool:
        return self.starts > 1 or self.ending in ("interrupted", "void")


@dataclass
class History:
    """A session, as far as its records have been noted. The last answer to each question counts.

    `begun` is the current step, `exposure_ms` how long it has been on the screen, and `limit_ms`
    the time it had left when it last started. `endings` holds how earlier steps ended. `over` is
    true if nothing can follow. `left` is the session's end, if that is the last record. `strays`
    holds mission events and coach records outside every mission; there should be none.
    """

    versions: Versions | None = None
    terminal: Terminal | None = None
    started_utc: str = ""
    ended_utc: str = ""
    step: Step = field(default_factory=lambda: Step("session"))
    begun: Step | None = None
    exposure_ms: int = 0
    limit_ms: int | None = None
    endings: dict[Step, PhaseEnding] = field(default_factory=dict)
    ending: Literal["finished", "declined", "turned_away", "unfinished"] = "unfinished"
    over: bool = False
    left: SessionEnded | None = None
    consent_version: str | None = None
    allocated: Allocated | None = None
    practice: PracticeChecked | None = None
    preference: PreferenceGiven | None = None
    torn_bytes: int = 0
    resumed: int = 0
    interruptions: int = 0
    takeovers: int = 0
    amendments: int = 0
    phases: dict[Step, PhaseSpan] = field(default_factory=dict)
    items: dict[tuple[Step, str], QuestionnaireAnswer] = field(default_factory=dict)
    choices: dict[tuple[Step, str], ChoicesGiven] = field(default_factory=dict)
    labels: dict[tuple[int, str], tuple[QuizAnswer, int]] = field(default_factory=dict)
    quizzes: dict[int, QuizSubmitted] = field(default_factory=dict)
    words: dict[tuple[Step, str], FreeText] = field(default_factory=dict)
    missions: list[MissionHistory] = field(default_factory=list)
    strays: list[Entry] = field(default_factory=list)
    _mission: MissionHistory | None = None

    @property
    def declined(self) -> bool:
        return self.ending == "declined"

    @property
    def treated_in_practice(self) -> int:
        """How many victims were treated in practice."""
        return sum(
            fate == "rescued"
            for mission in self.missions
            if mission.step.phase == "practice"
            for fate, _ in mission.fates.values()
        )

    def answer(self, step: Step, item: str) -> int | tuple[int, ...] | str | None:
        """The answer that counts, to an item in a step: a value, the positions of all that were
        chosen, or words."""
        if (number := self.items.get((step, item))) is not None:
            return number.value
        if (chosen := self.choices.get((step, item))) is not None:
            return chosen.chosen
        words = self.words.get((step, item))
        return None if words is None else words.answer

    def latest_answer(self, item: str, round_: int) -> int | tuple[int, ...] | str | None:
        """The answer to an item in a round, or else wherever it was last given."""
        steps = [step for kept in (self.items, self.choices) for step, name in kept if name == item]
        here = [step for step in steps if step.round == round_]
        return self.answer((here or steps)[-1], item) if steps else None

    def is_void(self, round_: int) -> bool:
        return any(
            step.round == round_ and span.ending == "void" for step, span in self.phases.items()
        )

    def names_given(self, round_: int) -> dict[str, str]:
        """The names given to rooms in a round, by the rooms' true names."""
        return {
            room: answer.answer
            for (number, room), (answer, _) in self.labels.items()
            if number == round_ and answer.answer is not None
        }

    def note(self, envelope: Envelope, record: Record | None, line: int = 0) -> None:
        """Take account of one record; None if only its envelope is known."""
        step = Step(envelope.phase, envelope.round)
        self.started_utc = self.started_utc or envelope.utc
        self.ended_utc = envelope.utc
        if envelope.phase != "session":
            self.step = step
        self.left = record if isinstance(record, SessionEnded) else None
        match record:
            case None:
                pass
            case Event() | CoachAct():
                if self._mission is None:
                    self.strays.append(Entry(line, envelope, record))
                else:
                    self._mission.note(line, record)
            case MissionStarted() | MissionAbandoned():
                self._note_mission(step, record, line)
            case PhaseStarted() | PhaseEnded() | Exposed() | Covered():
                self._note_phase(step, envelope.utc, record)
            case QuizAnswer() | QuizSubmitted():
                self._note_label(step, record)
            case QuestionnaireAnswer() | ChoicesGiven() | FreeText() | AnswerCleared():
                self._note_answer(step, record)
            case _:
                self._note_frame(record)

    def _note_label(self, step: Step, record: QuizAnswer | QuizSubmitted) -> None:
        match record:
            case QuizAnswer():
                _, before = self.labels.get((step.round, record.room), (None, -1))
                self.labels[step.round, record.room] = record, before + 1
            case QuizSubmitted():
                self.quizzes[step.round] = record

    def _note_answer(
        self, step: Step, record: QuestionnaireAnswer | ChoicesGiven | FreeText | AnswerCleared
    ) -> None:
        match record:
            case QuestionnaireAnswer():
                self.items[step, record.item] = record
            case ChoicesGiven():
                self.choices[step, record.item] = record
            case FreeText():
                self.words[step, record.item] = record
            case AnswerCleared():
                self.items.pop((step, record.item), None)
                self.choices.pop((step, record.item), None)
                self.words.pop((step, record.item), None)

    def _note_once(self, record: Record) -> None:
        match record:
            case Consented():
                self.consent_version = record.version
            case Declined():
                self.consent_version = record.version
                self.ending, self.over = "declined", True
            case PracticeChecked():
                self.practice = record
            case Allocated():
                self.allocated, self.ending = record, "unfinished"
            case PreferenceGiven():
                self.preference = record
            case Withdrawn():
                self.over = True
            case _:
                pass

    def _note_frame(self, record: Record) -> None:
        match record:
            case SessionStarted():
                self.versions, self.terminal = record.versions, record.terminal
            case Resumed():
                self.resumed += 1
                self.versions, self.terminal = record.versions, record.terminal
                self.torn_bytes += record.torn_bytes
                self._mission = None
            case Interruption():
                self.interruptions += 1
            case TakenOver():
                self.takeovers += 1
            case StudyAmended():
                self.amendments += 1
            case SessionEnded(reason=reason):
                if self._mission is not None:
                    self._mission.drop()
                self._mission = None
                self.over |= reason == "finished"
                if reason in ("finished", "turned_away"):
                    self.ending = reason
            case _:
                self._note_once(record)

    def _note_mission(
        self, step: Step, record: MissionStarted | MissionAbandoned, line: int
    ) -> None:
        if isinstance(record, MissionStarted):
            if self._mission is not None:
                self._mission.drop()
            self._mission = MissionHistory(line, step, record)
            self.missions.append(self._mission)
        elif self._mission is not None:
            self._mission.end, self._mission.until_ms = "abandoned", record.at_ms
            self._mission = None

    def _note_phase(
        self, step: Step, utc: str, record: PhaseStarted | PhaseEnded | Exposed | Covered
    ) -> None:
        span = self.phases.setdefault(step, PhaseSpan(utc))
        match record:
            case PhaseStarted():
                span.starts += 1
                self.begun, self.limit_ms = step, record.left_ms
                self.exposure_ms = self.exposure_ms if record.continued else 0
            case Exposed():
                self.exposure_ms = record.exposure_ms
                span.exposure_ms = max(span.exposure_ms, record.exposure_ms)
            case Covered():
                span.covered_ms += record.covered_ms
            case PhaseEnded():
                self.begun, self.exposure_ms = None, 0
                self.endings[step] = record.ending
                span.ending, span.ended_utc = record.ending, utc
                span.exposure_ms = record.exposure_ms


def building_of(started: MissionStarted) -> Building:
    """The building a mission took place in; the same object for all missions in it, while it is
    kept. Raises BuildingError, which the writer of a journal never leads to."""
    return kept_building(started.building_text, started.building)


def history_of(records: Iterable[tuple[Envelope, Record]]) -> History:
    """The history that these records make."""
    history = History()
    for envelope, record in records:
        history.note(envelope, record)
    return history


def read_history(transcript: Transcript) -> History:
    """The history of a whole journal."""
    history = History(torn_bytes=transcript.torn_bytes)
    for entry in transcript.entries:
        history.note(entry.envelope, entry.record, entry.line)
    return history
