from __future__ import annotations

from dataclasses import replace
from itertools import pairwise
from typing import Any, Literal

import msgspec
import pytest

from game.coach.acts import Level
from game.coach.bar import OnBar
from game.coach.comprehension import ComprehensionLearner, ThresholdInfluence, evaluation_record
from game.coach.cycle import AdaptiveCycle, Alpha
from game.coach.goals import goal_posterior, instructed_prior
from game.coach.kinds.pace import WINDOW_INTERVALS, PaceLearner
from game.coach.levels import LevelState
from game.coach.model import Component, Comprehension, HumanModel, Learned
from game.coach.presets import CALIBRATED, LITERAL, RELEASED, Preset
from game.world import load_building
from game.world.events import Acted, Action, Expired, MissionEvent, Outcome, Rescued
from game.world.floodfill import Floodfills
from game.world.geometry import Cell, Heading
from game.world.mission import Mission
from game.world.observation import Observation
from game.world.settings import MissionSettings

BUILDING = load_building("practice")
FLOODFILLS = Floodfills(BUILDING.plan)
SETTINGS = MissionSettings()
SEEN = Mission(BUILDING, SETTINGS).observation()
CELLS = {site.id: site.cell for site in BUILDING.victims}
ROOM = {site.id: BUILDING.room_of(site) for site in BUILDING.victims}
GOAL = next(v for v, room in ROOM.items() if room is not None and room.name == "Clinic")
OTHER = next(v for v, room in ROOM.items() if room is not None and room.name == "Cloakroom")


def _moved(cell: Cell, at_ms: int = 0) -> Acted:
    return Acted(at_ms, at_ms, Action.NORTH, Outcome.MOVED, cell, Heading.NORTH)


def _way(start: Cell, goal: Cell) -> list[Cell]:
    plan, field = BUILDING.plan, FLOODFILLS.to(goal)
    path = [start]
    while path[-1] != goal:
        path.append(plan.cell(min(plan.neighbours[plan.index(path[-1])], key=field.__getitem__)))
    return path


Cycle = AdaptiveCycle[LevelState, LevelState]


def _cycle(chosen: Preset) -> tuple[Cycle, ComprehensionLearner]:
    learner = ComprehensionLearner(chosen, BUILDING)
    model = HumanModel.of(BUILDING, SETTINGS)
    return AdaptiveCycle(model, learner, ThresholdInfluence(chosen)), learner


def _walk(cycle: Cycle, path: list[Cell]) -> None:
    for cell in path[1:]:
        cycle.observe(_moved(cell), SEEN)


def _comprehension(cycle: Cycle) -> Comprehension:
    comprehension = cycle.evaluate().belief.comprehension
    assert comprehension is not None
    return comprehension


def test_comprehension_is_the_posterior_of_the_last_moves_within_the_goal() -> None:
    cycle, learner = _cycle(CALIBRATED)
    path = _way(BUILDING.start, CELLS[GOAL])
    learner.goal_set(GOAL, path[0])
    _walk(cycle, path[:23])
    walkable = [
        [BUILDING.plan.walkable((x, y)) for x in range(BUILDING.plan.width)]
        for y in range(BUILDING.plan.height)
    ]
    members = [v for v in CELLS if ROOM[v] is ROOM[GOAL]]
    prior = instructed_prior(CELLS, members, 0.5)
    expected = goal_posterior(walkable, CELLS, path[7:23], prior=prior)
    comprehension = _comprehension(cycle)
    assert comprehension.posterior == expected
    assert comprehension.value == sum(expected[v] for v in members)
    assert comprehension.moves == 15
    assert comprehension.evidence


def test_who_goes_elsewhere_is_led_at_a_lower_level_and_who_goes_there_higher() -> None:
    for walked_to, level in ((OTHER, Level.C1), (GOAL, Level.C3)):
        chosen = msgspec.structs.replace(CALIBRATED, raise_only_at_goal_end=False)
        cycle, learner = _cycle(chosen)
        learner.goal_set(GOAL, BUILDING.start)
        _walk(cycle, _way(BUILDING.start, CELLS[walked_to])[:-1])
        cycle.evaluate()
        assert cycle.adapt(LevelState(Level.C2)).level is level
        assert ThresholdInfluence(chosen).act(
            LevelState(Level.C2), cycle.model, frozenset()
        ) == LevelState(Level.C2)


