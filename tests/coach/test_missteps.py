"""Missteps, corrections and disobedience."""

from __future__ import annotations

from typing import Any

import pytest

from game.coach.acts import (
    Disobeyed,
    GoalSet,
    InstructionCompleted,
    InstructionIssued,
    Level,
    Misstep,
)
from game.coach.compliance import HEEDED_CELLS, NOTICE_MS, NOTICE_MS_PER_LETTER
from game.coach.instructions.phrasebook_file import english
from game.coach.lead import GOAL_MS
from game.rescuers.literal import LiteralReader
from game.world.events import TreatmentStarted
from game.world.route import Route, RoutePlanner
from game.world.settings import FREE_PLAY, MissionSettings
from tests.coach.scripted import (
    GALLERY,
    KNOWLEDGE,
    LONG,
    PRACTICE,
    STATIC,
    E,
    Game,
    N,
    S,
    T,
    W,
    away,
    only,
    settle,
)

WRONG_WAY = english().notices["wrong_way"]
ANOTHER_FIRST = english().notices["another_first"]

TO_READ_MS = 7_000
"""Long enough to read anything on the bar, and not so long as to be lost."""


def test_a_misstep_is_corrected_from_where_the_rescuer_stands() -> None:
    game = Game(STATIC[0])
    game.wait(TO_READ_MS)
    happened = game.act(W)
    misstep, issued = only(Misstep, happened)[0], only(InstructionIssued, happened)[0]
    assert (misstep.number, misstep.excess, misstep.level) == (1, 1, Level.C1)
    assert (issued.number, issued.reason, issued.notice) == (2, "misstep", WRONG_WAY)
    assert game.coach.guidance.notice == WRONG_WAY
    assert issued.text.startswith("Turn around. Walk forward 2 steps.")
    assert not only(Disobeyed, happened)


def test_a_few_steps_astray_at_c2_are_left_alone() -> None:
    game = Game(STATIC[1], PRACTICE)
    assert not only(InstructionIssued, game.act(away(game)))


def test_a_misstep_always_has_a_correction() -> None:
    game = Game(STATIC[2], LONG)
    game.wait(TO_READ_MS)
    happened = game.act(*[E] * 8)
    assert only(Misstep, happened)[0].excess == 8
    assert [record.notice for record in only(InstructionIssued, happened)] == [WRONG_WAY]


def test_to_look_round_in_the_room_that_was_named_is_no_misstep() -> None:
    assert not only(Misstep, Game(STATIC[2], GALLERY).act(*[E] * 9, *[W] * 9))


