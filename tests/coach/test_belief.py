from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import permutations, product
from random import Random

import pytest
from hypothesis import given
from hypothesis import strategies as st

from game.coach.belief import Belief, StateSpace, Transition, belief_change
from game.world import load_building
from game.world.building import Severity
from game.world.events import Action, Expired, Rescued
from game.world.geometry import Cell, Heading
from game.world.mission import Mission
from game.world.observation import Observation, SeenRoom, SeenVictim, VictimState
from game.world.plan import Plan
from game.world.settings import MissionSettings
from game.world.terrain import Terrain

PLAN = Plan(4, 2, bytes(8))
TERRAIN = Terrain(PLAN)
CELLS = [PLAN.cell(i) for i in range(8)]
PLACES = {"Attic": (0, 0), "Bar": (2, 0), "Cellar": (3, 1)}

Placement = tuple[Cell, ...]


def room_at(belief: Belief, room: str, place: Cell) -> float:
    """P(`room` is at `place`)."""
    return belief.place_distribution(room).get(place, 0.0)


def victim_at(belief: Belief, victim: str, cell: Cell) -> float:
    """P(`victim` lies on `cell`)."""
    if victim in belief.victims:
        return float(belief.space.victims[victim] == cell)
    if cell not in belief.space.plan:
        return 0.0
    return (belief.unseen >> belief.space.plan.index(cell) & 1) / belief.unseen.bit_count()


def goal_place(belief: Belief, victim: str) -> float:
    """P(the rescuer has the right place in mind for `victim`): of its cell where that is known or
    it lies in no room, else of its room's place."""
    room = belief.space.rooms[victim]
    if room is None or victim in belief.victims:
        return victim_at(belief, victim, belief.space.victims[victim])
    return room_at(belief, room, belief.space.places[room])


def _space(victims: Sequence[Cell]) -> StateSpace:
    names = [f"v{i}" for i in range(len(victims))]
    rooms = dict.fromkeys(names, "Bar") | {"v0": None}
    cells = dict(zip(names, victims, strict=True))
    return StateSpace(PLAN, PLACES, cells, rooms, PLAN.walkable_mask)


def _look(space: StateSpace, visible: int) -> Observation:
    def in_view(cell: Cell) -> bool:
        return bool(visible >> PLAN.index(cell) & 1)

    return Observation(
        terrain=TERRAIN,
        visible=visible,
        explored=visible,
        victims=tuple(
            SeenVictim(cell, Severity.BLUE, VictimState.WAITING)
            for cell in space.victims.values()
            if in_view(cell)
        ),
        remembered=(),
        rooms=tuple(SeenRoom(n, place) for n, place in PLACES.items() if in_view(place)),
        position=(1, 1),
        heading=Heading.EAST,
        time_ms=0,
        time_left_ms=1,
        treatment=None,
        rescued=0,
        score=None,
        ended=False,
        guidance=None,
    )


def _consistent(truth: Placement, world: Placement, visible: int, everywhere: int) -> bool:
    """Whether `world` would have looked like `truth` through all the cells in `visible`."""
    for actual, supposed in zip(truth, world, strict=True):
        seen = (visible >> PLAN.index(actual) | visible >> PLAN.index(supposed)) & 1
        if seen and actual != supposed:
            return False
    return everywhere == everywhere | visible


worlds = st.integers(1, 3).flatmap(
    lambda n: st.permutations(CELLS).map(lambda cells: tuple(cells[:n]))
)
views = st.lists(st.integers(0, 255), max_size=4)


@given(worlds, views)
def test_equals_enumeration_of_all_worlds(truth: Placement, views: list[int]) -> None:
    space = _space(truth)
    belief = Belief.prior(space, (1, 1), Heading.EAST)
    seen = 0
    for visible in views:
        belief = belief.correct(_look(space, visible))
        seen |= visible
    possible = [
        w
        for w in permutations(CELLS, len(truth))
        if _consistent(truth, w, seen, PLAN.walkable_mask)
    ]
    places = tuple(PLACES.values())
    named = [w for w in permutations(places) if _consistent(places, w, seen, PLAN.walkable_mask)]
    for (i, victim), cell in product(enumerate(space.victims), CELLS):
        share = sum(world[i] == cell for world in possible) / len(possible)
        assert victim_at(belief, victim, cell) == pytest.approx(share, abs=1e-12)
    for (i, room), place in product(enumerate(PLACES), places):
        share = sum(world[i] == place for world in named) / len(named)
        assert room_at(belief, room, place) == pytest.approx(share, abs=1e-12)


