from __future__ import annotations

from dataclasses import dataclass, fields, replace
from itertools import pairwise
from math import exp
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from game.coach.acts import Level
from game.coach.belief import Belief
from game.coach.goals import UNIT, log_factor, step_pattern
from game.coach.instructions import Pose, Scene, instruct
from game.coach.model import (
    ActionSet,
    BeliefEstimate,
    Component,
    HumanModel,
    Observations,
    Reward,
)
from game.world import load_building
from game.world.events import Action
from game.world.floodfill import Floodfills
from game.world.geometry import Cell, Heading
from game.world.mission import COMPASS_ACTIONS, Mission
from game.world.settings import MissionSettings

BUILDING = load_building("practice")
PLAN = BUILDING.plan
FLOODFILLS = Floodfills(PLAN)
MODEL = HumanModel.of(BUILDING, MissionSettings())
TURNING = HumanModel.of(BUILDING, MissionSettings(controls="turn"))
SPACE = MODEL.states
FLOOR = list(PLAN.cells(PLAN.walkable_mask))
VICTIMS = list(SPACE.victims)
ROOMS = list(SPACE.places)


@dataclass(frozen=True)
class Words:
    shown_level: Level
    goal: str
    start: Pose
    end: Pose
    path: tuple[Cell, ...]
    treats: bool


def _way(start: Cell, goal: Cell) -> tuple[Cell, ...]:
    field = FLOODFILLS.to(goal)
    path = [start]
    while path[-1] != goal:
        index = PLAN.index(path[-1])
        nearer = [n for n in PLAN.neighbours[index] if field[n] < field[index]]
        path.append(PLAN.cell(nearer[0]))
    return tuple(path)


def _words(level: Level, goal: str, start: Cell, heading: Heading = Heading.NORTH) -> Words:
    path = _way(start, SPACE.victims[goal])
    return Words(level, goal, Pose(start, heading), Pose(path[-1], heading), path, treats=True)


beliefs = st.builds(
    lambda position, heading, hidden, rooms, victims: Belief(
        SPACE,
        position,
        heading,
        SPACE.floor & ~PLAN.mask(hidden),
        frozenset(rooms),
        frozenset(victims),
    ),
    st.sampled_from(FLOOR),
    st.sampled_from(Heading),
    st.sets(st.sampled_from(FLOOR), max_size=20),
    st.sets(st.sampled_from(ROOMS)),
    st.sets(st.sampled_from(VICTIMS)),
)
models = st.sampled_from([MODEL, TURNING])
goals = st.sampled_from(VICTIMS)


@given(models, st.sampled_from(Level), goals, beliefs)
def test_a_policy_is_a_distribution_over_the_actions(
    model: HumanModel, level: Level, goal: str, belief: Belief
) -> None:
    policy = model.policy(_words(level, goal, belief.position), belief)
    assert tuple(policy) == model.actions.actions
    assert all(share >= 0 for share in policy.values())
    assert sum(policy.values()) == pytest.approx(1, abs=1e-12)


@given(models, goals, st.sampled_from(FLOOR), st.sampled_from(Heading), beliefs, beliefs)
def test_at_c1_the_policy_is_the_same_for_any_belief(
    model: HumanModel, goal: str, start: Cell, heading: Heading, one: Belief, other: Belief
) -> None:
    words = _words(Level.C1, goal, start, heading)
    policy = model.policy(words, one)
    assert policy == model.policy(words, other)
    assert max(policy.values()) == 1


@given(models, goals, st.sampled_from(FLOOR), beliefs, beliefs)
def test_at_c2_only_what_is_in_view_matters(
    model: HumanModel, goal: str, start: Cell, one: Belief, other: Belief
) -> None:
    words = _words(Level.C2, goal, start)
    there = replace(other, position=one.position, heading=one.heading)
    assert model.policy(words, one) == model.policy(words, there)


def _belief(position: Cell, rooms: set[str] = frozenset(), victims: Any = ()) -> Belief:  # type: ignore[assignment]
    return Belief(SPACE, position, Heading.NORTH, SPACE.floor, frozenset(rooms), frozenset(victims))


