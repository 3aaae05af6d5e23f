"""The tidy tables of a study: what one row of each holds.

This is what analysts work with, in an export and in memory alike. A column that two tables share
means the same in both. Times within a mission are mission milliseconds.
"""

from __future__ import annotations

from typing import Annotated, Literal, Self

import msgspec

from game.journal.records import Mode, Phase, StepEnding
from game.tables.columns import col
from game.world.building import Severity
from game.world.events import Action, Outcome

LevelName = Literal["C1", "C2", "C3"]
InstructorKind = Literal["static", "adaptive"]
OrderName = Literal["static_first", "adaptive_first"]
HeadingName = Literal["north", "east", "south", "west"]
VictimFate = Literal["rescued", "expired", "waiting"]

_Participant = Annotated[str, col("The participant's pseudonym.")]
_Simulated = Annotated[
    bool, col("Whether the session was played by a program and not by a person.")
]
_Round = Annotated[int, col("The round, 1 or 2; 0 for what belongs to none.")]
_Adaptivity = Annotated[InstructorKind, col("The instructor of the round.")]
_AtMs = Annotated[int, col("When it happened, in mission time.", "ms")]
_Victim = Annotated[str, col("The victim's identifier in its building.")]
_Goal = Annotated[str, col("The victim that the instructor led to.")]
_Building = Annotated[str, col("The building of the round, as the study's settings call it.")]
_Item = Annotated[str, col("The identifier of the question.")]
_Text = Annotated[str, col("The words as they were shown.")]
_ResponseMs = Annotated[int, col("From when it was shown to the last answer.", "ms")]
_Level = Annotated[LevelName, col("The level of abstraction in force.")]
_UntilMs = Annotated[int, col("When it gave way to the next, or the mission ended.", "ms")]
_Phase = Annotated[Phase, col("The phase of the session.")]
_Room = Annotated[str, col("The room, by its true name.")]
_Answer = Annotated[str, col("What the participant answered.")]
_Changes = Annotated[int, col("How often the answer was changed.")]
_Comprehension = col("P(g*|path), as compared with the thresholds.")
_StartedUtc = Annotated[str, col("The wall clock when it began.")]
_EndedUtc = col("The wall clock when it ended; of a session, at its last record so far.")
_X = Annotated[int, col("Where the rescuer stood then, counted to the right from 0.", "cells")]
_Y = Annotated[int, col("Where the rescuer stood then, counted down from 0.", "cells")]
_Heading = Annotated[HeadingName, col("Where the rescuer looked then.")]

_Complexity = Annotated[LevelName, col("The level of the static instructor, fixed by allocation.")]
_Order = Annotated[OrderName, col("Which instructor came first.")]
_MemoriseMinutes = Annotated[float, col("How long each map was shown, as allocated.", "min")]
_MemoriseMs = Annotated[int, col("How long each map was shown, as allocated.", "ms")]
_Disobeyed = Annotated[int, col("Disobeyed instructions over both missions, of either kind.")]
_RepeatMisstep = Annotated[
    int, col("Disobeyed over both missions by a second misstep with no instruction between.")
]
_OtherVictim = Annotated[
    int, col("Disobeyed over both missions by treating another victim than the instructed one.")
]
_Preferred = Annotated[InstructorKind | None, col("The instructor preferred after both rounds.")]


class Row(msgspec.Struct, frozen=True, kw_only=True):
    """One row of a table; its fields are the table's columns."""

    @classmethod
    def of(cls, *records: msgspec.Struct, **others: object) -> Self:
        """The row whose columns are the fields of `records` with their names, and `others`."""
        known = {name: getattr(one, name) for one in records for name in one.__struct_fields__}
        known |= others
        return cls(**{name: known[name] for name in cls.__struct_fields__})


