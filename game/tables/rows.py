"""The tidy tables of a study: what one row of each holds.

Analysts work with these, in an export and in memory. A column that two tables share means the same
in both. Times within a mission are mission milliseconds.
"""

from __future__ import annotations

from typing import Annotated, Literal, Self

import msgspec

from game.journal.records import Mode, Phase, StepEnding
from game.tables.columns import col
from game.world.building import Severity
from game.world.events import Action, LevelWish, Outcome

LevelName = Literal["C1", "C2", "C3"]
InstructorKind = Literal["static", "adaptive"]
OrderName = Literal["static_first", "adaptive_first"]
HeadingName = Literal["north", "east", "south", "west"]
VictimFate = Literal["rescued", "expired", "waiting"]

_Participant = Annotated[str, col("The participant's pseudonym.")]
_Simulated = Annotated[bool, col("Whether a program played the session instead of a person.")]
_Round = Annotated[int, col("The round, 1 or 2; 0 outside the rounds.")]
_Adaptivity = Annotated[InstructorKind, col("The instructor of the round.")]
_AtMs = Annotated[int, col("When it happened, in mission time.", "ms")]
_Victim = Annotated[str, col("The victim's identifier in its building.")]
_Goal = Annotated[str, col("The victim that the instructor was leading to.")]
_Building = Annotated[str, col("The building of the round, by its name in the study's settings.")]
_Item = Annotated[str, col("The identifier of the question.")]
_Text = Annotated[str, col("The text as shown.")]
_ResponseMs = Annotated[int, col("Time from when it was shown to the last answer.", "ms")]
_Level = Annotated[LevelName, col("The level of abstraction in force.")]
_UntilMs = Annotated[int, col("When the next one replaced it, or the mission ended.", "ms")]
_Phase = Annotated[Phase, col("The phase of the session.")]
_Room = Annotated[str, col("The room, by its true name.")]
_Answer = Annotated[str, col("The participant's answer.")]
_Changes = Annotated[int, col("How often the answer was changed.")]
_Comprehension = col("P(g*|path), which is compared with the thresholds.")
_StartedUtc = Annotated[str, col("When it began, by the wall clock (UTC).")]
_EndedUtc = col(
    "When it ended, by the wall clock (UTC); for a session, the time of its last record so far."
)
_X = Annotated[
    int, col("The rescuer's position at that time: columns from the left, from 0.", "cells")
]
_Y = Annotated[int, col("The rescuer's position at that time: rows from the top, from 0.", "cells")]
_Heading = Annotated[HeadingName, col("The direction the rescuer faced at that time.")]

_Complexity = Annotated[LevelName, col("The level of the static instructor, fixed by allocation.")]
_Order = Annotated[OrderName, col("Which instructor came first.")]
_MEMORISED = col("How long each map was shown, as allocated, to three decimals.", "min")
_MemoriseMinutes = Annotated[float, _MEMORISED]
_MemoriseMs = Annotated[int, col("How long each map was shown, as allocated.", "ms")]
_Disobeyed = Annotated[int, col("Disobeyed instructions in both missions, of either kind.")]
_RepeatMisstep = Annotated[
    int, col("Disobeyed in both missions by a second misstep with no new instruction in between.")
]
_OtherVictim = Annotated[
    int, col("Disobeyed in both missions by treating a victim other than the instructed one.")
]
_Preferred = Annotated[
    InstructorKind | None, col("The instructor that the participant preferred after both rounds.")
]


class TableRow(msgspec.Struct, frozen=True, kw_only=True):
    """One row of a table; its fields are the table's columns."""

    @classmethod
    def of(cls, *records: msgspec.Struct, **others: object) -> Self:
        """A row whose columns are taken by name from the fields of `records` and from `others`."""
        known = {name: getattr(one, name) for one in records for name in one.__struct_fields__}
        known |= others
        return cls(**{name: known[name] for name in cls.__struct_fields__})


