"""What tells the coaches apart."""

from __future__ import annotations

import pytest

from game.coach.acts import (
    GoalSet,
    InstructionCompleted,
    InstructionIssued,
    Level,
    LevelChanged,
    LostNoticed,
    Misstep,
    PaceLearned,
    PosteriorEvaluated,
)
from game.coach.compliance import LOST_MS
from game.coach.kinds.pace import PaceCoach
from game.coach.spec import CoachSpec
from game.rescuers.driver import drive
from game.rescuers.literal import LiteralReader
from game.world import load_building
from game.world.events import Rescued
from game.world.settings import MissionSettings
from tests.coach.scripted import (
    ADAPTIVE,
    EVERY,
    PACE,
    PRACTICE,
    STATIC,
    E,
    Game,
    N,
    S,
    W,
    away,
    nearer,
    only,
    settle,
)


def test_the_static_coach_keeps_its_level_and_evaluates_nothing() -> None:
    for spec in STATIC:
        game = Game(spec)
        game.act(*[W, E] * 20)
        assert {record.level for record in only(InstructionIssued, game.records)} == {spec.level}
        assert not only(LevelChanged, game.records)
        assert not only(PosteriorEvaluated, game.records)


def test_ana_lowers_the_level_of_someone_who_walks_away_and_says_it_anew_at_once() -> None:
    game = Game(ADAPTIVE[1], PRACTICE)
    happened = [record for _ in range(40) for record in game.act(away(game))]
    changed = only(LevelChanged, happened)
    assert (changed[0].before, changed[0].after) == (Level.C2, Level.C1)
    position = happened.index(changed[0])
    issued = happened[position + 1]
    assert isinstance(issued, InstructionIssued)
    assert (issued.level, issued.reason) == (Level.C1, "level")
    evaluation = happened[position - 1]
    assert isinstance(evaluation, PosteriorEvaluated)
    assert evaluation.verdict == "lower"
    assert evaluation.comprehension == changed[0].comprehension
    assert evaluation.comprehension < evaluation.lower_below


def test_a_level_rises_with_a_rescue_and_not_with_a_goal_that_is_lost() -> None:
    game, reader = Game(ADAPTIVE[0], PRACTICE), LiteralReader("compass")
    while not only(Rescued, game.records):
        action = reader.decide(game.run.observation())
        game.wait(500) if action is None else game.act(action)
    rescued = only(Rescued, game.records)[0]
    changed = only(LevelChanged, game.records)
    assert [(record.at_ms, record.after) for record in changed] == [(rescued.at_ms, Level.C3)]

    lost = Game(ADAPTIVE[1], PRACTICE, MissionSettings(red_expiry_ms=20_000))
    for _ in range(12):
        lost.act(nearer(lost))
    happened = lost.wait(20_000)
    assert "raise" in {record.verdict for record in only(PosteriorEvaluated, happened)}
    assert [record.reason for record in only(GoalSet, happened)] == ["expired"]
    assert not only(LevelChanged, happened)


def test_ana_lowers_the_level_of_someone_who_is_lost_and_says_the_way_again() -> None:
    game = Game(ADAPTIVE[0], PRACTICE)
    happened = game.wait(LOST_MS)
    (lost,), (changed,) = only(LostNoticed, happened), only(LevelChanged, happened)
    assert (lost.at_ms, lost.by) == (LOST_MS, "standing")
    assert (changed.before, changed.after, changed.comprehension) == (Level.C2, Level.C1, None)
    issued = only(InstructionIssued, happened)[-1]
    assert (issued.level, issued.reason) == (Level.C1, "lost")
    assert issued.notice


@pytest.mark.parametrize("spec", EVERY, ids=lambda spec: f"{spec.kind}-{spec.preset or spec.level}")
def test_whoever_stands_paces_or_circles_hears_something_within_twelve_seconds(
    spec: CoachSpec,
) -> None:
    square = [E, E, E, N, N, W, W, W, S, S]
    for keys in ([], [E, W], square):
        game = Game(spec, PRACTICE)
        silent_ms, said_ms = 0, 0
        for step in range(200):
            before = len(game.records)
            game.act(keys[step % len(keys)]) if keys else game.wait(200)
            new = only(InstructionIssued, game.records[before:])
            said_ms = new[-1].at_ms if new else said_ms
            silent_ms = max(silent_ms, game.now_ms - said_ms)
        assert silent_ms < 12_000


def test_each_preset_evaluates_on_its_own_occasions() -> None:
    when = {}
    for spec in ADAPTIVE:
        game = Game(spec, PRACTICE)
        drive(game.run, LiteralReader("compass", {r.name: r.label for r in PRACTICE.rooms}))
        when[spec.preset] = only(PosteriorEvaluated, game.records)
        if spec.preset == "literal":
            ended = [
                record.at_ms
                for record in game.records
                if isinstance(record, InstructionCompleted | Misstep)
            ]
            assert [record.at_ms for record in when["literal"]] == ended
    assert {record.at_ms % 3_000 for record in when["calibrated"]} == {0}
    assert {record.at_ms % 5_000 for record in when["fig10"]} == {0}
    assert len(when["released"]) > 100


def test_released_begins_every_leg_after_a_rescue_at_c2() -> None:
    game = Game(ADAPTIVE[4], PRACTICE)
    drive(game.run, LiteralReader("compass", {r.name: r.label for r in PRACTICE.rooms}))
    goals = [r.at_ms for r in only(GoalSet, game.records) if r.reason == "rescued"]
    firsts = [r for r in only(InstructionIssued, game.records) if r.reason == "goal"]
    assert len(goals) > 3
    assert {r.level for r in firsts if r.at_ms in goals} == {Level.C2}


def test_the_pace_coach_learns_how_fast_the_rescuer_walks_and_plans_by_it() -> None:
    game = Game(PACE)
    coach = game.coach
    assert isinstance(coach, PaceCoach)
    assert coach.ms_per_move == game.settings.pace_ms
    for action in [E, W] * 15:
        game.act(action)
        game.wait(800)
    settle(game, E, N, N)
    learned = only(PaceLearned, game.records)
    assert [record.ms_per_move for record in learned] == [1_000.0]
    assert coach.ms_per_move == 1_000


def test_a_slow_rescuer_is_led_another_way_by_the_pace_coach() -> None:
    routes = []
    for spec in (PACE, STATIC[1]):
        game, reader = Game(spec, load_building("harbour")), LiteralReader("compass")
        while not game.run.ended:
            action = reader.decide(game.run.observation())
            if action is not None:
                game.act(action)
            game.wait(300)
        routes.append([record.route for record in only(GoalSet, game.records)])
    assert routes[0][0] == routes[1][0]
    assert routes[0] != routes[1]