class ParticipantRow(Row, frozen=True):
    """One row per session. What depends on allocation is empty if that was never reached."""

    participant: _Participant
    mode: Annotated[Mode, col("What the session was for.")]
    simulated: _Simulated
    rescuer: Annotated[str, col("person, or the name of the simulated rescuer.")]
    session_ending: Annotated[
        Literal["finished", "declined", "turned_away", "unfinished"],
        col("How the session ended, so far; turned_away: there was no place left."),
    ]
    last_phase: Annotated[Phase, col("The phase of the journal's last record but the ending.")]
    last_round: Annotated[int, col("The round of the last phase; 0 outside the rounds.")]
    slot: Annotated[int | None, col("The place taken in the allocation sequence, from 0.")]
    refill: Annotated[bool | None, col("Whether the place had been a drop-out's before.")]
    complexity: Annotated[
        LevelName | None, col("The level of the static instructor, fixed by allocation.")
    ]
    order: Annotated[OrderName | None, col("Which instructor came first.")]
    memorise_minutes: Annotated[
        float | None, col("How long each map was shown, as allocated.", "min")
    ]
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
    preferred_round: Annotated[int | None, col("The round of the instructor preferred.")]
    preferred_ms: Annotated[int | None, col("From when that question was shown.", "ms")]
    practice_right: Annotated[int | None, col("Right answers in the check that ends practice.")]
    practice_asked: Annotated[int | None, col("Questions in the check that ends practice.")]
    consent_version: Annotated[str | None, col("The version of the texts agreed to, or declined.")]
    segments: Annotated[int, col("How many processes wrote the journal: 1 where nothing broke.")]
    interruptions: Annotated[int, col("Signals, hang-ups, sleeps of the machine, set clocks.")]
    takeovers: Annotated[int, col("How often a process on a dead link was replaced.")]
    amendments: Annotated[int, col("How often study.toml was changed, on record, in the session.")]
    torn_bytes: Annotated[int, col("Length of unfinished lines in the journal.", "bytes")]
    started_utc: _StartedUtc
    ended_utc: Annotated[str, _EndedUtc]
    term: Annotated[str | None, col("TERM of the last terminal.")]
    colorterm: Annotated[str | None, col("COLORTERM of the last terminal.")]
    terminal_columns: Annotated[int | None, col("Width of the last terminal.", "columns")]
    terminal_rows: Annotated[int | None, col("Height of the last terminal.", "rows")]
    game_version: Annotated[str, col("The version of ana in the last segment.")]
    study_sha256: Annotated[str | None, col("The hash of the study.toml at the start.")]


