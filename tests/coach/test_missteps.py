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
from game.coach.compliance import HEEDED_CELLS
from game.coach.guide import ANOTHER_FIRST
from game.coach.instructions.notices import WRONG_WAY
from game.coach.route import Route, RoutePlanner
from game.rescuers.literal import LiteralReader
from game.world.events import TreatmentStarted
from game.world.settings import MissionSettings
from tests.coach.scripted import GALLERY, PRACTICE, STATIC, E, Game, N, S, T, W, away, only, settle


def test_a_misstep_is_corrected_from_where_the_rescuer_stands() -> None:
    game = Game(STATIC[0])
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
    game = Game(STATIC[2], GALLERY)
    happened = game.act(*[E] * 9, *[W] * 8)
    assert only(Misstep, happened)[0].excess == 8
    assert [record.notice for record in only(InstructionIssued, happened)] == [WRONG_WAY]


def test_whoever_strays_to_another_victim_is_led_there() -> None:
    game = Game(STATIC[2])
    assert only(GoalSet, game.records)[0].goal == "v02"
    happened = game.act(*[E] * 6, N, N, *[E] * 2)
    assert only(Misstep, happened)
    assert [(record.goal, record.reason) for record in only(GoalSet, happened)] == [
        ("v03", "strayed")
    ]
    issued = only(InstructionIssued, happened)[-1]
    assert (issued.goal, issued.notice) == ("v03", ANOTHER_FIRST)


def test_a_step_or_two_astray_do_not_change_the_route(monkeypatch: pytest.MonkeyPatch) -> None:
    planned: list[object] = []
    plan = RoutePlanner.plan

    def counted(self: RoutePlanner, *given: Any, **options: Any) -> Route:
        planned.append(given)
        return plan(self, *given, **options)

    game = Game(STATIC[0], GALLERY)
    monkeypatch.setattr(RoutePlanner, "plan", counted)
    assert len(only(Misstep, game.act(*[E] * 9, W, W))) == 2
    assert not planned
    assert only(Misstep, game.act(W))
    assert len(planned) == 1


def test_a_correction_leaves_the_bar_once_it_is_heeded() -> None:
    game = Game(STATIC[2])
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
    game.act(W)
    game.wait(5_000)
    assert [record.kind for record in only(Disobeyed, game.act(E, E, E))] == ["repeat_misstep"]


def test_an_instruction_completed_between_two_missteps_forgives_the_first() -> None:
    game, reader = Game(STATIC[0], PRACTICE), LiteralReader("compass")
    game.act(away(game))
    game.wait(5_000)
    while not only(InstructionCompleted, game.records):
        action = reader.decide(game.run.observation())
        assert action is not None
        game.act(action)
    game.wait(7_000)
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
