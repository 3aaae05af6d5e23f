"""The rules of a mission."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from game.world.events import (
    Acted,
    Action,
    Expired,
    MissionEnded,
    MissionEvent,
    Outcome,
    Rescued,
    TreatmentBroken,
    TreatmentStarted,
)
from game.world.geometry import Heading
from game.world.mission import COMPASS_ACTIONS, Mission
from game.world.observation import VictimState
from game.world.reading import parse_building
from game.world.settings import MissionSettings

WARD = parse_building(
    """name: Ward

plan:
#############
#A...*.#....#
#.o....+..^.#
#....*o#....#
#############

legend:
A = room Ward Room
^ = start facing north
* = red victim
o = blue victim
"""
)
RED_NORTH, RED_SOUTH, BLUE_SOUTH = "v01", "v03", "v04"
MOVES = list(COMPASS_ACTIONS)


def mission(**settings: object) -> Mission:
    return Mission(WARD, MissionSettings(**settings))  # type: ignore[arg-type]


def walk(play: Mission, actions: str, start_ms: int = 0, pace_ms: int = 200) -> int:
    """Make the moves named by their initials; the time of the last one."""
    keys = {action.value[0]: action for action in Action}
    for number, key in enumerate(actions):
        play.step(keys[key], start_ms + number * pace_ms)
    return start_ms + (len(actions) - 1) * pace_ms


def outcome(events: list[MissionEvent]) -> Outcome:
    return next(event.outcome for event in events if isinstance(event, Acted))


def test_a_move_changes_position_and_heading_and_a_bump_only_the_heading() -> None:
    play = mission()
    assert outcome(play.step(Action.WEST, 0)) is Outcome.MOVED
    assert (play.position, play.heading) == ((9, 2), Heading.WEST)
    walk(play, "n", 200)
    assert outcome(play.step(Action.NORTH, 400)) is Outcome.BUMPED
    assert (play.position, play.heading) == ((9, 1), Heading.NORTH)


def test_turn_controls_turn_on_the_spot_and_go_forward() -> None:
    play = mission(controls="turn")
    assert outcome(play.step(Action.TURN_LEFT, 0)) is Outcome.TURNED
    assert (play.position, play.heading) == (WARD.start, Heading.WEST)
    assert outcome(play.step(Action.FORWARD, 200)) is Outcome.MOVED
    assert play.position == (9, 2)
    play.step(Action.TURN_RIGHT, 400)
    assert play.heading is Heading.NORTH


@pytest.mark.parametrize(("controls", "action"), [("compass", "forward"), ("turn", "north")])
def test_the_other_controls_are_refused(controls: str, action: str) -> None:
    with pytest.raises(ValueError, match=controls):
        mission(controls=controls).step(Action(action), 0)


def test_a_treatment_takes_its_time_and_rescues() -> None:
    play = mission()
    at = walk(play, "wwww") + 200
    events = play.step(Action.TRIAGE, at)
    assert [type(event) for event in events] == [Acted, TreatmentStarted]
    assert play.step(None, at + 2999) == []
    treatment = play.observation().treatment
    assert treatment is not None and (treatment.done_ms, treatment.total_ms) == (2999, 3000)
    assert play.step(None, at + 3000) == [Rescued(at + 3000, BLUE_SOUTH)]
    assert play.rescued == 1 and play.score == 10


def test_triage_takes_own_cell_then_ahead_then_clockwise() -> None:
    play = mission()
    walk(play, "wwwwww")
    assert play.position == (4, 2)
    play.step(Action.EAST, 2000)
    assert play.position == (5, 2)
    reach = play.victim_in_reach()
    assert reach is not None and reach.id == RED_SOUTH, "nobody ahead: clockwise finds the south"
    play.step(Action.NORTH, 2200)
    reach = play.victim_in_reach()
    assert reach is not None and reach.id == RED_NORTH, "standing on the victim"


def test_a_move_breaks_a_treatment_off_and_a_bump_does_not() -> None:
    play = mission()
    at = walk(play, "wwwwws")
    assert play.position == (5, 3)
    assert outcome(play.step(Action.TRIAGE, at + 100)) is Outcome.TREATING
    assert outcome(play.step(Action.TRIAGE, at + 150)) is Outcome.ALREADY_TREATING
    assert outcome(play.step(Action.SOUTH, at + 200)) is Outcome.BUMPED
    assert play.observation().treatment is not None
    events = play.step(Action.WEST, at + 400)
    assert events[-1] == TreatmentBroken(at + 400, RED_SOUTH)
    assert play.observation().treatment is None
    assert play.victims[RED_SOUTH] is VictimState.WAITING


def test_reds_expire_together_and_a_red_too_late_to_save_is_refused() -> None:
    play = mission()
    at = walk(play, "wwwwww")
    play.step(Action.EAST, at + 200)
    assert outcome(play.step(Action.TRIAGE, 114_001)) is Outcome.TOO_LATE
    events = play.step(None, 120_000)
    assert events == [Expired(120_000, RED_NORTH), Expired(120_000, RED_SOUTH)]


def test_a_treatment_that_ends_as_the_reds_expire_rescues() -> None:
    play = mission()
    walk(play, "wwwww")
    play.step(Action.SOUTH, 113_000)
    assert outcome(play.step(Action.TRIAGE, 114_000)) is Outcome.TREATING
    events = play.step(None, 125_000)
    assert events == [Rescued(120_000, RED_SOUTH), Expired(120_000, RED_NORTH)]


def test_the_mission_ends_on_time_whatever_the_last_tick() -> None:
    play = mission(duration_ms=10_000)
    events = play.step(Action.WEST, 60_000)
    assert events[-1] == MissionEnded(10_000, rescued=0)
    assert {(type(event), event.at_ms) for event in events[:-1]} == {(Expired, 5_000)}
    assert play.time_ms == 10_000 and play.next_due is None
    assert play.step(Action.WEST, 60_001) == []


def test_time_cannot_run_backwards() -> None:
    play = mission()
    play.step(None, 500)
    with pytest.raises(ValueError, match="backwards"):
        play.step(None, 499)


def test_an_observation_shows_what_is_in_view_and_nothing_behind_a_closed_door() -> None:
    play = mission()
    seen = play.observation()
    assert seen.victims == () and seen.rooms == () and seen.remembered == ()
    walk(play, "www")
    inside = play.observation()
    assert {victim.cell for victim in inside.victims} >= {(5, 1), (5, 3)}
    walk(play, "eee", 1000)
    gone = play.observation()
    assert gone.victims == () and len(gone.remembered) == len(inside.victims)
    assert gone.explored & inside.visible == inside.visible


def test_the_score_is_hidden_when_the_settings_say_so() -> None:
    assert mission(show_score=False).observation().score is None
    assert mission().observation().score == 0


@pytest.mark.parametrize(
    ("name", "value"), [("duration_ms", 5), ("moves_per_second", 0), ("controls", "mouse")]
)
def test_a_setting_out_of_range_is_named(name: str, value: object) -> None:
    with pytest.raises(ValueError, match=name):
        MissionSettings(**{name: value})  # type: ignore[arg-type]


timed_actions = st.lists(
    st.tuples(st.sampled_from([*MOVES, Action.TRIAGE]), st.integers(0, 4000)), max_size=60
)


@given(timed_actions, st.lists(st.integers(0, 260_000), max_size=20))
def test_extra_ticks_change_nothing(plan: list[tuple[Action, int]], ticks: list[int]) -> None:
    plain, ticked = mission(), mission()
    at, timed = 0, []
    for action, pause in plan:
        at += pause
        timed.append((at, action))
    plain_events = [event for at, action in timed for event in plain.step(action, at)]
    plain_events += plain.step(None, 260_000)
    ticked_events: list[MissionEvent] = []
    nothing: list[tuple[int, int, Action | None]] = [(at, 0, None) for at in ticks]
    both = sorted([(at, 1, action) for at, action in timed] + nothing, key=lambda item: item[:2])
    for at, _, due in both:
        ticked_events += ticked.step(due, at)
    ticked_events += ticked.step(None, 260_000)
    assert ticked_events == plain_events
    assert ticked.observation() == plain.observation()


@given(timed_actions)
def test_every_victim_ends_in_one_state_and_the_count_agrees(
    plan: list[tuple[Action, int]],
) -> None:
    play, at = mission(), 0
    events: list[MissionEvent] = []
    for action, pause in plan:
        at += pause
        events += play.step(action, at)
    rescued = [event.victim for event in events if isinstance(event, Rescued)]
    expired = [event.victim for event in events if isinstance(event, Expired)]
    assert len(set(rescued + expired)) == len(rescued) + len(expired)
    assert play.rescued == len(rescued)
    assert WARD.plan.walkable(play.position)
