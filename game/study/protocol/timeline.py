"""How far a journal shows that a session has got, and where to continue.

Pure: what the screens show and where a session resumes follow from the records alone.
"""

from __future__ import annotations

from typing import Literal, NamedTuple

from game.journal.history import History, PhaseEnding, Step
from game.study.course import Course
from game.study.study_settings import StudySettings


class Point(NamedTuple):
    """Where a session continues: at `step`, of which `exposure_ms` have been seen.

    `settle` lists interrupted steps that cannot continue, with the ending that each of them gets;
    the session writes these endings to the journal before it continues.
    """

    step: Step | None
    exposure_ms: int
    settle: tuple[tuple[Step, PhaseEnding], ...]


def next_point(so_far: History, settings: StudySettings, steps: Course) -> Point:
    """Where a session of these steps continues after `so_far`; `step` is None when it is over.

    An untimed phase starts again; a timed one follows the study's setting for it.
    """
    if so_far.over:
        return Point(None, 0, ())
    settled: list[tuple[Step, PhaseEnding]] = []
    begun = so_far.begun
    if begun is not None:
        rule = _rule(begun.phase, settings)
        if rule == "continue":
            return Point(begun, so_far.exposure_ms, ())
        if rule == "end":
            settled.append((begun, "interrupted"))
        elif rule == "void":
            settled += [(step, "void") for step in _rest_of_round(begun, steps)]
    behind = {**so_far.endings, **dict(settled)}
    following = next((step for step in steps if step not in behind), None)
    return Point(following, 0, tuple(settled))


def _rule(phase: str, settings: StudySettings) -> Literal["again", "continue", "end", "void"]:
    match phase:
        case "memorise":
            return settings.interruption.memorise
        case "label":
            return settings.interruption.label
        case "mission":
            return settings.interruption.mission
        case _:
            return "again"


def _rest_of_round(step: Step, steps: Course) -> Course:
    return tuple(other for other in steps[steps.index(step) :] if other.round == step.round)