def test_a_resolved_victim_leaves_the_whole_window() -> None:
    cycle, learner = _cycle(CALIBRATED)
    learner.goal_set(GOAL, BUILDING.start)
    _walk(cycle, _way(BUILDING.start, CELLS[GOAL])[:12])
    before = _comprehension(cycle).posterior
    cycle.observe(Expired(1, OTHER), SEEN)
    after = _comprehension(cycle)
    assert OTHER in before
    assert OTHER not in after.posterior
    assert after.moves == 11
    assert sum(after.posterior.values()) == pytest.approx(1)


def test_without_a_waiting_goal_there_is_no_comprehension() -> None:
    cycle, learner = _cycle(CALIBRATED)
    learner.goal_set(GOAL, BUILDING.start)
    _walk(cycle, _way(BUILDING.start, CELLS[OTHER]))
    assert _comprehension(cycle).value < 0.3
    cycle.observe(Rescued(1, GOAL), SEEN)
    assert cycle.evaluate().belief.comprehension is None
    assert cycle.adapt(LevelState(Level.C2)) == LevelState(Level.C2)


def test_no_evidence() -> None:
    def evidence(chosen: Preset, begin: Cell, path: list[Cell], gone: set[str]) -> bool:
        cycle, learner = _cycle(chosen)
        _walk(cycle, _way(BUILDING.start, begin))
        for victim in gone:
            cycle.observe(Expired(0, victim), SEEN)
        learner.goal_set(GOAL, begin)
        _walk(cycle, path)
        return _comprehension(cycle).evidence

    hall = _way((15, 10), CELLS[GOAL])
    assert evidence(CALIBRATED, hall[0], hall[:4], set())
    assert not evidence(CALIBRATED, hall[0], hall[:3], set())
    assert not evidence(CALIBRATED, hall[0], hall[:4], set(CELLS) - {GOAL})
    assert evidence(LITERAL, hall[0], hall[:4], set(CELLS) - {GOAL})
    room = ROOM[GOAL]
    assert room is not None
    inside = next(c for c in room.cells if FLOODFILLS.distance(c, CELLS[GOAL]) > 4)
    within = _way(inside, CELLS[GOAL])
    assert not evidence(CALIBRATED, inside, within[:5], set())
    assert evidence(RELEASED, inside, within[:5], set())


@pytest.mark.parametrize("aggregation", ["victim", "room"])
def test_when_all_wait_in_one_room_there_is_no_evidence(
    aggregation: Literal["victim", "room"],
) -> None:
    building = load_building("harbour")
    chosen = msgspec.structs.replace(CALIBRATED, aggregation=aggregation, minimum_moves=0)
    model = HumanModel.of(building, SETTINGS)
    by_room: dict[str, list[str]] = {}
    for site in building.victims:
        room = building.room_of(site)
        by_room.setdefault(room.name if room else site.id, []).append(site.id)
    shared = next(victims for victims in by_room.values() if len(victims) == 2)
    others = [site.id for site in building.victims if site.id not in shared]
    learner = ComprehensionLearner(chosen, building)
    learner.goal_set(shared[0], building.start)
    evidence = []
    for victim in [None, *others]:
        if victim is not None:
            learner.observe(Expired(0, victim), SEEN, None)
        comprehension = learner.learned(model)[Component.BELIEF].comprehension
        evidence.append(comprehension.evidence)
    assert evidence == [True] * len(others) + [False]
    assert set(comprehension.posterior) == set(shared)


