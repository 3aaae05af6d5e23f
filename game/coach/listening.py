"""Listening to a coach: what wants to know what it is told or says stands in its place."""

from __future__ import annotations

from game.coach.acts import CoachRecord
from game.coach.api import Coach
from game.world.events import MissionEvent
from game.world.observation import Guidance, Observation


class ListenedCoach:
    """Stands in the place of `coach` and passes everything on; kinds of it add what they hear."""

    def __init__(self, coach: Coach) -> None:
        self._coach = coach

    @property
    def guidance(self) -> Guidance:
        return self._coach.guidance

    @property
    def next_evaluation_ms(self) -> int | None:
        return self._coach.next_evaluation_ms

    def begin(self, observation: Observation) -> list[CoachRecord]:
        return self._coach.begin(observation)

    def on_event(self, event: MissionEvent, observation: Observation) -> list[CoachRecord]:
        return self._coach.on_event(event, observation)

    def evaluate(self, at_ms: int, observation: Observation) -> list[CoachRecord]:
        return self._coach.evaluate(at_ms, observation)
