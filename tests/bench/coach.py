"""What the coach and a whole headless mission cost, measured inside the process."""

from __future__ import annotations

import gc
import time
from collections.abc import Iterable
from dataclasses import dataclass
from random import Random
from statistics import quantiles

from game.coach.acts import CoachRecord, GoalSet
from game.coach.api import Briefing, Coach
from game.coach.listening import ListenedCoach
from game.coach.spec import CoachSpec, build_coach, parse_coach
from game.commands.ana_play import DEFAULT_BUILDING, assigned
from game.rescuers.catalogue import character
from game.rescuers.driver import drive
from game.rescuers.literal import LiteralReader
from game.session.playing import CoachBuilder, start_in_memory
from game.world import load_building
from game.world.building import Building
from game.world.events import Action, MissionEvent
from game.world.floodfill import Floodfills
from game.world.generation.office import generated
from game.world.observation import Observation
from game.world.route import RoutePlanner
from game.world.settings import MissionSettings

SETTINGS = MissionSettings()
KEY_OF = {
    Action.NORTH: "up",
    Action.EAST: "right",
    Action.SOUTH: "down",
    Action.WEST: "left",
    Action.TRIAGE: "space",
}


class TimedCoach(ListenedCoach):
    """A coach whose answers are timed: those that plan a route apart from all others."""

    def __init__(self, spec: CoachSpec, briefing: Briefing) -> None:
        super().__init__(build_coach(spec, briefing))
        self.steps_ms: list[float] = []
        self.plans_ms: list[float] = []

    def on_event(self, event: MissionEvent, observation: Observation) -> list[CoachRecord]:
        start = time.perf_counter()
        records = super().on_event(event, observation)
        self._note(start, records)
        return records

    def evaluate(self, at_ms: int, observation: Observation) -> list[CoachRecord]:
        start = time.perf_counter()
        records = super().evaluate(at_ms, observation)
        self._note(start, records)
        return records

    def _note(self, start: float, records: list[CoachRecord]) -> None:
        planned = any(isinstance(record, GoalSet) for record in records)
        spent = self.plans_ms if planned else self.steps_ms
        spent.append(1000 * (time.perf_counter() - start))


@dataclass(frozen=True)
class CoachCosts:
    """Milliseconds."""

    step_p99: float
    plan_p99: float


def reader(building: Building) -> LiteralReader:
    return LiteralReader(SETTINGS.controls, {room.name: room.label for room in building.rooms})


def _always(coach: Coach) -> CoachBuilder:
    return lambda _spec, _briefing: coach


def coached_keys(seed: int, count: int, every_ms: int, assignments: Iterable[str]) -> list[str]:
    """The first keys with which a literal reader follows ANA in the usual building."""
    building, settings = load_building(DEFAULT_BUILDING), assigned(SETTINGS, assignments)
    run, _ = start_in_memory(building, settings, parse_coach("ana"), seed, rescuer="literal")
    keys: list[str] = []
    follower = reader(building)
    now_ms = 0
    while len(keys) < count and not run.ended:
        action = follower.decide(run.observation())
        if action is not None:
            keys.append(KEY_OF[action])
            run.press(action, now_ms)
        now_ms += every_ms
        run.advance(now_ms)
    return keys


def coach_costs(
    names: tuple[str, ...], seeds: range, kind: str = "ana", rescuer: str = "literal"
) -> CoachCosts:
    """Of all answers of a coach in missions of a simulated rescuer, garbage collection off."""
    steps_ms: list[float] = []
    plans_ms: list[float] = []
    for name in names:
        building = load_building(name)
        for seed in seeds:
            run, _ = start_in_memory(
                building, SETTINGS, parse_coach(kind), seed, rescuer=rescuer, build=TimedCoach
            )
            coach = run.coach
            assert isinstance(coach, TimedCoach)
            gc.disable()
            drive(run, character(rescuer).make(building, SETTINGS, seed))
            gc.enable()
            steps_ms += coach.steps_ms
            plans_ms += coach.plans_ms
    return CoachCosts(_p99(steps_ms), _p99(plans_ms))


def route_p99_ms(names: tuple[str, ...], seed: int, samples: int = 300) -> float:
    """Of routes planned anew from random places, for random victims still waiting."""
    random = Random(seed)
    spent_ms: list[float] = []
    for name in names:
        building = load_building(name)
        floodfills = Floodfills(building.plan)
        sites = {site.id: site for site in building.victims}
        planner = RoutePlanner(floodfills, SETTINGS, sites, seed=seed)
        places = [cell for room in building.rooms for cell in room.cells]
        for _ in range(samples):
            left = random.sample(list(sites), random.randint(1, len(sites)))
            waiting = {victim: sites[victim] for victim in left}
            here, at_ms = random.choice(places), random.randrange(SETTINGS.duration_ms)
            start = time.perf_counter()
            planner.plan(here, at_ms, waiting, ms_per_move=SETTINGS.pace_ms)
            spent_ms.append(1000 * (time.perf_counter() - start))
    return _p99(spent_ms)


def mission_s(name: str) -> float:
    """Seconds for a whole mission of a literal reader with ANA, journal kept, in a warm process."""
    building = load_building(name)
    start = time.perf_counter()
    run, journal = start_in_memory(building, SETTINGS, parse_coach("ana"), 1, rescuer="literal")
    drive(run, reader(building))
    journal.close()
    return time.perf_counter() - start


def office_ms(seed: int) -> float:
    """Milliseconds to make the office of a seed."""
    start = time.perf_counter()
    generated(seed)
    return 1000 * (time.perf_counter() - start)


def _p99(samples: list[float]) -> float:
    return quantiles(samples, n=100)[-1]