class RoundRow(Row, frozen=True):
    """One row per participant and instructor: the analysis table.

    It repeats what analyses need of the participant. The outcomes of a void round (victims,
    sliders, statements) are empty.
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
    victims: Annotated[int | None, col("Victims rescued in the mission.")]
    reds_rescued: Annotated[int | None, col("Red victims rescued in the mission.")]
    blues_rescued: Annotated[int | None, col("Blue victims rescued in the mission.")]
    reds_expired: Annotated[int | None, col("Red victims that nobody reached in time.")]
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
    quiz_asked: Annotated[int | None, col("Rooms to be labelled before the mission.")]
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
    instructions: Annotated[int | None, col("Instructions issued in this mission.")]
    completed: Annotated[int | None, col("Instructions completed in this mission.")]
    fallbacks: Annotated[int | None, col("Instructions shown at a lower level than in force.")]
    share_c1: Annotated[float | None, col("Share of the mission with C1 in force.")]
    share_c2: Annotated[float | None, col("Share of the mission with C2 in force.")]
    share_c3: Annotated[float | None, col("Share of the mission with C3 in force.")]
    switches: Annotated[int | None, col("Changes of level in this mission.")]
    mean_comprehension: Annotated[
        float | None, col("Mean P(g*|path) over the evaluations that carry evidence.")
    ]
    moves: Annotated[int | None, col("Steps walked in this mission.")]
    bumps: Annotated[int | None, col("Steps that a wall stopped.")]
    preset: Annotated[
        str | None, col("The preset of the adaptive instructor; empty for the other.")
    ]
    interrupted: Annotated[bool, col("Whether a timed phase of the round broke off.")]
    void: Annotated[bool, col("Whether the round is void, as the study's settings say.")]
    memorise_exposure_ms: Annotated[int | None, col("How long the map was on the screen.", "ms")]
    label_exposure_ms: Annotated[int | None, col("How long the rooms could be labelled.", "ms")]
    mission_exposure_ms: Annotated[int | None, col("How long the mission was played.", "ms")]


class ItemRow(Row, frozen=True):
    """One row per question with numbered answers; the last answer counts."""

    participant: _Participant
    phase: _Phase
    round: _Round
    adaptivity: Annotated[InstructorKind | None, col("The instructor of the round.")]
    item: _Item
    text: _Text
    place: Annotated[int, col("The question's place in the order shown, from 0.")]
    value: Annotated[int, col("The answer.")]
    response_ms: _ResponseMs
    changes: _Changes


class LabelRow(Row, frozen=True):
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


class VictimRow(Row, frozen=True):
    """One row per victim and mission."""

    participant: _Participant
    round: _Round
    adaptivity: _Adaptivity
    building: _Building
    victim: _Victim
    severity: Annotated[Severity, col("How badly hurt: red ones expire, blue ones do not.")]
    room: Annotated[str | None, col("The room, by its true name.")]
    fate: Annotated[VictimFate, col("What became of the victim by the end of the mission.")]
    fate_ms: Annotated[int | None, col("When the victim was rescued or expired.", "ms")]


class ActionRow(Row, frozen=True):
    """One row per action of the rescuer."""

    participant: _Participant
    round: _Round
    adaptivity: _Adaptivity
    at_ms: _AtMs
    pressed_ms: Annotated[int, col("When its key was pressed, in mission time.", "ms")]
    action: Annotated[Action, col("What was done.")]
    outcome: Annotated[Outcome, col("What became of it.")]
    x: _X
    y: _Y
    heading: _Heading


class InstructionRow(Row, frozen=True):
    """One row per text on the yellow bar."""

    participant: _Participant
    round: _Round
    adaptivity: _Adaptivity
    number: Annotated[int, col("The instruction's number in its mission.")]
    at_ms: _AtMs
    until_ms: _UntilMs
    goal: _Goal
    level: _Level
    shown_level: Annotated[LevelName, col("The level of the words shown.")]
    fallback: Annotated[bool, col("Whether no instruction of the level in force exists there.")]
    text: _Text
    notice: Annotated[str, col("The correction shown before the text; mostly empty.")]
    tuples: Annotated[str, col("The (action, object) pairs, separated by semicolons.")]
    reason: Annotated[str, col("Why it was issued: goal, completed, level, off_path, misstep.")]
    x: _X
    y: _Y
    heading: _Heading
    end_x: Annotated[int, col("Where carrying it out leads, counted to the right.", "cells")]
    end_y: Annotated[int, col("Where carrying it out leads, counted down.", "cells")]
    treats: Annotated[bool, col("Whether it ends in a treatment.")]
    completed_ms: Annotated[int | None, col("When it was completed; empty if it was not.", "ms")]
    missteps_under: Annotated[int, col("Missteps while the instruction was in force.")]
    disobeyed_by: Annotated[
        Literal["repeat_misstep", "other_victim"] | None,
        col("How the instruction was first disobeyed, if it was."),
    ]


class PosteriorRow(Row, frozen=True):
    """One row per estimate of what the rescuer is heading for."""

    participant: _Participant
    round: _Round
    adaptivity: _Adaptivity
    at_ms: _AtMs
    goal: _Goal
    level: _Level
    comprehension: Annotated[float, _Comprehension]
    goal_probability: Annotated[float, col("P of the goal itself, which shares its room's.")]
    likeliest: Annotated[str, col("The victim with the greatest probability.")]
    likeliest_probability: Annotated[float, col("That probability.")]
    goals: Annotated[int, col("How many victims were waiting.")]
    window_moves: Annotated[int, col("Moves in the window.")]
    lower_below: Annotated[float, col("The threshold below which the level goes down.")]
    raise_above: Annotated[float, col("The threshold above which the level goes up.")]
    verdict: Annotated[
        Literal["lower", "keep", "raise", "none"],
        col("What the evaluation said; none: no evidence."),
    ]


class LevelRow(Row, frozen=True):
    """One row per stretch of a mission at one level; `comprehension` is what led to it."""

    participant: _Participant
    round: _Round
    adaptivity: _Adaptivity
    level: _Level
    from_ms: Annotated[int, col("When the level came into force, in mission time.", "ms")]
    until_ms: _UntilMs
    comprehension: Annotated[float | None, _Comprehension]


class PhaseRow(Row, frozen=True):
    """One row per phase that began."""

    participant: _Participant
    phase: _Phase
    round: _Round
    phase_ending: Annotated[StepEnding, col("How the phase ended, so far.")]
    exposure_ms: Annotated[int, col("How long a timed phase was on the screen.", "ms")]
    starts: Annotated[int, col("How often it was begun or continued: 1 where nothing broke.")]
    started_utc: _StartedUtc
    ended_utc: Annotated[str | None, _EndedUtc]


class FreeTextRow(Row, frozen=True):
    """One row per text in a participant's own words, which may identify them: kept apart."""

    participant: _Participant
    item: _Item
    text: _Text
    answer: _Answer
    response_ms: _ResponseMs