@given(worlds, views)
def test_seeing_more_never_makes_less_sure(truth: Placement, views: list[int]) -> None:
    space = _space(truth)
    belief = Belief.prior(space, (1, 1), Heading.EAST)
    for visible in views:
        after = belief.correct(_look(space, visible))
        assert after.unseen | belief.unseen == belief.unseen
        for victim, cell in space.victims.items():
            assert victim_at(after, victim, cell) >= victim_at(belief, victim, cell)
            assert goal_place(after, victim) >= goal_place(belief, victim)
        change = belief_change(belief, after, 7)
        assert (change is None) == (after == belief)
        belief = after
    assert sum(victim_at(belief, "v0", cell) for cell in CELLS) == pytest.approx(1)
    for room in PLACES:
        assert sum(belief.place_distribution(room).values()) == pytest.approx(1)


def test_goal_place_is_that_of_the_room_or_of_a_victim_in_the_hallway() -> None:
    belief = Belief.prior(_space([(0, 1), (2, 1)]), (1, 1), Heading.EAST)
    assert goal_place(belief, "v0") == 1 / 8
    assert goal_place(belief, "v1") == 1 / 3
    by_name = belief.correct(_look(belief.space, PLAN.mask([PLACES["Bar"]])))
    assert goal_place(by_name, "v1") == 1
    assert goal_place(by_name, "v0") == 1 / 7
    assert room_at(by_name, "Attic", PLACES["Cellar"]) == 1 / 2
    by_sight = belief.correct(_look(belief.space, PLAN.mask([(2, 1)])))
    assert goal_place(by_sight, "v1") == 1
    assert room_at(by_sight, "Bar", PLACES["Bar"]) == 1 / 3
    assert victim_at(belief, "v1", (9, 9)) == 0


def test_a_victim_seen_expired_is_resolved() -> None:
    space = _space([(0, 1), (2, 1)])
    look = _look(space, PLAN.walkable_mask)
    expired = replace(look.victims[1], state=VictimState.EXPIRED)
    belief = Belief.prior(space, (1, 1), Heading.EAST)
    belief = belief.correct(look._replace(victims=(look.victims[0], expired)))
    assert belief.victims == {"v0", "v1"}
    assert belief.resolved == {"v1"}


def test_nobody_is_thought_to_lie_in_a_doorway() -> None:
    building = load_building("practice")
    floor = set(building.plan.cells(StateSpace.of(building).floor))
    assert not any(building.plan.is_door(cell) for cell in floor)
    assert floor.issuperset(cell for room in building.rooms for cell in room.cells)
    assert floor.issuperset(site.cell for site in building.victims)


def test_what_happens_is_predicted_without_being_seen() -> None:
    belief = Belief.prior(_space([(0, 1), (2, 1)]), (1, 1), Heading.EAST)
    transition = Transition(PLAN)
    after = belief.predict(Rescued(5, "v0"), transition).predict(Expired(6, "v1"), transition)
    assert after.resolved == {"v0", "v1"}
    assert after.victims == frozenset()
    change = belief_change(belief, after, 6)
    assert change is not None
    assert change.victims_resolved == ("v0", "v1")
    assert change.unseen_cells == 8


@pytest.mark.parametrize("controls", ["compass", "turn"])
def test_along_a_mission_the_belief_holds_the_truth(controls: str) -> None:
    building = load_building("practice")
    settings = MissionSettings(controls=controls, treat_blue_ms=1)  # type: ignore[arg-type]
    mission = Mission(building, settings)
    transition = Transition(building.plan)
    turning = {Action.FORWARD, Action.TURN_LEFT, Action.TURN_RIGHT}
    actions = [a for a in Action if a is Action.TRIAGE or (a in turning) == (controls == "turn")]
    draw = Random(4)
    space = StateSpace.of(building)
    belief = Belief.prior(space, building.start, building.start_heading)
    belief = belief.correct(mission.observation())
    now_ms = 0
    for _ in range(1500):
        now_ms += 100
        action = draw.choice([*actions, actions[0]])
        for event in mission.step(None, now_ms):
            belief = belief.predict(event, transition).correct(mission.observation())
        for event in mission.step(action, now_ms):
            predicted = belief.predict(event, transition)
            belief = predicted.correct(mission.observation())
        assert (predicted.position, predicted.heading) == (mission.position, mission.heading)
    assert belief.rooms
    assert belief.victims
    assert belief.unseen == space.floor & ~mission.observation().explored
    assert belief.resolved == {
        v for v, state in mission.victims.items() if state is not VictimState.WAITING
    }
    assert belief.resolved
    for victim, cell in space.victims.items():
        assert victim_at(belief, victim, cell) > 0
        assert (victim_at(belief, victim, cell) == 1) == (victim in belief.victims)
