"""Conducts a session from its first phase to its last.

`timeline` says which phase comes next; here each phase is carried out with a `Participant`, which
is a set of screens or a simulated person. Everything that happened is in the journal before the
next thing begins.
"""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable, Sequence
from contextlib import suppress
from typing import Literal, Protocol

from game.coach.knowledge.assumed import QuizMark
from game.coach.spec import CoachSpec
from game.coach.yoke import Yoke
from game.errors import AnaError, where
from game.forms.form import Form
from game.forms.items import HeadingItem, Item
from game.journal.history import History, Step
from game.journal.records import (
    Allocated,
    Consented,
    Debriefed,
    FreeText,
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
from game.study.protocol.tasks import Exposure, Labelling, Memorising, Playing, Sheet
from game.study.protocol.timeline import Point, next_point
from game.study.study_settings import ScreenSize, StudySettings
from game.study.texts import Consent, Page, filled, followed, preceded
from game.world.building import Building, Severity
from game.world.geometry import Cell, Heading


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
        """Answer the one question by one of its answers."""
        ...

    async def fill(self, page: Page, sheet: Sheet) -> None:
        """Answer what must be answered, and whatever else they like."""
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
        while (step := (point := _next(session)).step) is not None:
            await _settle(session, point)
            if step.round and session.history.allocated is None:
                session.enter(step)
                await session.allocate()
            await _PHASES.get(step.phase, _form)(session, who, step, point.exposure_ms)
    except NoPlace:
        await session.turn_away()
        return texts.no_place
    if session.history.declined:
        return texts.declined
    if not session.history.over:
        await session.finish("finished")
    return filled(texts.debrief, code=session.completion_code)


def _next(session: StudySession) -> Point:
    return next_point(session.history, session.study.settings, session.study.course)


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
    right, asked = await _check(session, who)
    await session.save(PracticeChecked(right=right, asked=asked), PhaseEnded("completed", 0))


async def _teach(session: StudySession, who: Participant, leg: PracticeLeg, *, again: bool) -> None:
    """Explain a leg's kind of instruction if this is its first leg, or the first after a resume."""
    if leg.opens_kind or again:
        lesson = session.study.texts.lessons.of(leg.level)
        if lesson.map:
            await who.look(lesson, session.study.practice)
        else:
            await who.read(lesson)


async def _check(session: StudySession, who: Participant) -> tuple[int, int]:
    """The check at the end of practice, with feedback; returns the number of right answers, and of
    questions."""
    texts, form, right = session.study.texts, session.study.forms.check, 0
    if form is None:
        return 0, 0
    page = Page(title=form.title, body=form.body)
    for question in form.questions:
        sheet = Sheet(session, (question,))
        if not sheet.complete:
            await who.choose(page, sheet)
            right_now = question.is_right(sheet.value(question))
            told = texts.check_right if right_now else texts.check_wrong
            await who.read(filled(told, answer=question.anchors[question.rights[0] - 1]))
        right += question.is_right(sheet.value(question))
    return right, len(form.questions)


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
    allocated = await _allocated(session)
    leads = study.settings.pair[allocated.second_leads(step.round)]
    yoke = None
    if leads.takes("yoke"):
        yoke = await asyncio.to_thread(
            study.yoke_for, session.identity, building, allocated.memorise_ms
        )
    spec = instructor(allocated, step.round, study.settings, quiz, yoke)
    task = Playing(session, building, spec, rules, f"round {step.round}")
    await who.play(task)
    assert task.run is not None
    await session.save(PhaseEnded("completed", task.run.mission.time_ms))


async def _form(session: StudySession, who: Participant, step: Step, _seen_ms: int) -> None:
    """Any form, wherever it is asked."""
    await _start(session, step, None)
    texts = session.study.texts
    form, _ = session.study.forms.occasion(step.phase)
    page = Page(title=form.title, body=form.body)
    if step.round:
        page = filled(page, instructor=texts.instructors.of(step.round))
        first = next(it for it in session.study.course if it.round == step.round and _is_form(it))
        interrupted = session.history.endings.get(Step("mission", step.round)) == "interrupted"
        if step == first and interrupted:
            page = preceded(page, texts.cut_off.mission)
    sheet = Sheet(session, items_in_order(form, session.seed, step.round))
    if sheet.asked:
        await who.fill(page, sheet)
    await sheet.close()
    await session.save(PhaseEnded("completed", 0))


def _is_form(step: Step) -> bool:
    return step.phase not in _PHASES


_DRAWN_AS = {"likert": "statements"}
"""The paper's form was drawn under this name before forms were data: sessions stay the same."""


def items_in_order(form: Form, seed: int, round_: int) -> tuple[Item, ...]:
    """A form's items as one participant sees them in a round."""

    def drawn(groups: Sequence[tuple[Item, ...]]) -> tuple[tuple[Item, ...], ...]:
        return shuffled(groups, _leader, seed, _DRAWN_AS.get(form.id, form.id), round_)

    return form.in_order(drawn)


def _leader(group: tuple[Item, ...]) -> str:
    return "" if isinstance(group[0], HeadingItem) else group[0].id


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


_PHASES: dict[str, Callable[[StudySession, Participant, Step, int], Awaitable[None]]] = {
    "preflight": _preflight,
    "consent": _consent,
    "practice": _practice,
    "memorise": _memorise,
    "label": _label,
    "mission": _mission,
    "preference": _preference,
    "debrief": _debrief,
}


def instructor(
    allocated: Allocated,
    round_: int,
    settings: StudySettings,
    quiz: dict[str, QuizMark],
    yoke: Yoke | None = None,
) -> CoachSpec:
    """Who coaches a round. Only a coach that asks for the round's label quiz is given it, and only
    one that repeats the levels of another mission, `yoke`."""
    leads = settings.pair[allocated.second_leads(round_)]
    return leads.spec(allocated.static_level, settings.preset, quiz, yoke)


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
