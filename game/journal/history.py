"""What happened in one session of a study, gathered from its journal record by record."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Literal

from game.journal.missions import RecordedMission, missions
from game.journal.reader import Transcript
from game.journal.records import (
    Allocated,
    Consented,
    Declined,
    Envelope,
    Exposed,
    FreeText,
    Interruption,
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
    SessionEnded,
    SessionStarted,
    StepEnding,
    StudyAmended,
    TakenOver,
    Terminal,
    Versions,
)

ROUNDS = (1, 2)

Place = tuple[Phase, int]
"""A phase and its round."""


@dataclass
class Timed:
    """One phase as it was gone through; `starts` counts how often it was begun or continued."""

    started_utc: str
    ended_utc: str | None = None
    ending: StepEnding = "unfinished"
    exposure_ms: int = 0
    starts: int = 0

    @property
    def broke_off(self) -> bool:
        return self.starts > 1 or self.ending in ("interrupted", "void")


@dataclass
class Story:
    """The session so far. Of answers given more than once, the last."""

    started: SessionStarted
    versions: Versions
    terminal: Terminal | None
    started_utc: str
    ended_utc: str
    torn_bytes: int
    ending: Literal["finished", "declined", "turned_away", "unfinished"] = "unfinished"
    last_step: Place = ("session", 0)
    consent_version: str | None = None
    allocated: Allocated | None = None
    practice: PracticeChecked | None = None
    preference: PreferenceGiven | None = None
    segments: int = 1
    interruptions: int = 0
    takeovers: int = 0
    amendments: int = 0
    phases: dict[Place, Timed] = field(default_factory=dict)
    items: dict[tuple[Phase, int, str], QuestionnaireAnswer] = field(default_factory=dict)
    labels: dict[tuple[int, str], tuple[QuizAnswer, int]] = field(default_factory=dict)
    quizzes: dict[int, QuizSubmitted] = field(default_factory=dict)
    free_texts: list[FreeText] = field(default_factory=list)
    missions: dict[int, RecordedMission] = field(default_factory=dict)

    def is_void(self, round_: int) -> bool:
        return any(
            number == round_ and span.ending == "void" for (_, number), span in self.phases.items()
        )

    def note(self, envelope: Envelope, record: Record) -> None:
        """Take account of one record."""
        place = envelope.phase, envelope.round
        self.ended_utc = envelope.utc
        if envelope.phase != "session":
            self.last_step = place
        match record:
            case PhaseStarted() | PhaseEnded() | Exposed():
                self._note_phase(place, envelope.utc, record)
            case QuestionnaireAnswer():
                self.items[*place, record.item] = record
            case QuizAnswer():
                _, before = self.labels.get((envelope.round, record.room), (None, -1))
                self.labels[envelope.round, record.room] = record, before + 1
            case QuizSubmitted():
                self.quizzes[envelope.round] = record
            case FreeText():
                self.free_texts.append(record)
            case Resumed():
                self.segments += 1
                self.versions, self.terminal = record.versions, record.terminal
                self.torn_bytes += record.torn_bytes
            case Interruption():
                self.interruptions += 1
            case TakenOver():
                self.takeovers += 1
            case StudyAmended():
                self.amendments += 1
            case _:
                self._note_once(record)

    def _note_once(self, record: Record) -> None:
        match record:
            case Consented():
                self.consent_version = record.version
            case Declined():
                self.consent_version = record.version
                self.ending = "declined"
            case PracticeChecked():
                self.practice = record
            case Allocated():
                self.allocated, self.ending = record, "unfinished"
            case PreferenceGiven():
                self.preference = record
            case SessionEnded(reason="finished" | "turned_away" as reason):
                self.ending = reason
            case _:
                pass

    def _note_phase(
        self, place: Place, utc: str, record: PhaseStarted | PhaseEnded | Exposed
    ) -> None:
        span = self.phases.setdefault(place, Timed(utc))
        match record:
            case PhaseStarted():
                span.starts += 1
            case Exposed():
                span.exposure_ms = max(span.exposure_ms, record.exposure_ms)
            case PhaseEnded():
                span.ending, span.ended_utc = record.ending, utc
                span.exposure_ms = record.exposure_ms


def read_story(transcript: Transcript) -> Story:
    """What happened in the session of a study."""
    started, first = transcript.started, transcript.entries[0].envelope
    story = Story(
        started=started,
        versions=started.versions,
        terminal=started.terminal,
        started_utc=first.utc,
        ended_utc=first.utc,
        torn_bytes=transcript.torn_bytes,
    )
    places = {}
    for entry in transcript.entries:
        story.note(entry.envelope, entry.record)
        places[entry.line] = entry.envelope
    for mission in missions(transcript):
        where = places[mission.line]
        if where.phase == "mission" and where.round in ROUNDS:
            story.missions[where.round] = mission
    return story
