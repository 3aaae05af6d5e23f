"""Where a session continues after any prefix of its records."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from game.forms.reading import paper_forms
from game.journal.history import Step, history_of
from game.journal.records import (
    Declined,
    Envelope,
    Exposed,
    PhaseEnded,
    PhaseStarted,
    Record,
    SessionEnded,
)
from game.study.course import course
from game.study.protocol.timeline import Point, next_point
from game.study.study_settings import InterruptionRules, StudySettings

SETTINGS = StudySettings(
    name="test", seed=1, blocks=1, buildings=("one", "two"), practice_building="three"
)
TIMELINE = course(paper_forms(), SETTINGS)
VOIDING = StudySettings(
    name="test",
    seed=1,
    blocks=1,
    buildings=("one", "two"),
    practice_building="three",
    interruption=InterruptionRules(memorise="void", label="void", mission="void"),
)

Log = list[tuple[Envelope, Record]]


def at(step: Step, record: Record) -> tuple[Envelope, Record]:
    moment = "2026-01-01T00:00:00.000Z"
    return Envelope(0, 0, 0, moment, step.phase, step.round), record


def passed(steps: tuple[Step, ...]) -> Log:
    log: Log = []
    for step in steps:
        log += [at(step, PhaseStarted(None)), at(step, PhaseEnded("completed", 1000))]
    return log


def broken_off(step: Step, exposure_ms: int = 7000) -> Log:
    """A session interrupted in `step` after `exposure_ms` of it."""
    before = TIMELINE[: TIMELINE.index(step)]
    return [
        *passed(before),
        at(step, PhaseStarted(60_000)),
        at(step, Exposed(exposure_ms)),
    ]


@given(st.integers(0, len(TIMELINE) - 1))
def test_after_some_steps_comes_the_next(done: int) -> None:
    point = next_point(history_of(passed(TIMELINE[:done])), SETTINGS, TIMELINE)
    assert point == Point(TIMELINE[done], 0, ())


def test_after_the_last_step_nothing_comes() -> None:
    assert next_point(history_of(passed(TIMELINE)), SETTINGS, TIMELINE).step is None


@pytest.mark.parametrize("phase", ["preflight", "consent", "practice", "preference", "debrief"])
def test_an_untimed_phase_starts_again(phase: str) -> None:
    step = next(step for step in TIMELINE if step.phase == phase)
    assert next_point(history_of(broken_off(step)), SETTINGS, TIMELINE) == Point(step, 0, ())


@pytest.mark.parametrize("phase", ["sliders", "likert"])
def test_questions_are_asked_again_in_their_round(phase: str) -> None:
    step = next(step for step in TIMELINE if step == (phase, 2))
    assert next_point(history_of(broken_off(step)), SETTINGS, TIMELINE).step == step


@pytest.mark.parametrize("phase", ["memorise", "label"])
def test_memorising_and_labelling_continue_with_the_time_left(phase: str) -> None:
    step = next(step for step in TIMELINE if step == (phase, 1))
    assert next_point(history_of(broken_off(step)), SETTINGS, TIMELINE) == Point(step, 7000, ())


def test_a_continued_phase_adds_to_its_exposure() -> None:
    step = Step("memorise", 1)
    log = [*broken_off(step), at(step, PhaseStarted(53_000, continued=True))]
    assert next_point(history_of(log), SETTINGS, TIMELINE).exposure_ms == 7000
    log.append(at(step, Exposed(9000)))
    assert next_point(history_of(log), SETTINGS, TIMELINE).exposure_ms == 9000


def test_an_interrupted_mission_ends() -> None:
    mission = Step("mission", 1)
    point = next_point(history_of(broken_off(mission)), SETTINGS, TIMELINE)
    assert point == Point(Step("sliders", 1), 0, ((mission, "interrupted"),))


@pytest.mark.parametrize("phase", ["memorise", "label", "mission"])
def test_a_void_round_is_left_for_the_next(phase: str) -> None:
    step = next(step for step in TIMELINE if step == (phase, 1))
    point = next_point(history_of(broken_off(step)), VOIDING, TIMELINE)
    assert point.step == Step("memorise", 2)
    assert {ending for _, ending in point.settle} == {"void"}
    assert point.settle[-1][0] == Step("likert", 1)
    last = next_point(history_of(broken_off(step._replace(round=2))), VOIDING, TIMELINE)
    assert last.step == Step("preference")


@pytest.mark.parametrize("record", [Declined("1"), SessionEnded("finished")])
def test_a_session_that_is_over_stays_over(record: Record) -> None:
    log = [*passed(TIMELINE[:2]), at(Step("consent"), record)]
    assert next_point(history_of(log), SETTINGS, TIMELINE) == Point(None, 0, ())
