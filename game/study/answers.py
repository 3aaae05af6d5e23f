"""What a participant has answered so far: the last answer to each question counts."""

from __future__ import annotations

from dataclasses import dataclass, field

from game.coach.knowledge.assumed import QuizMark
from game.journal.records import PreferenceGiven, QuestionnaireAnswer, QuizAnswer, Record
from game.study.protocol import Step
from game.world.building import Building
from game.world.events import Rescued


@dataclass
class Answers:
    """`items` holds questionnaire answers and `labels` room names given, both by step; `legs`
    counts the victims treated in practice."""

    items: dict[tuple[Step, str], QuestionnaireAnswer] = field(default_factory=dict)
    labels: dict[Step, dict[str, str]] = field(default_factory=dict)
    preference: PreferenceGiven | None = None
    legs: int = 0

    def marks(self, building: Building, round_: int) -> dict[str, QuizMark]:
        """How the rooms of `building` were labelled in a round."""
        labels = self.labels.get(Step("label", round_), {})
        return {room.name: _mark(room.name, labels.get(room.name)) for room in building.rooms}

    def note(self, step: Step, record: Record) -> None:
        """Take account of one record."""
        match record:
            case QuestionnaireAnswer():
                self.items[step, record.item] = record
            case QuizAnswer(room=room, answer=None):
                self.labels.get(step, {}).pop(room, None)
            case QuizAnswer(room=room, answer=str(name)):
                self.labels.setdefault(step, {})[room] = name
            case PreferenceGiven():
                self.preference = record
            case Rescued() if step.phase == "practice":
                self.legs += 1
            case _:
                pass


def _mark(room: str, label: str | None) -> QuizMark:
    return "blank" if label is None else "right" if label == room else "wrong"
