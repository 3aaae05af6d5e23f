"""Learns A^HR, the rescuer's pace (paper 3.3's example of a capability), and plans by it."""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass, replace
from statistics import median

from game.coach.acts import CoachRecord, Level, PaceLearned
from game.coach.api import Briefing
from game.coach.bar import OnBar
from game.coach.cycle import Alpha
from game.coach.guide import Guide
from game.coach.model import Component, HumanModel, Learned
from game.world.events import Acted, MissionEvent, Outcome
from game.world.observation import Observation
from game.world.settings import MissionSettings

WINDOW_INTERVALS = 25


class PaceLearner:
    """The median of the last intervals between one move and the next.

    Before any move all intervals are the pace of the keys, and each new one displaces one of
    those, so the prior fades within `WINDOW_INTERVALS` moves. A median is not moved by pauses as
    long as they are the minority. Turns and bumps belong to the move that follows them; an
    interval in which triage was tried is none.
    """

    alpha: Alpha = frozenset({Component.ACTIONS})

    def __init__(self, settings: MissionSettings) -> None:
        self._intervals = deque([settings.pace_ms] * WINDOW_INTERVALS, maxlen=WINDOW_INTERVALS)
        self._moved_ms: int | None = None

    @property
    def ms_per_move(self) -> float:
        return float(median(self._intervals))

    def observe(self, event: MissionEvent, observation: Observation, shown: OnBar | None) -> None:
        if not isinstance(event, Acted):
            return
        match event.outcome:
            case Outcome.MOVED:
                if self._moved_ms is not None:
                    self._intervals.append(event.at_ms - self._moved_ms)
                self._moved_ms = event.at_ms
            case Outcome.BUMPED | Outcome.TURNED:
                pass
            case _:
                self._moved_ms = None

    def learned(self, model: HumanModel) -> Learned:
        return {Component.ACTIONS: replace(model.actions, ms_per_move=self.ms_per_move)}


@dataclass(frozen=True)
class RoutePaceInfluence:
    """Plans with the pace of A^HR, in whole milliseconds, where alpha has it."""

    def act(self, state: int, model: HumanModel, alpha: Alpha) -> int:
        return round(model.actions.ms_per_move) if Component.ACTIONS in alpha else state


class PaceCoach(Guide[int]):
    """Speaks at `level`, and plans the route by the pace that it has learned."""

    def __init__(self, briefing: Briefing, level: Level) -> None:
        settings = briefing.settings
        self._level = level
        super().__init__(briefing, PaceLearner(settings), RoutePaceInfluence(), settings.pace_ms)

    @property
    def level(self) -> Level:
        return self._level

    @property
    def ms_per_move(self) -> int:
        return self.state

    def goal_ended(self, at_ms: int, *, rescued: bool) -> list[CoachRecord]:
        self.cycle.evaluate()
        before, self.state = self.state, self.cycle.adapt(self.state)
        return [] if self.state == before else [PaceLearned(at_ms, float(self.state))]
