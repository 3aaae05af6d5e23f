"""Learning A^HR: how long the rescuer takes for a move (paper 3.3's example of a capability)."""

from __future__ import annotations

from collections import deque
from dataclasses import replace
from statistics import median

from game.coach.cycle import Alpha
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

    def observe(self, event: MissionEvent, observation: Observation) -> None:
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
