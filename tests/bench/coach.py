"""What the coach and a whole headless mission cost, measured inside the process."""

from __future__ import annotations

import gc
import time
from dataclasses import dataclass
from statistics import quantiles

from game.coach.api import Briefing, Coach
from game.coach.records import CoachRecord, GoalSet
from game.coach.spec import CoachSpec, build_coach, parse_coach
from game.rescuers.driver import drive
from game.rescuers.literal import LiteralReader
from game.session.play import start_in_memory
from game.world import load_building
from game.world.building import Building
from game.world.events import MissionEvent
from game.world.observation import Guidance, Observation
from game.world.settings import MissionSettings

SETTINGS = MissionSettings()


class TimedCoach:
    """A coach whose answers are timed: those that plan a route apart from all others."""

    def __init__(self, spec: CoachSpec, briefing: Briefing) -> None:
        self._coach: Coach = build_coach(spec, briefing)
        self.steps_ms: list[float] = []
        self.plans_ms: list[float] = []

    @property
    def guidance(self) -> Guidance:
        return self._coach.guidance

    @property
    def next_evaluation_ms(self) -> int | None:
        return self._coach.next_evaluation_ms

    def begin(self, observation: Observation) -> list[CoachRecord]:
        return self._coach.begin(observation)

    def told(self, event: MissionEvent, observation: Observation) -> list[CoachRecord]:
        start = time.perf_counter()
        records = self._coach.told(event, observation)
        self._note(start, records)
        return records

    def evaluate(self, at_ms: int, observation: Observation) -> list[CoachRecord]:
        start = time.perf_counter()
        records = self._coach.evaluate(at_ms, observation)
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


def coach_costs(names: tuple[str, ...], seeds: range) -> CoachCosts:
    """Of all answers of ANA in missions of a literal reader, garbage collection off."""
    steps_ms: list[float] = []
    plans_ms: list[float] = []
    for name in names:
        building = load_building(name)
        for seed in seeds:
            coach = TimedCoach(parse_coach("ana"), Briefing(building, SETTINGS, seed))
            run, _ = start_in_memory(
                building,
                SETTINGS,
                parse_coach("ana"),
                seed,
                rescuer="literal",
                build=lambda _spec, _briefing, coach=coach: coach,
            )
            gc.disable()
            drive(run, reader(building))
            gc.enable()
            steps_ms += coach.steps_ms
            plans_ms += coach.plans_ms
    return CoachCosts(_p99(steps_ms), _p99(plans_ms))


def mission_s(name: str) -> float:
    """Seconds for a whole mission of a literal reader with ANA, journal kept, in a warm process."""
    building = load_building(name)
    start = time.perf_counter()
    run, journal = start_in_memory(building, SETTINGS, parse_coach("ana"), 1, rescuer="literal")
    drive(run, reader(building))
    journal.close()
    return time.perf_counter() - start


def _p99(samples: list[float]) -> float:
    return quantiles(samples, n=100)[-1]
