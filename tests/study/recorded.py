"""What a scripted participant's journal holds."""

from __future__ import annotations

from typing import Any

from game.journal.history import Step
from game.journal.reader import Entry
from game.journal.records import (
    FreeText,
    PhaseEnded,
    PreferenceGiven,
    QuestionnaireAnswer,
    QuizAnswer,
)
from game.study.folder import Study
from tests.study.people import journal_of


def step_of(entry: Entry) -> Step:
    return Step(entry.envelope.phase, entry.envelope.round)


def records(study: Study, *kinds: type) -> list[Any]:
    return [e.record for e in journal_of(study).entries if isinstance(e.record, kinds)]


def endings(study: Study) -> dict[Step, str]:
    return {
        step_of(entry): entry.record.ending
        for entry in journal_of(study).entries
        if isinstance(entry.record, PhaseEnded)
    }


def answers(entries: tuple[Entry, ...]) -> dict[tuple[Step, str], object]:
    """Every answer by its step and question."""
    found: dict[tuple[Step, str], object] = {}
    for entry in entries:
        match entry.record:
            case QuestionnaireAnswer(item=item, value=value):
                found[step_of(entry), item] = value
            case QuizAnswer(room=room, answer=answer):
                found[step_of(entry), room] = answer
            case PreferenceGiven(item=item, preferred_round=preferred):
                found[step_of(entry), item] = preferred
            case FreeText(item=item, answer=text):
                found[step_of(entry), item] = text
    return found