def test_at_c2_the_way_is_followed_only_where_it_is_in_view() -> None:
    clinic = next(v for v, room in SPACE.rooms.items() if room == "Clinic")
    words = _words(Level.C2, clinic, (1, 10))
    assert words.path[:2] == ((1, 10), (1, 9))
    on_the_way = MODEL.policy(words, _belief((4, 9)))
    assert on_the_way[Action.EAST] > 5 * on_the_way[Action.SOUTH] > 0
    beside_it = MODEL.policy(words, _belief((4, 10)))
    assert beside_it[Action.EAST] > 5 * beside_it[Action.WEST] > 0
    in_the_pantry = MODEL.policy(words, _belief((13, 16)))
    assert in_the_pantry[Action.NORTH] == in_the_pantry[Action.SOUTH] == 0.25
    at_the_end = MODEL.policy(words, _belief(words.end.cell))
    assert at_the_end[Action.TRIAGE] == 1


def test_at_c3_a_known_room_draws_and_an_unknown_one_leaves_exploring() -> None:
    clinic = next(v for v, room in SPACE.rooms.items() if room == "Clinic")
    words = _words(Level.C3, clinic, (15, 10))
    known = MODEL.policy(words, _belief((15, 10), {"Clinic"}))
    unknown = MODEL.policy(words, _belief((15, 10)))
    assert known[Action.EAST] > unknown[Action.EAST] > 0
    assert unknown[Action.WEST] > 2 * known[Action.WEST]
    last_by_elimination = MODEL.policy(words, _belief((15, 10), set(ROOMS) - {"Clinic"}))
    assert last_by_elimination == known
    spread = [
        MODEL.policy(words, replace(_belief((15, 10)), rooms=frozenset(ROOMS) - {"Clinic", other}))
        for other in ROOMS
        if other != "Clinic"
    ]
    assert unknown[Action.EAST] == pytest.approx(
        (known[Action.EAST] + sum(2 * p[Action.EAST] - known[Action.EAST] for p in spread))
        / len(ROOMS)
    )


def test_at_c3_a_victim_in_view_is_treated_when_reached() -> None:
    clinic = next(v for v, room in SPACE.rooms.items() if room == "Clinic")
    x, y = SPACE.victims[clinic]
    words = _words(Level.C3, clinic, (x, y + 1))
    assert MODEL.policy(words, _belief((x, y + 1), victims=[clinic]))[Action.TRIAGE] == 1
    assert MODEL.policy(words, _belief((x, y + 1)))[Action.TRIAGE] == 0


@given(goals, st.sampled_from(FLOOR), st.sampled_from([0.3, 1.0, 2.0]))
def test_the_policy_for_a_known_place_is_the_likelihood_of_the_goal_inference(
    goal: str, start: Cell, beta: float
) -> None:
    cell = SPACE.victims[goal]
    if abs(cell[0] - start[0]) + abs(cell[1] - start[1]) <= 1:
        return
    model = MODEL.with_learned({Component.REWARD: Reward(beta)})
    policy = model.policy(_words(Level.C3, goal, start), _belief(start, victims=[goal]))
    field, here = FLOODFILLS.to(cell), PLAN.index(start)
    for action, heading in COMPASS_ACTIONS.items():
        end = heading.from_cell(start)
        if PLAN.walkable(end):
            pattern = step_pattern(PLAN, field, here, PLAN.index(end))
            expected = exp(UNIT * log_factor(pattern, "boltzmann", beta))
            assert policy[action] == pytest.approx(expected, abs=1e-12)
        else:
            assert policy[action] == 0


def test_turn_controls_turn_towards_the_way() -> None:
    path = ((15, 10), (16, 10))
    expected = {
        Heading.NORTH: Action.TURN_RIGHT,
        Heading.EAST: Action.FORWARD,
        Heading.SOUTH: Action.TURN_LEFT,
        Heading.WEST: Action.TURN_RIGHT,
    }
    for heading, action in expected.items():
        start = Pose(path[0], heading)
        words = Words(Level.C1, VICTIMS[0], start, Pose(path[1], Heading.EAST), path, False)
        assert TURNING.policy(words, _belief(path[0]))[action] == 1