class ParticipantRow(TableRow, frozen=True):
    """One row per session. What depends on allocation is empty if that was never reached."""

    participant: _Participant
    mode: Annotated[Mode, col("The kind of session.")]
    simulated: _Simulated
    rescuer: Annotated[str, col("person, or the name of the simulated rescuer.")]
    session_ending: Annotated[
        Literal["finished", "declined", "turned_away", "unfinished"],
        col("How the session ended, so far; turned_away means that there was no place left."),
    ]
    last_phase: Annotated[Phase, col("The last phase in the journal.")]
    last_round: Annotated[int, col("The round of the last phase; 0 outside the rounds.")]
    slot: Annotated[int | None, col("The place taken in the allocation sequence, from 0.")]
    refill: Annotated[bool | None, col("Whether the place was a drop-out's before.")]
    complexity: Annotated[
        LevelName | None, col("The level of the static instructor, fixed by allocation.")
    ]
    order: Annotated[OrderName | None, col("Which instructor came first.")]
    memorise_minutes: Annotated[float | None, _MEMORISED]
    first_building: Annotated[str | None, col("The building of the first round.")]
    second_building: Annotated[str | None, col("The building of the second round.")]
    quiz_static: Annotated[
        float | None,
        col("Share of rooms labelled right before the static instructor's mission."),
    ]
    quiz_adaptive: Annotated[
        float | None,
        col("Share of rooms labelled right before the adaptive instructor's mission."),
    ]
    disobeyed: _Disobeyed
    repeat_misstep: _RepeatMisstep
    other_victim: _OtherVictim
    preferred_instructor: _Preferred
    preferred_round: Annotated[int | None, col("The round of the preferred instructor.")]
    preferred_ms: Annotated[
        int | None, col("Time from when that question was shown to its answer.", "ms")
    ]
    practice_right: Annotated[int | None, col("Right answers in the check that ends practice.")]
    practice_asked: Annotated[int | None, col("Questions in the check that ends practice.")]
    consent_version: Annotated[str | None, col("The version of the texts agreed to, or declined.")]
    segments: Annotated[
        int, col("How many processes wrote the journal; 1 if it was never interrupted.")
    ]
    interruptions: Annotated[
        int,
        col("How often a signal, a hang-up, the machine's sleep or a clock change interrupted it."),
    ]
    takeovers: Annotated[int, col("How often a process on a dead connection was replaced.")]
    amendments: Annotated[int, col("How often study.toml was amended during the session.")]
    torn_bytes: Annotated[int, col("Total length of unfinished lines in the journal.", "bytes")]
    started_utc: _StartedUtc
    ended_utc: Annotated[str, _EndedUtc]
    term: Annotated[str | None, col("TERM in the last terminal.")]
    colorterm: Annotated[str | None, col("COLORTERM in the last terminal.")]
    terminal_columns: Annotated[int | None, col("Width of the last terminal.", "columns")]
    terminal_rows: Annotated[int | None, col("Height of the last terminal.", "rows")]
    game_version: Annotated[str, col("The version of ana in the last segment.")]
    study_sha256: Annotated[str | None, col("The SHA-256 of study.toml at the start.")]


