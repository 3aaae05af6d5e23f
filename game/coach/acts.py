"""What a coach did: tagged structs, written to the journal as they are."""

from __future__ import annotations

from enum import IntEnum
from typing import Literal

import msgspec

from game.world.geometry import Cell, Heading

GoalReason = Literal["start", "rescued", "expired", "too_late", "strayed", "other_rescued"]
IssueReason = Literal[
    "goal", "completed", "level", "off_path", "restated", "misstep", "heeded", "resumed", "lost"
]
LostBy = Literal["standing", "wandering"]


class Level(IntEnum):
    """The level of abstraction of an instruction (paper 5.1.2)."""

    C1 = 1
    C2 = 2
    C3 = 3


class CoachAct(msgspec.Struct, frozen=True, tag_field="type"):
    """Something the coach did at mission time `at_ms`."""

    at_ms: int


class GoalSet(CoachAct, frozen=True, tag="goal_set"):
    """The victim to rescue next. `route` is the planned order from here, goal first.

    `too_late`: the goal before could not be treated in time any more; `other_rescued`: a victim
    was rescued that was not the goal.
    """

    goal: str
    room: str | None
    route: tuple[str, ...]
    reason: GoalReason


class NothingLeft(CoachAct, frozen=True, tag="nothing_left"):
    """There is nobody left to lead the rescuer to; `notice` stands alone on the bar from now on."""

    notice: str


class InstructionIssued(CoachAct, frozen=True, tag="instruction_issued", kw_only=True):
    """A new text on the bar.

    `level` is the level in force, `shown_level` that of the words: lower where `fallback` is true
    because no instruction of `level` exists here. `tuples` are (action, object) pairs. `end` is
    where carrying it out leads; `treats` tells whether it ends in a treatment.
    """

    number: int
    goal: str
    level: Level
    shown_level: Level
    fallback: bool = False
    tuples: tuple[tuple[str, str], ...] = ()
    text: str
    notice: str = ""
    position: Cell
    heading: Heading
    end: Cell
    treats: bool = False
    reason: IssueReason = "goal"


class NoticeTakenDown(CoachAct, frozen=True, tag="notice_taken_down"):
    """The notice before instruction `number` was understood, and has left the bar."""

    number: int


class InstructionCompleted(CoachAct, frozen=True, tag="instruction_completed"):
    number: int


class Misstep(CoachAct, frozen=True, tag="misstep"):
    """The cost-to-go rose `excess` cells above its minimum since instruction `number`."""

    number: int
    level: Level
    excess: int


class LostNoticed(CoachAct, frozen=True, tag="lost_noticed"):
    """The rescuer has not come nearer for too long under instruction `number`."""

    number: int
    by: LostBy


class Disobeyed(CoachAct, frozen=True, tag="disobeyed"):
    number: int
    kind: Literal["repeat_misstep", "other_victim"]


class PosteriorEvaluated(CoachAct, frozen=True, tag="posterior_evaluated"):
    """P(g* | path) at an evaluation, with the whole posterior over the waiting victims.

    `comprehension` is the P(g*) that is compared with the thresholds (at the victim or the room,
    as the preset says); `moves` counts the moves in the window; `evidence` is false where the
    preset holds that the window carries none, and then `verdict` is `none`.
    """

    goal: str
    posterior: dict[str, float]
    comprehension: float
    moves: int
    lower_below: float
    raise_above: float
    verdict: Literal["lower", "keep", "raise", "none"]


class LevelChanged(CoachAct, frozen=True, tag="level_changed"):
    """`comprehension` is what led to it; None where the coach does not judge by it."""

    before: Level
    after: Level
    comprehension: float | None = None


class BeliefChanged(CoachAct, frozen=True, tag="belief_changed"):
    """The coach's estimate b^HR of what the rescuer believes has changed (paper 5.1.3).

    `rooms_learned` are rooms whose place became known, `victims_seen` victims whose cell became
    known, `unseen_cells` how many cells the victims still unseen may be in.
    """

    rooms_learned: tuple[str, ...]
    victims_seen: tuple[str, ...]
    victims_resolved: tuple[str, ...]
    unseen_cells: int


ChoiceReason = Literal["soonest", "stays", "looks_lost", "lost", "asked"]
"""Why `knowledge` chose a level: it is expected to be soonest; another would be sooner, but by too
little to change; the walk looks like that of somebody who does not know the way; the rescuer has
not come nearer for too long, or has asked for other words."""


class KnowledgeJudged(CoachAct, frozen=True, tag="knowledge_judged", kw_only=True):
    """What the coach held the rescuer to know when it chose the level `chosen` for `goal`.

    `known` is P(the place of the room is known) by room, and `share` the expected share of rooms
    known from the start. `expected_ms` is how long the leg is expected to take at each level, by
    `C1` to `C3`; a level that cannot be chosen is not in it, and a coach that judges by `known`
    alone expects nothing.
    """

    goal: str
    room: str | None
    known: dict[str, float]
    share: float
    expected_ms: dict[str, float]
    chosen: Level
    why: ChoiceReason


class PaceLearned(CoachAct, frozen=True, tag="pace_learned"):
    """The learned A^HR: how many milliseconds the rescuer takes for a move."""

    ms_per_move: float


CoachRecord = (
    GoalSet
    | NothingLeft
    | InstructionIssued
    | NoticeTakenDown
    | InstructionCompleted
    | Misstep
    | LostNoticed
    | Disobeyed
    | PosteriorEvaluated
    | LevelChanged
    | BeliefChanged
    | KnowledgeJudged
    | PaceLearned
)
