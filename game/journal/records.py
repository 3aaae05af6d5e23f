"""Every record that a journal can hold, apart from those of the mission and the coach.

Mission events and coach records are written as `game.world.events` and `game.coach.acts` define
them. Here are the records of a session and of a study, and the union of all. A line of a journal
is one record, with the fields of its `Envelope` beside its own.
"""

from __future__ import annotations

from typing import Annotated, Literal, get_args

import msgspec

from game.coach.acts import CoachRecord, Level
from game.coach.knowledge.assumed import Assumed
from game.coach.presets import Preset
from game.coach.spec import CoachSpec
from game.world.events import MissionEvent
from game.world.settings import MissionSettings
from game.world.variant import USUAL, Variant

SCHEMA_VERSION = 2
"""Changes with any change to what a line holds; `game.journal.upgrades` then reads the older."""

RULES_VERSION = 3
"""Changes whenever the same timed actions may give another mission or another instruction."""

RELEASES = {1: "a version before 0.1.0", 2: "release 0.1.0"}
"""Which `ana` verifies journals of earlier rules."""

ProtocolPhase = Literal[
    "session",
    "preflight",
    "consent",
    "practice",
    "memorise",
    "label",
    "mission",
    "preference",
    "debrief",
]
"""The parts of a session that are no forms; `session` is outside all of them."""
PROTOCOL_PHASES: tuple[ProtocolPhase, ...] = get_args(ProtocolPhase)

Phase = Annotated[str, msgspec.Meta(pattern=r"^[A-Za-z][A-Za-z0-9_.]*$")]
"""The part of a session that a record belongs to: a `ProtocolPhase` or a form, by its id in
forms.toml."""

StudyMode = Literal["live", "pilot", "simulated"]
Mode = Literal["free_play", StudyMode]
"""What a session is for: play, or one of the modes of a study."""
STUDY_MODES: tuple[StudyMode, ...] = get_args(StudyMode)

ROUNDS = (1, 2)
"""The rounds of a session of the paper's study."""

StepEnding = Literal["completed", "timed_out", "interrupted", "void", "unfinished"]
"""How a phase ended, so far."""

PERSON = "person"
"""The name of the rescuer when a person plays."""


Utc = Annotated[str, msgspec.Meta(pattern=r"^\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d\.\d{3}Z$")]
"""The wall clock to the millisecond, as 2000-01-01T00:00:00.000Z."""


class Envelope(msgspec.Struct, frozen=True):
    """What every record has besides its own fields.

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
    """A record of neither the mission nor the coach."""


# --- the session --------------------------------------------------------------------------------


class Versions(msgspec.Struct, frozen=True):
    """The versions that wrote a segment. `textual` is empty if there was no screen."""

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
    """The whole study.toml that a session runs under, and its SHA-256 in hexadecimal."""

    text: str
    sha256: str


class SessionStarted(SessionRecord, frozen=True, tag="session_started", kw_only=True):
    """The first record of every journal.

    `settings` are the session's rules (each mission repeats its own). `rescuer` is `person`, or
    the name of the simulated rescuer if `simulated` is true. `participant` is a pseudonym. In free
    play it is empty and `study` is None. `inputs` is the SHA-256 of everything that the session is
    made from, by name: settings, texts, items and buildings.
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
    inputs: dict[str, str] = {}


class Resumed(SessionRecord, frozen=True, tag="resumed", kw_only=True):
    """The first record of a later segment. `torn_bytes` is the length of the unfinished line at
    the end of the segment before, 0 if it ended cleanly."""

    torn_bytes: int
    versions: Versions
    terminal: Terminal | None


class MissionStarted(SessionRecord, frozen=True, tag="mission_started", kw_only=True):
    """Everything that determines a mission, except the actions.

    `building_text` is the whole building file and `building_sha256` its hash; `preset` is the
    coach's preset as it was then, None for a coach without one, and `assumed` the numbers of
    one that judges what the rescuer knows. `variant` says how the building and the rules came to
    differ from those drawn and usual; the text and the settings hold what came of it.
    `memorised_ms` is how long the map with the rooms' names
    was shown just before, in free play (a study records that as a phase of its own).
    `instructions_text` is the whole instructions.toml that the coach speaks by, None for the
    shipped English.
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
    variant: Variant = USUAL
    memorised_ms: int = 0
    instructions_text: str | None = None


class MissionAbandoned(SessionRecord, frozen=True, tag="mission_abandoned"):
    """The mission was left at `at_ms` of its time, before its end; a practice leg is left when it
    is done."""

    at_ms: int
    reason: Literal["quit", "restarted", "interrupted", "leg_done"]


class Paused(SessionRecord, frozen=True, tag="paused"):
    """The mission's time is stopped (free play)."""

    at_ms: int


class Unpaused(SessionRecord, frozen=True, tag="unpaused"):
    at_ms: int


class Interruption(SessionRecord, frozen=True, tag="interruption"):
    """Something outside interrupted the session.

    `jump_ms` is how long the machine slept (`suspended`) or by how much the wall clock was set
    (`clock_step`); neither affects steady time. `signal` is the name of the signal received.
    `error` is the kind of error that ended the program (`defect`), and the line it came from.
    """

    kind: Literal["signal", "hang_up", "suspended", "clock_step", "defect"]
    signal: str = ""
    jump_ms: int = 0
    error: str = ""


class SessionEnded(SessionRecord, frozen=True, tag="session_ended"):
    reason: Literal["finished", "quit", "declined", "withdrawn", "interrupted", "turned_away"]


