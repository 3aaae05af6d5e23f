"""The coaches: instances of the adaptive cycle that differ by their two processes alone."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeVar

from game.coach.acts import CoachRecord, Level, LevelChanged, PaceLearned
from game.coach.api import Briefing
from game.coach.comprehension import (
    ComprehensionLearner,
    ThresholdInfluence,
    evaluation_record,
)
from game.coach.cycle import Alpha
from game.coach.guide import Guide, Occasion
from game.coach.levels import LevelState
from game.coach.model import Component, HumanModel, Learned
from game.coach.pace import PaceLearner
from game.coach.presets import Preset
from game.world.events import MissionEvent
from game.world.geometry import Cell
from game.world.observation import Observation

_State = TypeVar("_State")


class NoLearning:
    """Learns nothing: alpha is empty."""

    alpha: Alpha = frozenset()

    def observe(self, event: MissionEvent, observation: Observation) -> None:
        pass

    def learned(self, model: HumanModel) -> Learned:
        return {}


class NoInfluence:
    """Acts the same whatever the human model says."""

    def act(self, state: _State, model: HumanModel, alpha: Alpha) -> _State:
        return state


@dataclass(frozen=True)
class RoutePaceInfluence:
    """Plans with the pace of A^HR, in whole milliseconds, where alpha has it."""

    def act(self, state: int, model: HumanModel, alpha: Alpha) -> int:
        return round(model.actions.ms_per_move) if Component.ACTIONS in alpha else state


class StaticCoach(Guide[Level]):
    """The paper's static instructor: one level for the whole mission."""

    def __init__(self, briefing: Briefing, level: Level) -> None:
        super().__init__(briefing, NoLearning(), NoInfluence(), level)

    @property
    def level(self) -> Level:
        return self._state


class AdaptiveCoach(Guide[LevelState]):
    """ANA: learns b^HR by goal inference and adapts the level (paper 5.2, Algorithm 1)."""

    def __init__(self, briefing: Briefing, preset: Preset) -> None:
        building = briefing.building
        self._preset = preset
        self._next_evaluation_ms = preset.every_ms
        self._learner = ComprehensionLearner(preset, building, building.terrain.floodfills)
        super().__init__(
            briefing, self._learner, ThresholdInfluence(preset), LevelState.first(preset)
        )

    @property
    def level(self) -> Level:
        return self._state.level

    @property
    def next_evaluation_ms(self) -> int | None:
        return self._next_evaluation_ms

    def evaluate(self, at_ms: int, observation: Observation) -> list[CoachRecord]:
        if self._preset.every_ms is not None:
            self._next_evaluation_ms = at_ms + self._preset.every_ms
        return super().evaluate(at_ms, observation)

    def _goal_set(self, goal: str, position: Cell) -> None:
        self._learner.goal_set(goal, position)

    def _goal_ended(self, at_ms: int, *, rescued: bool) -> list[CoachRecord]:
        state = self._state
        ended = state.goal_ended(self._preset, rescued=True) if rescued else LevelState(state.level)
        return self._enter(ended, at_ms)

    def _adapt(self, occasion: Occasion, at_ms: int) -> list[CoachRecord]:
        if occasion != self._preset.evaluate:
            return []
        comprehension = self._cycle.evaluate().belief.comprehension
        assert comprehension is not None
        return [
            evaluation_record(comprehension, self._preset, at_ms),
            *self._enter(self._cycle.adapt(self._state), at_ms),
        ]

    def _enter(self, state: LevelState, at_ms: int) -> list[CoachRecord]:
        before, self._state = self._state, state
        comprehension = self._cycle.model.belief.comprehension
        if comprehension is None or state.level is before.level:
            return []
        return [LevelChanged(at_ms, before.level, state.level, comprehension.value)]


class PaceCoach(Guide[int]):
    """Learns A^HR, the rescuer's pace, and plans the route by it; speaks at one level."""

    def __init__(self, briefing: Briefing, level: Level) -> None:
        settings = briefing.settings
        self._level = level
        super().__init__(briefing, PaceLearner(settings), RoutePaceInfluence(), settings.pace_ms)

    @property
    def level(self) -> Level:
        return self._level

    @property
    def ms_per_move(self) -> int:
        return self._state

    def _goal_ended(self, at_ms: int, *, rescued: bool) -> list[CoachRecord]:
        self._cycle.evaluate()
        before, self._state = self._state, self._cycle.adapt(self._state)
        return [] if self._state == before else [PaceLearned(at_ms, float(self._state))]
