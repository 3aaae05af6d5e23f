"""Conducts a session from its first phase to its last.

`timeline` says which phase comes next; here each phase is carried out with a `Participant`, which
is a set of screens or a simulated person. Everything that happened is in the journal before the
next thing begins.
"""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable
from contextlib import suppress
from typing import Literal, Protocol

from game.coach.knowledge.assumed import QuizMark
from game.coach.spec import CoachSpec, coach_given
from game.errors import AnaError, where
from game.journal.history import History, Step
from game.journal.records import (
    ROUNDS,
    Allocated,
    Consented,
    Debriefed,
    FreeText,
    Phase,
    PhaseEnded,
    PhaseStarted,
    PracticeChecked,
    PreferenceGiven,
    Preflighted,
    QuizSubmitted,
)
from game.study.chance import shuffled
from game.study.ledger import NoPlace
from game.study.protocol.practice import (
    PracticeLeg,
    leg_building,
    leg_settings,
    leg_start,
    practice_legs,
)
from game.study.protocol.study_session import StudySession
from game.study.protocol.tasks import Asked, Exposure, Labelling, Memorising, Playing, Sheet
from game.study.protocol.timeline import Point, next_point
from game.study.study_settings import ScreenSize, StudySettings
from game.study.texts import LIKERT_POINTS, Consent, Page, filled, followed, preceded
from game.world.building import Building, Severity
from game.world.geometry import Cell, Heading

SLIDER_POINTS = 100


class Stopped(Exception):
    """The participant stopped; the session can be resumed."""


class Participant(Protocol):
    """Someone who takes part. Each method returns when its task is done; any may raise Stopped."""

    async def check(self, needed: ScreenSize) -> Preflighted:
        """Check the terminal; returns when it is large enough."""
        ...

    async def agree(self, page: Consent) -> bool: ...

    async def read(self, page: Page) -> None: ...

    async def look(self, page: Page, building: Building) -> None:
        """Read a page beside a map with room names, without a time limit."""
        ...

    async def memorise(self, task: Memorising) -> None:
        """Call `exposure.begin`, then `exposure.tick` until it is over."""
        ...

    async def label(self, task: Labelling) -> None:
        """The same, but it may return earlier."""
        ...

    async def play(self, task: Playing) -> None:
        """Call `begin`, and play until `done`."""
        ...

    async def choose(self, page: Page, sheet: Sheet) -> None:
        """Answer one question by one of its anchors, from 1."""
        ...

    async def slide(self, page: Page, sheet: Sheet) -> None:
        """Answer every question by a number between two anchors."""
        ...

    async def rate(self, page: Page, sheet: Sheet) -> None:
        """Answer every question by one of its anchors, from 1."""
        ...

    async def prefer(self, page: Page, options: tuple[str, str]) -> Literal[1, 2]:
        """The round whose instructor is preferred."""
        ...

    async def explain(self, page: Page) -> str:
        """Some words, or none."""
        ...


async def conduct(session: StudySession, participant: Participant) -> Literal["over", "stopped"]:
    """Conduct the session from where it is to its end, or until the participant leaves.

    The journal is closed afterwards. Raises JournalError or LedgerError if nothing can be written;
    everything recorded until then is kept.
    """
    try:
        closing = await _to_the_end(session, participant)
        with suppress(Stopped):
            await participant.read(closing)
    except Stopped:
        session.stop()
        return "stopped"
    except AnaError:
        raise
    except Exception as error:
        with suppress(Exception):
            session.note_defect(where(error))
        raise
    finally:
        await asyncio.to_thread(session.journal.close)
    return "over"


async def _to_the_end(session: StudySession, who: Participant) -> Page:
    """Conduct the session until it is over or there is no place for it; returns the last page."""
    texts = session.study.texts
    try:
        if not session.history.over:
            await session.see_place()
        while (point := next_point(session.history, session.study.settings)).step is not None:
            await _settle(session, point)
            await _PHASES[point.step.phase](session, who, point.step, point.exposure_ms)
    except NoPlace:
        await session.turn_away()
        return texts.no_place
    if session.history.declined:
        return texts.declined
    if not session.history.over:
        await session.finish("finished")
    return filled(texts.debrief, code=session.completion_code)


async def _settle(session: StudySession, point: Point) -> None:
    for step, ending in point.settle:
        exposure_ms = session.history.exposure_ms if step == session.history.begun else 0
        session.enter(step)
        await session.save(PhaseEnded(ending, exposure_ms))


async def _start(session: StudySession, step: Step, left_ms: int | None, seen_ms: int = 0) -> None:
    session.enter(step)
    await session.save(PhaseStarted(left_ms, continued=seen_ms > 0))