# --- the study ----------------------------------------------------------------------------------


class Preflighted(SessionRecord, frozen=True, tag="preflighted"):
    """The terminal was checked: what it offers, and whether that is enough."""

    terminal: Terminal
    colours: Literal["none", "16", "256", "truecolor"]
    keys_work: bool
    enough: bool


class Consented(SessionRecord, frozen=True, tag="consented"):
    """The participant agreed to `text`, as shown, and stated whether they are of age."""

    version: str
    text: str
    of_age: bool


class Declined(SessionRecord, frozen=True, tag="declined"):
    version: str


class PracticeChecked(SessionRecord, frozen=True, tag="practice_checked"):
    """The outcome of the check that ends practice: `right` of `asked` questions."""

    right: int
    asked: int


class Allocated(SessionRecord, frozen=True, tag="allocated", kw_only=True, omit_defaults=True):
    """The slot taken in the ledger, and what its design cell means for each round: `buildings` in
    the order of rounds, and `adaptive_first` if the second of the two `instructors` has the first
    round (they are a static and an adaptive one where none are named), after which they take
    turns."""

    slot: int
    refill: bool
    memorise_ms: int
    adaptive_first: bool
    static_level: Level
    buildings: tuple[str, ...]
    instructors: tuple[str, ...] = ()

    def second_leads(self, round_: int) -> bool:
        """Whether the second of the two instructors, the adaptive one, leads a round."""
        return self.adaptive_first is (round_ % 2 == 1)


class PhaseStarted(SessionRecord, frozen=True, tag="phase_started"):
    """The envelope's phase began, or continued after a resume. `left_ms` is the time left, None if
    the phase is untimed."""

    left_ms: int | None
    continued: bool = False


class Exposed(SessionRecord, frozen=True, tag="exposed"):
    """How long the current timed phase has been on the screen; written every second, so that a
    phase that is cut off continues with the time left."""

    exposure_ms: int


class Covered(SessionRecord, frozen=True, tag="covered"):
    """The window was too small to show anything for so long. Meanwhile the clock of memorising and
    labelling stood still; that of a mission went on."""

    covered_ms: int


class PhaseEnded(SessionRecord, frozen=True, tag="phase_ended"):
    """`exposure_ms` is how long the phase was on the screen, over all segments."""

    ending: Literal["completed", "timed_out", "interrupted", "void"]
    exposure_ms: int


class QuizAnswer(SessionRecord, frozen=True, tag="quiz_answer"):
    """A room was given a name, or (`answer` None) lost it again; the last answer counts.

    `response_ms` runs from when the room was shown.
    """

    room: str
    answer: str | None
    correct: bool
    response_ms: int
    version: str = ""


class QuizSubmitted(SessionRecord, frozen=True, tag="quiz_submitted"):
    """The result of the labels at the end: `right` of `asked` rooms."""

    right: int
    asked: int


class QuestionnaireAnswer(SessionRecord, frozen=True, tag="questionnaire_answer", kw_only=True):
    """An item was answered. `text` and `anchors` are as shown; `place` is its place in the order
    shown, from 0; `response_ms` runs from when it was shown; `changes` counts changes of answer.
    `version`, of this and every other answer, names the study's inputs by which it was asked."""

    item: str
    text: str
    anchors: tuple[str, ...]
    place: int
    value: int
    response_ms: int
    changes: int = 0
    version: str = ""


class ChoicesGiven(SessionRecord, frozen=True, tag="choices_given", kw_only=True):
    """An item that can have several answers was answered: `chosen` are their positions among
    `anchors`, from 1. The rest as in `questionnaire_answer`."""

    item: str
    text: str
    anchors: tuple[str, ...]
    place: int
    chosen: tuple[int, ...]
    response_ms: int
    changes: int = 0
    version: str = ""


class AnswerCleared(SessionRecord, frozen=True, tag="answer_cleared", kw_only=True):
    """The answer to an item was taken back, or the item is no longer shown (`hidden`) because an
    earlier answer was changed: it has no answer."""

    item: str
    hidden: bool = False
    response_ms: int = 0
    version: str = ""


class PreferenceGiven(SessionRecord, frozen=True, tag="preference_given", kw_only=True):
    """The preferred instructor: that of `preferred_round`. `options` are as shown."""

    item: str
    text: str
    options: tuple[str, ...]
    preferred_round: Literal[1, 2]
    response_ms: int
    version: str = ""


class FreeText(SessionRecord, frozen=True, tag="free_text"):
    """Something in a participant's own words. It may identify them, so exports keep it apart."""

    item: str
    text: str
    answer: str
    response_ms: int
    version: str = ""


class Debriefed(SessionRecord, frozen=True, tag="debriefed"):
    completion_code: str


class TakenOver(SessionRecord, frozen=True, tag="takeover"):
    """This segment replaced a process on a dead connection, silent for `silent_ms`."""

    silent_ms: int


class StudyAmended(SessionRecord, frozen=True, tag="study_amended"):
    """From here on the session is made from other `inputs` (as in `session_started`): what
    `changed`, and why."""

    study: StudyCopy
    why: str
    inputs: dict[str, str] = {}
    changed: tuple[str, ...] = ()


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
    | Covered
    | PhaseEnded
    | QuizAnswer
    | QuizSubmitted
    | QuestionnaireAnswer
    | ChoicesGiven
    | AnswerCleared
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
"""Everything that happens in a mission with its coach."""

Record = RunRecord | FrameRecord | StudyRecord
"""Everything that a line can hold. A new kind of record is added to one of the four unions."""