def test_whoever_strays_to_another_victim_is_led_there() -> None:
    game = Game(STATIC[2], LONG)
    assert only(GoalSet, game.records)[0].goal == "v01"
    game.wait(GOAL_MS // 2)
    game.act(W)
    game.wait(GOAL_MS // 2)
    happened = game.act(*[E] * 10)
    assert only(Misstep, happened)
    assert [(record.goal, record.reason) for record in only(GoalSet, happened)] == [
        ("v02", "strayed")
    ]
    issued = only(InstructionIssued, happened)[-1]
    assert (issued.goal, issued.notice) == ("v02", ANOTHER_FIRST)


def test_a_goal_is_not_changed_soon_after_it_was_set() -> None:
    game = Game(STATIC[2], LONG)
    game.wait(TO_READ_MS)
    assert only(Misstep, game.act(*[E] * 10))
    assert [record.reason for record in only(GoalSet, game.records)] == ["start"]


def test_a_goal_that_would_be_given_back_within_seconds_is_kept() -> None:
    game = Game(STATIC[2])
    game.wait(GOAL_MS // 2)
    game.act(E)
    game.wait(GOAL_MS // 2)
    assert only(Misstep, game.act(*[E] * 5, N, N, *[E] * 2))
    assert [record.reason for record in only(GoalSet, game.records)] == ["start"]


def test_a_step_or_two_astray_do_not_change_the_route(monkeypatch: pytest.MonkeyPatch) -> None:
    planned: list[object] = []
    plan = RoutePlanner.plan

    def counted(self: RoutePlanner, *given: Any, **options: Any) -> Route:
        planned.append(given)
        return plan(self, *given, **options)

    game = Game(STATIC[0], GALLERY)
    monkeypatch.setattr(RoutePlanner, "plan", counted)
    game.act(*[E] * 9)
    for _ in range(2):
        game.wait(TO_READ_MS)
        assert only(Misstep, game.act(W))
    assert not planned
    game.wait(TO_READ_MS)
    assert only(Misstep, game.act(W))
    assert len(planned) == 1


def test_a_correction_leaves_the_bar_once_it_is_heeded() -> None:
    game = Game(STATIC[2])
    game.wait(TO_READ_MS)
    game.act(*[E] * 12, *[W] * 12)
    game.wait(1)
    assert only(Misstep, game.records)
    assert game.coach.guidance.notice == ""


def test_with_the_correction_go_the_words_that_turned_the_rescuer_back() -> None:
    game = Game(STATIC[0], GALLERY)
    game.act(*[E] * 9, W)
    assert game.coach.guidance.notice == WRONG_WAY
    assert game.coach.guidance.text.startswith("Turn around. Walk forward ")
    happened = game.act(*[E] * HEEDED_CELLS)
    assert [record.reason for record in only(InstructionIssued, happened)] == ["heeded"]
    assert game.coach.guidance.notice == ""
    assert game.coach.guidance.text.startswith("Walk forward ")


def test_a_misstep_again_long_after_the_correction_is_disobedience() -> None:
    game = Game(STATIC[0])
    game.wait(TO_READ_MS)
    game.act(W)
    game.wait(TO_READ_MS)
    assert [record.kind for record in only(Disobeyed, game.act(E, E, E))] == ["repeat_misstep"]


def test_an_instruction_completed_between_two_missteps_forgives_the_first() -> None:
    game, reader = Game(STATIC[0], PRACTICE), LiteralReader("compass")
    game.wait(TO_READ_MS)
    game.act(away(game))
    game.wait(TO_READ_MS)
    while not only(InstructionCompleted, game.records):
        action = reader.decide(game.run.observation())
        assert action is not None
        game.act(action)
    game.wait(TO_READ_MS)
    game.act(away(game))
    assert len(only(Misstep, game.records)) == 2
    assert not only(Disobeyed, game.records)


def test_a_victim_treated_instead_counts_once() -> None:
    game = Game(STATIC[0], settings=MissionSettings(red_expiry_ms=12_000))
    happened = game.act(E, N, N, T, S, N, T)
    assert len(only(TreatmentStarted, happened)) == 2
    assert [r.kind for r in only(Disobeyed, happened)].count("other_victim") == 1


def test_treating_another_victim_is_disobedience_and_the_route_is_planned_anew() -> None:
    game = Game(STATIC[0], settings=MissionSettings(red_expiry_ms=12_000))
    goal = only(GoalSet, game.records)[0].goal
    assert goal == "v03"
    happened = settle(game, E, N, N)
    assert [record.kind for record in only(Disobeyed, happened)] == ["other_victim"]
    assert only(TreatmentStarted, happened)[0].victim != goal
    assert only(GoalSet, happened)[-1].reason == "other_rescued"


def test_a_victim_that_fits_the_words_as_well_is_adopted() -> None:
    game = Game(STATIC[2])
    goal = only(GoalSet, game.records)[0].goal
    happened = settle(game, E, N, N, *[W] * 2 if goal == "v02" else [E] * 2)
    treated = only(TreatmentStarted, happened)[0].victim
    assert treated != goal
    assert not only(Disobeyed, happened)
    assert len(only(InstructionCompleted, happened)) == 1
    assert only(GoalSet, happened)[0].reason == "rescued"


def test_a_notice_outlives_a_change_of_level_until_it_can_be_read() -> None:
    game = Game(KNOWLEDGE[0], PRACTICE, FREE_PLAY)
    for _ in range(2):
        game.run.ask_level("shorter", game.now_ms)
    game.wait(TO_READ_MS)
    while not only(Misstep, game.records):
        game.act(away(game))
    notice = game.coach.guidance.notice
    assert notice
    for _ in range(4):
        game.run.ask_level("simpler", game.now_ms)
    told = only(InstructionIssued, game.records)[-1]
    assert (told.reason, told.notice) == ("level", notice)
    game.wait(NOTICE_MS + NOTICE_MS_PER_LETTER * len(notice))
    for _ in range(4):
        game.run.ask_level("shorter", game.now_ms)
    told = only(InstructionIssued, game.records)[-1]
    assert (told.reason, told.notice) == ("level", "")
