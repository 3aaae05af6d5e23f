"""Every record a journal can hold besides those of the mission and the coach.

Mission events and coach records are written as `game.world.events` and `game.coach.acts` define
them; here are the frame around them, the records of a session and those of a study, and the union
of all. A line of a journal is one record with the fields of its `Envelope` flat beside its own.
"""

from __future__ import annotations

from typing import Annotated, Literal

import msgspec

from game.coach.acts import CoachRecord, Level
from game.coach.knowledge.assumed import Assumed
from game.coach.presets import Preset
from game.coach.spec import CoachSpec
from game.world.events import MissionEvent
from game.world.settings import MissionSettings

SCHEMA_VERSION = 2
"""Changes with any change to what a line holds; `game.journal.upgrades` then reads the older."""

RULES_VERSION = 2
"""Changes whenever the same timed actions may give another mission or another instruction."""

Phase = Literal[
    "session",
    "preflight",
    "consent",
    "practice",
    "memorise",
    "label",
    "mission",
    "sliders",
    "likert",
    "preference",
    "debrief",
]
"""Where in a session a record belongs; `session` is what lies outside all phases."""

Mode = Literal["free_play", "live", "pilot", "simulated"]
"""What a session is for; the last three are those of a study."""

StepEnding = Literal["completed", "timed_out", "interrupted", "void", "unfinished"]
"""How a phase ended, so far."""

PERSON = "person"
"""The rescuer of a session that no program plays."""


Utc = Annotated[str, msgspec.Meta(pattern=r"^\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d\.\d{3}Z$")]
"""The wall clock to the millisecond, as 2000-01-01T00:00:00.000Z."""


class Envelope(msgspec.Struct, frozen=True):
    """What every record carries beside its own fields.

    `seq` counts the records of a journal from 0. `t_ms` is steady time since the segment began; a
    segment is what one process wrote. `round` is 1 or 2 within the rounds of a study, else 0.
    """

    seq: int
    segment: int
    t_ms: int
    utc: Utc
    phase: Phase
    round: int


class SessionRecord(msgspec.Struct, frozen=True, tag_field="type"):
    """Something that is neither the mission's nor the coach's."""


# --- the session --------------------------------------------------------------------------------


class Versions(msgspec.Struct, frozen=True):
    """What wrote a segment. `textual` is empty where there was no screen."""

    game: str
    schema: int
    python: str
    textual: str = ""


class Terminal(msgspec.Struct, frozen=True):
    """The terminal a session is played in."""

    term: str
    colorterm: str
    columns: int
    rows: int


class StudyCopy(msgspec.Struct, frozen=True):
    """The study.toml a session runs under, whole, and the SHA-256 of it in hexadecimal."""

    text: str
    sha256: str


class SessionStarted(SessionRecord, frozen=True, tag="session_started", kw_only=True):
    """The first record of every journal.

    `settings` are the session's rules (each mission repeats its own). `rescuer` is `person`, or
    the name of the simulated one; `simulated` tells the two apart. `participant` is a pseudonym,
    empty in free play, where `study` is None.
    """

    session: str
    mode: Mode
    simulated: bool
    rescuer: str
    participant: str
    versions: Versions
    settings: MissionSettings
    seed: int
    terminal: Terminal | None
    study: StudyCopy | None = None


class Resumed(SessionRecord, frozen=True, tag="resumed", kw_only=True):
    """The first record of a later segment. `torn_bytes` is the length of the line that the one
    before left unfinished: 0 where it ended whole."""

    torn_bytes: int
    versions: Versions
    terminal: Terminal | None


class MissionStarted(SessionRecord, frozen=True, tag="mission_started", kw_only=True):
    """Everything that determines a mission but the actions.

    `building_text` is the whole building file and `building_sha256` its hash; `preset` is the
    coach's preset as it was then, None for a coach without one, and `assumed` the numbers of
    one that judges what the rescuer knows.
    """

    building: str
    building_text: str
    building_sha256: str
    coach: CoachSpec
    preset: Preset | None
    settings: MissionSettings
    seed: int
    rules_version: int
    assumed: Assumed | None = None


class MissionAbandoned(SessionRecord, frozen=True, tag="mission_abandoned"):
    """The mission was left at `at_ms` of its time, before its end; a leg of practice is left when
    it is done."""

    at_ms: int
    reason: Literal["quit", "restarted", "interrupted", "leg_done"]


class Paused(SessionRecord, frozen=True, tag="paused"):
    """The mission's time stands still (free play)."""

    at_ms: int


class Unpaused(SessionRecord, frozen=True, tag="unpaused"):
    at_ms: int


class Interruption(SessionRecord, frozen=True, tag="interruption"):
    """Something outside the session broke in.

    `jump_ms` is, for `suspended`, how long the machine slept, and for `clock_step`, by how much
    the wall clock was set; steady time has neither. `signal` names the signal that came.
    """

    kind: Literal["signal", "hang_up", "suspended", "clock_step"]
    signal: str = ""
    jump_ms: int = 0