async def _preflight(session: StudySession, who: Participant, step: Step, _seen_ms: int) -> None:
    await _start(session, step, None)
    checked = await who.check(session.study.settings.screen)
    await session.save(checked, PhaseEnded("completed", 0))


async def _consent(session: StudySession, who: Participant, step: Step, _seen_ms: int) -> None:
    await _start(session, step, None)
    texts = session.study.texts
    page = texts.consent
    if not await who.agree(page):
        await session.decline(texts.version)
        return
    text = f"{page.title}\n\n{page.body.strip()}\n\n{page.agree}"
    session.record(Consented(texts.version, text, of_age=True), PhaseEnded("completed", 0))
    await session.keep()


async def _practice(session: StudySession, who: Participant, step: Step, _seen_ms: int) -> None:
    await _start(session, step, None)
    study, texts = session.study, session.study.texts
    settings = leg_settings(study.settings.mission)
    planned = practice_legs(study.practice, session.seed)
    done = min(session.history.treated_in_practice, len(planned))
    if done == 0:
        await who.read(texts.practice)
        await who.read(texts.lessons.walking)
    stand: tuple[Cell, Heading] | None = None
    for leg in planned[done:]:
        await _teach(session, who, leg, again=leg.number == done)
        start, heading = leg_start(study.practice, planned[: leg.number], stand)
        building = leg_building(study.practice, leg, start, heading)
        task = Playing(session, building, leg.spec, settings, f"leg {leg.number}", goals=1)
        await who.play(task)
        assert task.run is not None
        task.leave(task.run.mission.time_ms)
        stand = task.run.mission.position, task.run.mission.heading
    right = await _check(session, who)
    await session.save(
        PracticeChecked(right=right, asked=len(study.items.check)), PhaseEnded("completed", 0)
    )


async def _teach(session: StudySession, who: Participant, leg: PracticeLeg, *, again: bool) -> None:
    """Explain a leg's kind of instruction if this is its first leg, or the first after a resume."""
    if leg.opens_kind or again:
        lesson = session.study.texts.lessons.of(leg.level)
        if lesson.map:
            await who.look(lesson, session.study.practice)
        else:
            await who.read(lesson)


async def _check(session: StudySession, who: Participant) -> int:
    """The check at the end of practice, with feedback; returns the number of right answers."""
    texts, right = session.study.texts, 0
    for check in session.study.items.check:
        asked = Asked(check.id, check.text, check.answers, 1, len(check.answers))
        sheet = Sheet(session, (asked,))
        if not sheet.complete:
            await who.choose(texts.check, sheet)
            told = texts.check_right if sheet.value(asked) == check.right else texts.check_wrong
            await who.read(filled(told, answer=check.answers[check.right - 1]))
        right += sheet.value(asked) == check.right
    return right


async def _memorise(session: StudySession, who: Participant, step: Step, seen_ms: int) -> None:
    session.enter(step)
    allocated = await _allocated(session)
    texts, limit_ms = session.study.texts, allocated.memorise_ms
    left_ms = limit_ms - seen_ms
    await who.read(filled(texts.memorise, time=texts.units.time(left_ms)))
    await _start(session, step, left_ms, seen_ms)
    exposure = Exposure(session, limit_ms, seen_ms)
    await who.memorise(Memorising(_building(session, step), exposure))
    await session.save(PhaseEnded("completed", exposure.seen_ms))


async def _label(session: StudySession, who: Participant, step: Step, seen_ms: int) -> None:
    texts, limit_ms = session.study.texts, session.study.settings.label_seconds * 1000
    left_ms = limit_ms - seen_ms
    await who.read(filled(texts.label, time=texts.units.time(left_ms)))
    await _start(session, step, left_ms, seen_ms)
    exposure = Exposure(session, limit_ms, seen_ms)
    task = Labelling(session, _building(session, step), exposure)
    await who.label(task)
    ending: Literal["timed_out", "completed"] = "timed_out" if exposure.over else "completed"
    await session.save(
        QuizSubmitted(right=task.right, asked=len(task.rooms)),
        PhaseEnded(ending, exposure.seen_ms),
    )