def test_at_c1_a_turn_alone_and_a_treatment_are_carried_out() -> None:
    here = ((15, 10),)
    north, east = Pose(here[0], Heading.NORTH), Pose(here[0], Heading.EAST)
    turn = Words(Level.C1, VICTIMS[0], north, east, here, treats=False)
    assert TURNING.policy(turn, _belief((1, 10)))[Action.TURN_RIGHT] == 1
    assert MODEL.policy(turn, _belief((1, 10)))[Action.EAST] == 1
    treat = Words(Level.C1, VICTIMS[0], north, north, here, treats=True)
    assert MODEL.policy(treat, _belief((1, 10)))[Action.TRIAGE] == 1


NEW_VALUES: dict[Component, Any] = {
    Component.STATES: replace(SPACE, floor=1),
    Component.ACTIONS: ActionSet((Action.NORTH,), 500.0),
    Component.TRANSITION: replace(MODEL.transition),
    Component.REWARD: Reward(2.0),
    Component.OBSERVATIONS: Observations(room_names=False),
    Component.OBSERVATION_FUNCTION: HumanModel.of(
        BUILDING, MissionSettings(sight_radius=2)
    ).observation_function,
    Component.BELIEF: BeliefEstimate(_belief((1, 10))),
}


@given(st.sets(st.sampled_from(Component)))
def test_learning_replaces_what_alpha_names_and_nothing_else(alpha: set[Component]) -> None:
    learned = MODEL.with_learned({component: NEW_VALUES[component] for component in alpha})
    for component in Component:
        source = NEW_VALUES[component] if component in alpha else getattr(MODEL, component.value)
        assert getattr(learned, component.value) is source
    assert learned.floodfills is MODEL.floodfills


def test_every_component_is_a_field_and_keeps_its_type() -> None:
    names = {field.name for field in fields(HumanModel)}
    assert names == {component.value for component in Component} | {"floodfills"}
    with pytest.raises(TypeError, match="component reward must be a Reward"):
        MODEL.with_learned({Component.REWARD: 1.0})


def test_the_belief_follows_the_mission() -> None:
    mission = Mission(BUILDING, MissionSettings())
    model = MODEL.seeing(mission.observation())
    first = model.belief.state
    assert first.unseen == SPACE.floor & ~mission.observation().visible
    for a, b in pairwise(_way(BUILDING.start, SPACE.victims[VICTIMS[-1]])):
        way = next(action for action, h in COMPASS_ACTIONS.items() if h.from_cell(a) == b)
        for event in mission.step(way, mission.time_ms + 200):
            model = model.after(event, mission.observation())
    state = model.belief.state
    assert state.position == SPACE.victims[VICTIMS[-1]]
    assert VICTIMS[-1] in state.victims
    assert state.unseen == SPACE.floor & ~mission.observation().explored


@pytest.mark.parametrize("model", [MODEL, TURNING])
@pytest.mark.parametrize("level", [Level.C1, Level.C2])
def test_whoever_acts_by_the_policy_carries_real_instructions_out(
    model: HumanModel, level: Level
) -> None:
    settings = MissionSettings(controls="turn" if model is TURNING else "compass")
    scene = Scene(BUILDING, {v.id: v for v in BUILDING.victims}, settings)
    for goal in (VICTIMS[0], VICTIMS[-1]):
        mission = Mission(BUILDING, settings)
        model = model.seeing(mission.observation())
        for _ in range(150):
            instruction = instruct(scene, Pose(mission.position, mission.heading), goal, level)
            policy = model.policy(instruction, model.belief.state)
            likeliest = max(policy, key=policy.__getitem__)
            for event in mission.step(likeliest, mission.time_ms + 200):
                model = model.after(event, mission.observation())
            if likeliest is Action.TRIAGE:
                break
        treatment = mission.observation().treatment
        assert treatment is not None
        assert treatment.cell == SPACE.victims[goal]


def test_what_is_not_taken_in_teaches_and_rules_out_nothing() -> None:
    observation = Mission(BUILDING, MissionSettings()).observation()
    taught = MODEL.seeing(observation).belief.state
    blind = Observations(room_names=False, victims=False)
    state = MODEL.with_learned({Component.OBSERVATIONS: blind}).seeing(observation).belief.state
    assert taught.unseen != SPACE.floor
    assert state == MODEL.belief.state