class RoundRow(TableRow, frozen=True):
    """One row per participant and instructor: the analysis table.

    It repeats what analyses need to know of the participant. The outcomes of a void round (victims,
    sliders, statements) are empty, and so are the victims of a mission that is not over.
    """

    participant: _Participant
    simulated: _Simulated
    round: _Round
    adaptivity: _Adaptivity
    complexity: _Complexity
    order: _Order
    memorise_minutes: _MemoriseMinutes
    memorise_ms: _MemoriseMs
    building: _Building
    victims: Annotated[
        int | None,
        col("Victims rescued in the mission; empty while it is unfinished, and in a void round."),
    ]
    reds_rescued: Annotated[int | None, col("Red victims rescued in the mission.")]
    blues_rescued: Annotated[int | None, col("Blue victims rescued in the mission.")]
    reds_expired: Annotated[int | None, col("Red victims not treated in time.")]
    engagement: Annotated[int | None, col("Slider: how engaged, 1 to 100.")]
    confidence: Annotated[int | None, col("Slider: how confident, 1 to 100.")]
    frustration: Annotated[int | None, col("Slider: how frustrated, 1 to 100.")]
    confusion: Annotated[int | None, col("Slider: how confused, 1 to 100.")]
    pref1: Annotated[int | None, col("Statement: easy to understand, 1 to 5.")]
    pref2: Annotated[int | None, col("Statement: helpful, 1 to 5.")]
    pref3: Annotated[int | None, col("Statement: of the right difficulty, 1 to 5.")]
    pref4: Annotated[int | None, col("Statement: enjoyed, 1 to 5.")]
    preference: Annotated[int | None, col("The sum of pref1 to pref4, 4 to 20.")]
    quiz: Annotated[float | None, col("Share of rooms labelled right before the mission.")]
    quiz_right: Annotated[int | None, col("Rooms labelled right before the mission.")]
    quiz_asked: Annotated[int | None, col("Rooms to label before the mission.")]
    disobeyed: _Disobeyed
    repeat_misstep: _RepeatMisstep
    other_victim: _OtherVictim
    preferred_instructor: _Preferred
    disobeyed_in_round: Annotated[int | None, col("Disobeyed in this mission, of either kind.")]
    repeat_misstep_in_round: Annotated[
        int | None, col("Disobeyed in this mission by a second misstep.")
    ]
    other_victim_in_round: Annotated[
        int | None, col("Disobeyed in this mission by treating another victim.")
    ]
    missteps: Annotated[int | None, col("Missteps in this mission.")]
    lost: Annotated[
        int | None, col("How often the rescuer was noticed to be lost in this mission.")
    ]
    asked_simpler: Annotated[int | None, col("Requests for simpler words in this mission.")]
    asked_shorter: Annotated[int | None, col("Requests for shorter words in this mission.")]
    instructions: Annotated[int | None, col("Instructions issued in this mission.")]
    completed: Annotated[int | None, col("Instructions completed in this mission.")]
    fallbacks: Annotated[
        int | None, col("Instructions shown at a lower level than the one in force.")
    ]
    share_c1: Annotated[float | None, col("Share of the mission with C1 in force.")]
    share_c2: Annotated[float | None, col("Share of the mission with C2 in force.")]
    share_c3: Annotated[float | None, col("Share of the mission with C3 in force.")]
    switches: Annotated[int | None, col("Changes of level in this mission.")]
    mean_comprehension: Annotated[
        float | None, col("Mean P(g*|path) over the evaluations with evidence.")
    ]
    moves: Annotated[int | None, col("Steps walked in this mission.")]
    bumps: Annotated[int | None, col("Steps blocked by a wall.")]
    preset: Annotated[
        str | None, col("The preset of the adaptive instructor; empty for the static one.")
    ]
    interrupted: Annotated[bool, col("Whether a timed phase of the round was interrupted.")]
    void: Annotated[bool, col("Whether the round is void under the study's settings.")]
    mission_ending: Annotated[
        StepEnding | None,
        col("How the mission ended, so far; empty where it was not begun."),
    ]
    memorise_exposure_ms: Annotated[int | None, col("How long the map was on the screen.", "ms")]
    label_exposure_ms: Annotated[int | None, col("How long the labelling was on the screen.", "ms")]
    mission_exposure_ms: Annotated[int | None, col("How long the mission was played.", "ms")]
    mission_covered_ms: Annotated[
        int | None, col("How long the window was too small to show the mission.", "ms")
    ]

    @property
    def counts(self) -> bool:
        """Whether the round has a result: its mission is over and the round is not void. A mission
        that was cut off is over when the participant has come back and it was ended."""
        return not self.void and self.mission_ending not in (None, "unfinished")


class ItemRow(TableRow, frozen=True):
    """One row per question with one numbered answer; the last answer counts. Of a question that can
    have several, each answer is a column of `participants` or `rounds`."""

    participant: _Participant
    phase: _Phase
    round: _Round
    adaptivity: Annotated[InstructorKind | None, col("The instructor of the round.")]
    item: _Item
    text: _Text
    anchors: Annotated[
        str, col("The ends of the slider, or the answers to choose from, parted by bars.")
    ]
    place: Annotated[int, col("The question's place in the order shown, from 0.")]
    value: Annotated[int, col("The answer.")]
    response_ms: _ResponseMs
    changes: _Changes
    version: Annotated[
        str,
        col(
            "Names the settings, texts, items and buildings by which it was asked; empty in "
            "sessions of earlier releases."
        ),
    ]


class LabelRow(TableRow, frozen=True):
    """One row per room that was named; the last name counts."""

    participant: _Participant
    round: _Round
    adaptivity: _Adaptivity
    building: _Building
    room: _Room
    answer: _Answer
    correct: Annotated[bool, col("Whether the answer is the room's name.")]
    response_ms: _ResponseMs
    changes: _Changes


class VictimRow(TableRow, frozen=True):
    """One row per victim and mission."""

    participant: _Participant
    round: _Round
    adaptivity: _Adaptivity
    building: _Building
    victim: _Victim
    severity: Annotated[Severity, col("How badly hurt: red victims expire, blue ones do not.")]
    room: Annotated[str | None, col("The room, by its true name.")]
    fate: Annotated[VictimFate, col("What had become of the victim by the end of the mission.")]
    fate_ms: Annotated[int | None, col("When the victim was rescued or expired.", "ms")]


