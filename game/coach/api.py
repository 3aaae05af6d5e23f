"""What a coach is told, and what it answers: the surface against which a new coach is written."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Protocol

from game.coach.acts import CoachRecord
from game.coach.instructions.phrasebook import Phrasebook
from game.coach.instructions.phrasebook_file import english
from game.world.building import Building
from game.world.events import MissionEvent
from game.world.observation import Guidance, Observation
from game.world.settings import MissionSettings


@dataclass(frozen=True)
class Briefing:
    """All that a coach receives before a mission: nothing about the person who will play it, but
    the `phrases` of the language they read."""

    building: Building
    settings: MissionSettings
    seed: int = 0
    phrases: Phrasebook = field(default_factory=english)


class Coach(Protocol):
    """Anything that turns observations of the rescuer into instructions.

    The session calls `begin` once at 0 ms; then, in time order, `on_event` for every mission event
    (the observation is the one right after it) and `evaluate` when `next_evaluation_ms` falls due.
    Each call returns what the coach did, in order, for the journal. `guidance` is what stands on
    the bar after the call. A coach never reads a clock: all times are mission milliseconds.
    """

    @property
    def guidance(self) -> Guidance: ...

    @property
    def next_evaluation_ms(self) -> int | None:
        """When the coach next wants to evaluate by itself; None for never."""
        ...

    def begin(self, observation: Observation) -> list[CoachRecord]: ...

    def on_event(self, event: MissionEvent, observation: Observation) -> list[CoachRecord]: ...

    def evaluate(self, at_ms: int, observation: Observation) -> list[CoachRecord]: ...
