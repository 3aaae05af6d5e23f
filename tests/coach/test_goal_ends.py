"""Goals that end otherwise than by a rescue, and the end of all goals."""

from __future__ import annotations

from game.coach.acts import (
    BeliefChanged,
    GoalSet,
    InstructionCompleted,
    InstructionIssued,
    NothingLeft,
    PosteriorEvaluated,
)
from game.coach.instructions.phrasebook_file import english
from game.world.events import Expired, TreatmentStarted
from game.world.reading import parse_building
from game.world.settings import MissionSettings
from tests.coach.scripted import ADAPTIVE, BOX, PACE, STATIC, E, Game, N, S, T, W, only, settle

ALL_SAFE = english().notices["all_safe"]
TOO_LATE = english().notices["too_late"]
NOBODY_IN_TIME = english().notices["nobody_in_time"]


def test_when_all_are_rescued_the_bar_says_so_and_the_coach_rests() -> None:
    for spec in (STATIC[0], *ADAPTIVE, PACE):
        game = Game(spec)
        settle(game, E, N, N)
        settle(game, W)
        happened = settle(game, E, S, S, *[E] * 5, N, N, *[E] * 3)
        assert game.mission.rescued == 3
        assert [record.notice for record in only(NothingLeft, happened)] == [ALL_SAFE]
        guidance = game.coach.guidance
        assert (guidance.text, guidance.notice) == ("", ALL_SAFE)
        later = game.act(W, E, N, T) + game.wait(60_000)
        assert not only(PosteriorEvaluated, later)
        assert not only(InstructionIssued, later)
        assert game.coach.guidance == guidance


def test_a_red_goal_that_cannot_be_treated_in_time_is_given_up_at_once() -> None:
    game = Game(STATIC[1], settings=MissionSettings(red_expiry_ms=12_000))
    assert only(GoalSet, game.records)[0].goal == "v03"
    game.wait(7_000)
    goals = only(GoalSet, game.act(W))
    assert [record.reason for record in goals] == ["too_late"]
    assert goals[0].goal != "v03"
    assert game.coach.guidance.notice == TOO_LATE
    expired = game.wait(8_000)
    assert only(Expired, expired)
    assert not only(GoalSet, expired)


def test_a_goal_that_expires_is_followed_by_another() -> None:
    game = Game(STATIC[1], settings=MissionSettings(red_expiry_ms=12_000))
    happened = game.wait(12_000)
    assert [record.reason for record in only(GoalSet, happened)] == ["expired"]
    assert game.coach.guidance.notice == TOO_LATE


def test_a_goal_that_expires_during_another_treatment_gives_way_to_it() -> None:
    game = Game(STATIC[0], settings=MissionSettings(red_expiry_ms=12_000, treat_blue_ms=20_000))
    assert only(GoalSet, game.records)[0].goal == "v03"
    game.act(E, N, N, T)
    happened = game.wait(12_000)
    treated = only(TreatmentStarted, game.records)[0].victim
    assert [(g.goal, g.reason) for g in only(GoalSet, happened)] == [(treated, "expired")]
    assert isinstance(happened[-1], InstructionCompleted)
    assert only(GoalSet, game.wait(10_000))[0].reason == "rescued"
    game.act(T)
    game.wait(21_000)
    assert game.mission.rescued == 2
    assert game.coach.guidance.notice == NOBODY_IN_TIME


def test_when_nobody_can_be_reached_the_bar_says_so() -> None:
    alone = parse_building(BOX.text.replace(".o.o.", ".....").replace("o = blue victim\n", ""))
    game = Game(STATIC[1], alone, MissionSettings(red_expiry_ms=5_000))
    assert game.coach.guidance.notice == NOBODY_IN_TIME
    assert [type(record) for record in game.records] == [BeliefChanged, NothingLeft]
    game.wait(6_000)
    assert game.coach.guidance.notice == NOBODY_IN_TIME


def test_a_blue_victim_is_led_to_even_when_time_is_short() -> None:
    game = Game(STATIC[1], settings=MissionSettings(duration_ms=2_000, red_expiry_ms=1_000))
    assert only(GoalSet, game.records)[0].goal in ("v01", "v02")