async def _mission(session: StudySession, who: Participant, step: Step, _seen_ms: int) -> None:
    study, texts = session.study, session.study.texts
    rules, building = study.settings.mission, _building(session, step)
    page = filled(
        texts.mission,
        time=texts.units.time(rules.duration_ms),
        red_time=texts.units.time(rules.reds_expire_ms),
        victims=str(len(building.victims)),
        reds=str(sum(site.severity is Severity.RED for site in building.victims)),
        instructor=texts.instructors.of(step.round),
    )
    await who.read(followed(page, texts.level_key.text) if rules.level_key else page)
    await _start(session, step, rules.duration_ms)
    quiz = quiz_marks(session.history, building, step.round)
    spec = instructor(await _allocated(session), step.round, study.settings, quiz)
    task = Playing(session, building, spec, rules, f"round {step.round}")
    await who.play(task)
    assert task.run is not None
    await session.save(PhaseEnded("completed", task.run.mission.time_ms))


async def _sliders(session: StudySession, who: Participant, step: Step, _seen_ms: int) -> None:
    await _start(session, step, None)
    texts, items = session.study.texts, session.study.items
    asked = tuple(
        Asked(slider.id, slider.text, (slider.low, slider.high), 1, SLIDER_POINTS)
        for slider in shuffled(items.slider, lambda it: it.id, session.seed, "sliders", step.round)
    )
    page = filled(texts.mental_state, instructor=texts.instructors.of(step.round))
    if session.history.endings.get(Step("mission", step.round)) == "interrupted":
        page = preceded(page, texts.cut_off.mission)
    await who.slide(page, Sheet(session, asked))
    await session.save(PhaseEnded("completed", 0))


async def _likert(session: StudySession, who: Participant, step: Step, _seen_ms: int) -> None:
    await _start(session, step, None)
    texts, items = session.study.texts, session.study.items
    order = shuffled(items.statement, lambda it: it.id, session.seed, "statements", step.round)
    asked = tuple(Asked(it.id, it.text, items.scale.answers, 1, LIKERT_POINTS) for it in order)
    page = filled(texts.likert, instructor=texts.instructors.of(step.round))
    await who.rate(page, Sheet(session, asked))
    await session.save(PhaseEnded("completed", 0))


async def _preference(session: StudySession, who: Participant, step: Step, _seen_ms: int) -> None:
    await _start(session, step, None)
    texts = session.study.texts
    options = texts.instructors.first, texts.instructors.second
    if session.history.preference is None:
        page, shown_ms = texts.preference, session.now_ms()
        preferred = await who.prefer(page, options)
        await session.save(
            PreferenceGiven(
                item="preferred_instructor",
                text=page.body.strip(),
                options=options,
                preferred_round=preferred,
                response_ms=session.now_ms() - shown_ms,
                version=session.study.version,
            )
        )
    page, shown_ms = texts.reason, session.now_ms()
    answer = await who.explain(page)
    await session.save(
        FreeText(
            "reason",
            page.body.strip(),
            answer,
            session.now_ms() - shown_ms,
            version=session.study.version,
        ),
        PhaseEnded("completed", 0),
    )


async def _debrief(session: StudySession, _who: Participant, step: Step, _seen_ms: int) -> None:
    """The last page is shown only once everything that it says is true."""
    await _start(session, step, None)
    await session.save(Debriefed(session.completion_code), PhaseEnded("completed", 0))


_PHASES: dict[Phase, Callable[[StudySession, Participant, Step, int], Awaitable[None]]] = {
    "preflight": _preflight,
    "consent": _consent,
    "practice": _practice,
    "memorise": _memorise,
    "label": _label,
    "mission": _mission,
    "sliders": _sliders,
    "likert": _likert,
    "preference": _preference,
    "debrief": _debrief,
}


def instructor(
    allocated: Allocated, round_: int, settings: StudySettings, quiz: dict[str, QuizMark]
) -> CoachSpec:
    """Who coaches a round. Only a coach that asks for the round's label quiz is given it."""
    if allocated.adaptive_first is (round_ == ROUNDS[0]):
        return coach_given(
            settings.coach, level=allocated.static_level, preset=settings.preset, quiz=quiz
        )
    return CoachSpec("static", level=allocated.static_level)


async def _allocated(session: StudySession) -> Allocated:
    if session.history.allocated is None:
        await session.allocate()
    allocated = session.history.allocated
    assert allocated is not None
    return allocated


def _building(session: StudySession, step: Step) -> Building:
    allocated = session.history.allocated
    assert allocated is not None
    return session.study.building(allocated.buildings[step.round - 1])


def quiz_marks(history: History, building: Building, round_: int) -> dict[str, QuizMark]:
    """How the rooms of `building` were labelled in a round."""
    given = history.names_given(round_)

    def mark(room: str) -> QuizMark:
        return "blank" if room not in given else "right" if given[room] == room else "wrong"

    return {room.name: mark(room.name) for room in building.rooms}
