"""The timeline of a session, how far a journal shows it to have come, and where to go on.

Pure: what the screens do and where a resume goes both follow from the records alone (design 7).
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from functools import reduce
from typing import Literal, NamedTuple

from game.journal.records import (
    Allocated,
    Declined,
    Envelope,
    Exposed,
    Phase,
    PhaseEnded,
    PhaseStarted,
    Record,
    SessionEnded,
    Withdrawn,
)
from game.study.study_settings import StudySettings

ROUNDS = (1, 2)
ROUND_PHASES: tuple[Phase, ...] = ("memorise", "label", "mission", "sliders", "likert")
Ending = Literal["completed", "timed_out", "interrupted", "void"]


class Step(NamedTuple):
    """One phase of the session; `round` is 0 outside the rounds."""

    phase: Phase
    round: int = 0


TIMELINE: tuple[Step, ...] = (
    Step("preflight"),
    Step("consent"),
    Step("practice"),
    *(Step(phase, number) for number in ROUNDS for phase in ROUND_PHASES),
    Step("preference"),
    Step("debrief"),
)


@dataclass(frozen=True)
class Progress:
    """How far a session has come.

    `begun` is the step under way, with `exposure_ms` of it seen; `endings` are those of the steps
    behind. `over` tells that nothing follows: finished, `declined` or withdrawn.
    """

    begun: Step | None = None
    exposure_ms: int = 0
    endings: Mapping[Step, Ending] = field(default_factory=dict)
    allocated: Allocated | None = None
    over: bool = False
    declined: bool = False

    def after(self, envelope: Envelope, record: Record) -> Progress:
        """The progress once `record` has been written."""
        step = Step(envelope.phase, envelope.round)
        match record:
            case PhaseStarted(continued=continued):
                return replace(self, begun=step, exposure_ms=self.exposure_ms if continued else 0)
            case Exposed(exposure_ms=exposure_ms):
                return replace(self, exposure_ms=exposure_ms)
            case PhaseEnded(ending=ending):
                return replace(
                    self, begun=None, exposure_ms=0, endings={**self.endings, step: ending}
                )
            case Allocated():
                return replace(self, allocated=record)
            case Declined():
                return replace(self, over=True, declined=True)
            case Withdrawn() | SessionEnded(reason="finished"):
                return replace(self, over=True)
            case _:
                return self


def progress(records: Iterable[tuple[Envelope, Record]]) -> Progress:
    """How far the session with these records has come."""
    return reduce(lambda so_far, pair: so_far.after(*pair), records, Progress())


class Point(NamedTuple):
    """Where a session goes on: at `step`, of which `exposure_ms` have been seen.

    `settle` names steps that broke off and cannot go on, with the ending each of them gets; the
    session settles them in the journal before it goes on.
    """

    step: Step | None
    exposure_ms: int
    settle: tuple[tuple[Step, Ending], ...]


def next_point(progress: Progress, settings: StudySettings) -> Point:
    """Where a session goes on after `progress`: `step` is None when it is over.

    An untimed phase starts again where it was; a timed one follows the study's setting for it.
    """
    if progress.over:
        return Point(None, 0, ())
    settled: list[tuple[Step, Ending]] = []
    begun = progress.begun
    if begun is not None:
        rule = _rule(begun.phase, settings)
        if rule == "continue":
            return Point(begun, progress.exposure_ms, ())
        if rule == "end":
            settled.append((begun, "interrupted"))
        elif rule == "void":
            settled += [(step, "void") for step in _rest_of_round(begun)]
    behind = {**progress.endings, **dict(settled)}
    following = next((step for step in TIMELINE if step not in behind), None)
    return Point(following, 0, tuple(settled))


def _rule(phase: Phase, settings: StudySettings) -> Literal["again", "continue", "end", "void"]:
    match phase:
        case "memorise":
            return settings.interruption.memorise
        case "label":
            return settings.interruption.label
        case "mission":
            return settings.interruption.mission
        case _:
            return "again"


def _rest_of_round(step: Step) -> tuple[Step, ...]:
    return tuple(other for other in TIMELINE[TIMELINE.index(step) :] if other.round == step.round)
