"""What stands on the bar while the rescuer follows it."""

from __future__ import annotations

from game.coach.acts import (
    BeliefChanged,
    GoalSet,
    InstructionCompleted,
    InstructionIssued,
    Level,
    Misstep,
)
from game.world.events import Rescued
from tests.coach.scripted import GALLERY, PRACTICE, STATIC, E, Game, N, S, T, only, settle


def test_the_first_instruction_is_there_before_anything_happens() -> None:
    game = Game(STATIC[0])
    assert [type(record) for record in game.records] == [BeliefChanged, GoalSet, InstructionIssued]
    issued = game.records[-1]
    assert isinstance(issued, InstructionIssued)
    assert game.coach.guidance.text == issued.text
    assert (issued.number, issued.reason, issued.notice) == (1, "goal", "")


def test_at_each_level_the_bar_speaks_of_the_same_goal_in_other_words() -> None:
    games = [Game(spec, PRACTICE) for spec in STATIC]
    assert len({game.coach.guidance.text for game in games}) == len(Level)
    assert len({only(GoalSet, game.records)[0].goal for game in games}) == 1


def test_while_the_rescuer_is_on_the_way_the_text_stays() -> None:
    game = Game(STATIC[0])
    text = game.coach.guidance.text
    assert not only(InstructionIssued, game.act(E, N, N))
    assert game.coach.guidance.text == text


def test_the_text_stays_through_the_treatment_and_then_the_next_goal_is_there_at_once() -> None:
    game = Game(STATIC[0])
    text = game.coach.guidance.text
    started = game.act(E, N, N, T)
    assert [record.number for record in only(InstructionCompleted, started)] == [1]
    assert game.coach.guidance.text == text
    after = game.wait(3_000)
    rescued = only(Rescued, after)[0]
    goal, issued = only(GoalSet, after)[0], only(InstructionIssued, after)[0]
    assert rescued.at_ms == goal.at_ms == issued.at_ms
    assert (goal.reason, issued.reason) == ("rescued", "goal")
    assert game.coach.guidance.text == issued.text


def test_a_treatment_broken_off_brings_the_instruction_back_from_there() -> None:
    game = Game(STATIC[0])
    game.act(E, N, N, T)
    resumed = only(InstructionIssued, game.act(E))
    assert [record.reason for record in resumed] == ["resumed"]
    assert resumed[0].position == game.mission.position
    settle(game)
    assert game.mission.rescued == 1


def test_a_bump_that_turns_the_rescuer_gets_words_for_the_new_heading() -> None:
    game = Game(STATIC[0])
    issued = only(InstructionIssued, game.act(S))
    assert [record.reason for record in issued] == ["off_path"]
    assert issued[0].text.startswith("Turn left. Walk forward 1 step.")
    assert not only(Misstep, game.records)


def test_words_at_c2_are_for_a_heading_until_the_victim_is_found() -> None:
    game = Game(STATIC[1], GALLERY)
    first = only(InstructionIssued, game.records)[0]
    assert (first.shown_level, first.treats) == (Level.C2, True)
    assert [record.reason for record in only(InstructionIssued, game.act(N))] == ["off_path"]
    game.act(*[E] * 19)
    assert not only(InstructionIssued, game.act(N, S))


def test_at_c3_the_room_is_named_again_to_whoever_has_left_it() -> None:
    game = Game(STATIC[2])
    settle(game, E, N, N)
    assert game.coach.guidance.text == "Triage the blue victim."
    issued = only(InstructionIssued, game.act(S, S))
    assert [record.reason for record in issued] == ["off_path"]
    assert game.coach.guidance.text == "Go to the Archive. Triage the blue victim."


def test_the_next_words_know_who_is_rescued() -> None:
    game = Game(STATIC[0])
    settle(game, E, N, N)
    assert game.coach.guidance.text == "Stop. Utilize medical equipment."
    settle(game)
    assert game.mission.rescued == 2