class SessionEnded(SessionRecord, frozen=True, tag="session_ended"):
    reason: Literal["finished", "quit", "declined", "withdrawn", "interrupted", "turned_away"]


# --- the study ----------------------------------------------------------------------------------


class Preflighted(SessionRecord, frozen=True, tag="preflighted"):
    """The terminal was looked at: what it has, and whether that is enough."""

    terminal: Terminal
    colours: Literal["none", "16", "256", "truecolor"]
    keys_work: bool
    enough: bool


class Consented(SessionRecord, frozen=True, tag="consented"):
    """Agreed to `text`, as shown, and said to be of age."""

    version: str
    text: str
    of_age: bool


class Declined(SessionRecord, frozen=True, tag="declined"):
    version: str


class PracticeChecked(SessionRecord, frozen=True, tag="practice_checked"):
    """The outcome of the check that ends practice: `right` of `asked` questions."""

    right: int
    asked: int


class Allocated(SessionRecord, frozen=True, tag="allocated", kw_only=True):
    """The slot taken in the ledger and its design cell, spelled out for both rounds."""

    slot: int
    refill: bool
    memorise_ms: int
    adaptive_first: bool
    static_level: Level
    buildings: tuple[str, str]


class PhaseStarted(SessionRecord, frozen=True, tag="phase_started"):
    """The envelope's phase began, or went on after a resume. `left_ms` is None if untimed."""

    left_ms: int | None
    continued: bool = False


class Exposed(SessionRecord, frozen=True, tag="exposed"):
    """How long the timed phase under way has been on the screen; written every second of it, so
    that a phase that is cut off goes on with what was left."""

    exposure_ms: int


class PhaseEnded(SessionRecord, frozen=True, tag="phase_ended"):
    """`exposure_ms` is how long the phase was on the screen, over all segments."""

    ending: Literal["completed", "timed_out", "interrupted", "void"]
    exposure_ms: int


class QuizAnswer(SessionRecord, frozen=True, tag="quiz_answer"):
    """A name was given to a room, or (`answer` None) taken back; the last one counts.

    `response_ms` runs from when the room was shown.
    """

    room: str
    answer: str | None
    correct: bool
    response_ms: int


class QuizSubmitted(SessionRecord, frozen=True, tag="quiz_submitted"):
    """The labels as they stood at the end: `right` of `asked` rooms."""

    right: int
    asked: int


class QuestionnaireAnswer(SessionRecord, frozen=True, tag="questionnaire_answer", kw_only=True):
    """An item was answered. `text` and `anchors` are as shown; `place` is its place in the order
    shown, from 0; `response_ms` runs from when it was shown; `changes` counts later thoughts."""

    item: str
    text: str
    anchors: tuple[str, ...]
    place: int
    value: int
    response_ms: int
    changes: int = 0


class PreferenceGiven(SessionRecord, frozen=True, tag="preference_given", kw_only=True):
    """Which instructor was preferred: that of `preferred_round`. `options` are as shown."""

    item: str
    text: str
    options: tuple[str, ...]
    preferred_round: Literal[1, 2]
    response_ms: int


class FreeText(SessionRecord, frozen=True, tag="free_text"):
    """What a participant wrote in own words; may identify a person, so exports keep it apart."""

    item: str
    text: str
    answer: str
    response_ms: int


class Debriefed(SessionRecord, frozen=True, tag="debriefed"):
    completion_code: str


class TakenOver(SessionRecord, frozen=True, tag="takeover"):
    """This segment ended a process on a dead link, which had been silent for `silent_ms`."""

    silent_ms: int


class StudyAmended(SessionRecord, frozen=True, tag="study_amended"):
    """From here on the session runs under a changed study.toml."""

    study: StudyCopy
    why: str


class Withdrawn(SessionRecord, frozen=True, tag="withdrawn"):
    """The participant withdrew. Nothing else of the session is kept."""

    participant: str


StudyRecord = (
    Preflighted
    | Consented
    | Declined
    | PracticeChecked
    | Allocated
    | PhaseStarted
    | Exposed
    | PhaseEnded
    | QuizAnswer
    | QuizSubmitted
    | QuestionnaireAnswer
    | PreferenceGiven
    | FreeText
    | Debriefed
    | TakenOver
    | StudyAmended
    | Withdrawn
)

FrameRecord = (
    SessionStarted
    | Resumed
    | MissionStarted
    | MissionAbandoned
    | Paused
    | Unpaused
    | Interruption
    | SessionEnded
)

RunRecord = MissionEvent | CoachRecord
"""What happens in a mission with its coach."""

Record = RunRecord | FrameRecord | StudyRecord
"""Whatever a line can hold. A new kind of record is added to one of the four unions."""