class ActionRow(TableRow, frozen=True):
    """One row per action of the rescuer."""

    participant: _Participant
    round: _Round
    adaptivity: _Adaptivity
    at_ms: _AtMs
    pressed_ms: Annotated[int, col("When its key was pressed, in mission time.", "ms")]
    action: Annotated[Action, col("The action.")]
    outcome: Annotated[Outcome, col("What it led to.")]
    x: _X
    y: _Y
    heading: _Heading


class InstructionRow(TableRow, frozen=True):
    """One row per text on the yellow bar."""

    participant: _Participant
    round: _Round
    adaptivity: _Adaptivity
    number: Annotated[int, col("The instruction's number in its mission.")]
    at_ms: _AtMs
    until_ms: _UntilMs
    goal: _Goal
    level: _Level
    shown_level: Annotated[LevelName, col("The level of the text shown.")]
    fallback: Annotated[
        bool,
        col("Whether a lower level was shown because the level in force has no instruction there."),
    ]
    text: _Text
    notice: Annotated[str, col("The correction shown before the text; usually empty.")]
    tuples: Annotated[str, col("The (action, object) pairs, separated by semicolons.")]
    reason: Annotated[
        str,
        col(
            "Why it was issued: one of goal, completed, level, off_path, restated, misstep, "
            "heeded, resumed, lost."
        ),
    ]
    x: _X
    y: _Y
    heading: _Heading
    end_x: Annotated[
        int, col("Where it leads when carried out: columns from the left, from 0.", "cells")
    ]
    end_y: Annotated[
        int, col("Where it leads when carried out: rows from the top, from 0.", "cells")
    ]
    treats: Annotated[bool, col("Whether it ends with a treatment.")]
    completed_ms: Annotated[int | None, col("When it was completed; empty if it was not.", "ms")]
    missteps_under: Annotated[int, col("Missteps while the instruction was in force.")]
    disobeyed_by: Annotated[
        Literal["repeat_misstep", "other_victim"] | None,
        col("How the instruction was first disobeyed, if it was."),
    ]


class PosteriorRow(TableRow, frozen=True):
    """One row per estimate of what the rescuer is heading for."""

    participant: _Participant
    round: _Round
    adaptivity: _Adaptivity
    at_ms: _AtMs
    goal: _Goal
    level: _Level
    comprehension: Annotated[float, _Comprehension]
    goal_probability: Annotated[
        float, col("Probability of the goal itself; comprehension may add the others in its room.")
    ]
    likeliest: Annotated[str, col("The victim with the greatest probability.")]
    likeliest_probability: Annotated[float, col("The probability of that victim.")]
    goals: Annotated[int, col("How many victims were waiting.")]
    window_moves: Annotated[int, col("How many moves the evaluation covers.")]
    lower_below: Annotated[float, col("The level goes down below this threshold.")]
    raise_above: Annotated[float, col("The level goes up above this threshold.")]
    verdict: Annotated[
        Literal["lower", "keep", "raise", "none"],
        col("The result of the evaluation; none means that there was no evidence."),
    ]


class LevelRow(TableRow, frozen=True):
    """One row per stretch of a mission at one level; `comprehension` is what led to it."""

    participant: _Participant
    round: _Round
    adaptivity: _Adaptivity
    level: _Level
    from_ms: Annotated[int, col("When the level came into force, in mission time.", "ms")]
    until_ms: _UntilMs
    comprehension: Annotated[float | None, _Comprehension]


class AskedRow(TableRow, frozen=True):
    """One row per request, by the level key, for other words."""

    participant: _Participant
    round: _Round
    adaptivity: _Adaptivity
    at_ms: _AtMs
    want: Annotated[LevelWish, col("What was asked for: simpler words, or shorter ones.")]
    level: _Level


class PhaseRow(TableRow, frozen=True):
    """One row per phase that began."""

    participant: _Participant
    phase: _Phase
    round: _Round
    phase_ending: Annotated[StepEnding, col("How the phase ended, so far.")]
    exposure_ms: Annotated[int, col("How long a timed phase was on the screen.", "ms")]
    covered_ms: Annotated[
        int, col("How long the window was too small to show anything in it.", "ms")
    ]
    starts: Annotated[
        int, col("How often it was started or continued; 1 if it was never interrupted.")
    ]
    started_utc: _StartedUtc
    ended_utc: Annotated[str | None, _EndedUtc]


class FreeTextRow(TableRow, frozen=True):
    """One row per text in a participant's own words, which may identify them: kept apart."""

    participant: _Participant
    item: _Item
    text: _Text
    answer: _Answer
    response_ms: _ResponseMs
    phase: _Phase = "preference"
    round: _Round = 0
