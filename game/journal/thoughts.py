"""What the coach thinks at a given moment, worked out from its records."""

from __future__ import annotations

from dataclasses import dataclass, replace

from game.coach.acts import (
    BeliefChanged,
    Disobeyed,
    GoalSet,
    InstructionIssued,
    KnowledgeJudged,
    Level,
    LevelChanged,
    Misstep,
    NothingLeft,
    NoticeTakenDown,
    PaceLearned,
    PosteriorEvaluated,
)
from game.journal.records import RunRecord
from game.world.observation import Guidance


@dataclass(frozen=True)
class Thoughts:
    """The coach's state of mind, as far as its records show it.

    `guidance` is the text on the bar. `evaluation` is the latest, possibly of a goal before `goal`;
    `judged` is the latest choice by what the rescuer knows. The rooms and victims are those whose
    place the rescuer knows, as the coach believes (b^HR); `unseen_cells` counts the cells where, in
    the same belief, the rescuer thinks any other victim may be.
    """

    level: Level | None = None
    goal: str | None = None
    room: str | None = None
    route: tuple[str, ...] = ()
    instruction: InstructionIssued | None = None
    guidance: Guidance | None = None
    evaluation: PosteriorEvaluated | None = None
    judged: KnowledgeJudged | None = None
    rooms_known: frozenset[str] = frozenset()
    victims_known: frozenset[str] = frozenset()
    victims_resolved: frozenset[str] = frozenset()
    unseen_cells: int | None = None
    ms_per_move: float | None = None
    missteps: int = 0
    disobeyed: int = 0

    def after(self, record: RunRecord) -> Thoughts:
        """The thoughts after `record`; most mission events change nothing."""
        match record:
            case GoalSet():
                return replace(self, goal=record.goal, room=record.room, route=record.route)
            case InstructionIssued():
                words = Guidance(record.text, record.notice)
                return replace(self, instruction=record, guidance=words, level=record.level)
            case NoticeTakenDown() if self.guidance is not None:
                return replace(self, guidance=Guidance(self.guidance.text))
            case NothingLeft():
                alone = Guidance("", record.notice)
                return replace(self, goal=None, room=None, route=(), guidance=alone)
            case LevelChanged():
                return replace(self, level=record.after)
            case PosteriorEvaluated():
                return replace(self, evaluation=record)
            case KnowledgeJudged():
                return replace(self, judged=record)
            case BeliefChanged():
                return replace(
                    self,
                    rooms_known=self.rooms_known.union(record.rooms_learned),
                    victims_known=self.victims_known.union(record.victims_seen),
                    victims_resolved=self.victims_resolved.union(record.victims_resolved),
                    unseen_cells=record.unseen_cells,
                )
            case PaceLearned():
                return replace(self, ms_per_move=record.ms_per_move)
            case Misstep():
                return replace(self, missteps=self.missteps + 1)
            case Disobeyed():
                return replace(self, disobeyed=self.disobeyed + 1)
            case _:
                return self