def test_released_is_certain_in_the_goals_room() -> None:
    cycle, learner = _cycle(RELEASED)
    learner.goal_set(GOAL, BUILDING.start)
    path = _way(BUILDING.start, CELLS[GOAL])
    door = next(i for i, cell in enumerate(path) if BUILDING.room_at(cell) is ROOM[GOAL]) - 1
    _walk(cycle, path[: door + 1])
    outside = _comprehension(cycle)
    assert not outside.in_goal_room
    assert outside.value == outside.posterior[GOAL] < 1
    assert cycle.adapt(LevelState(Level.C1)).level is Level.C2
    uncertain, learner = _cycle(LITERAL)
    learner.goal_set(GOAL, path[door - 1])
    _walk(uncertain, path[door - 1 : door + 2])
    inside = _comprehension(uncertain)
    assert inside.in_goal_room
    assert inside.value == inside.posterior[GOAL] < 1
    _walk(cycle, path[door : door + 2])
    assert _comprehension(cycle).value == 1
    assert cycle.adapt(LevelState(Level.C1)).level is Level.C3


def test_the_record_of_an_evaluation() -> None:
    comprehension = Comprehension(GOAL, {GOAL: 0.2, OTHER: 0.8}, 0.2, 9, True, False)
    record = evaluation_record(comprehension, (0.3, 0.8), 3_000)
    assert (record.verdict, record.comprehension, record.moves) == ("lower", 0.2, 9)
    assert (record.lower_below, record.raise_above) == (0.3, 0.8)
    blind = evaluation_record(replace(comprehension, evidence=False), (0.3, 0.8), 3_000)
    assert blind == msgspec.structs.replace(record, verdict="none")


class Overstepping:
    alpha: Alpha = frozenset({Component.ACTIONS})

    def observe(
        self, event: MissionEvent, observation: Observation, shown: OnBar | None
    ) -> None: ...

    def learned(self, model: HumanModel) -> Learned:
        return {Component.REWARD: model.reward}


def test_a_learner_keeps_to_its_alpha() -> None:
    model = HumanModel.of(BUILDING, SETTINGS)
    cycle = AdaptiveCycle(model, Overstepping(), ThresholdInfluence(CALIBRATED))
    with pytest.raises(ValueError, match="learned reward, which alpha lacks"):
        cycle.evaluate()


def _pace(intervals: list[int], outcomes: dict[int, Outcome] | None = None) -> PaceLearner:
    learner = PaceLearner(SETTINGS)
    now_ms = 0
    learner.observe(_moved((1, 10)), SEEN, None)
    for n, interval in enumerate(intervals):
        now_ms += interval
        outcome = (outcomes or {}).get(n, Outcome.MOVED)
        action: dict[str, Any] = {"action": Action.EAST, "position": (1, 10)}
        event = Acted(now_ms, now_ms, outcome=outcome, heading=Heading.EAST, **action)
        learner.observe(event, SEEN, None)
    return learner


def test_pace_begins_at_the_keys_and_follows_the_rescuer() -> None:
    assert PaceLearner(SETTINGS).ms_per_move == 200
    paces = [_pace([350] * n).ms_per_move for n in range(WINDOW_INTERVALS + 1)]
    assert all(a <= b for a, b in pairwise(paces))
    assert paces[0] == 200
    assert paces[-1] == 350


def test_pace_is_not_moved_by_pauses_or_treatments() -> None:
    assert _pace([300] * 20 + [9_000] * 5 + [300] * 10).ms_per_move == 300
    treated = dict.fromkeys(range(1, 40, 2), Outcome.TREATING)
    assert _pace([250, 2_000] * 20, treated).ms_per_move == 200
    turned = dict.fromkeys(range(0, 60, 2), Outcome.TURNED)
    assert _pace([200, 200] * 30, turned).ms_per_move == 400


def test_pace_is_learned_into_the_actions_alone() -> None:
    model = HumanModel.of(BUILDING, SETTINGS)
    learned = model.with_learned(_pace([400] * 30).learned(model))
    assert learned.actions.ms_per_move == 400
    assert learned.actions.actions == model.actions.actions
    assert learned.belief is model.belief
