"""The paper's static instructor: one level for the whole mission."""

from __future__ import annotations

from typing import TypeVar

from game.coach.acts import Level
from game.coach.api import Briefing
from game.coach.bar import OnBar
from game.coach.cycle import Alpha
from game.coach.guide import Guide
from game.coach.model import HumanModel, Learned
from game.world.events import MissionEvent
from game.world.observation import Observation

_State = TypeVar("_State")


class NoLearning:
    """Learns nothing: alpha is empty."""

    alpha: Alpha = frozenset()

    def observe(self, event: MissionEvent, observation: Observation, shown: OnBar | None) -> None:
        pass

    def learned(self, model: HumanModel) -> Learned:
        return {}


class NoInfluence:
    """Acts the same whatever the human model says."""

    def act(self, state: _State, model: HumanModel, alpha: Alpha) -> _State:
        return state


class StaticCoach(Guide[Level]):
    """Speaks at `level`, whatever the rescuer does."""

    def __init__(self, briefing: Briefing, level: Level) -> None:
        super().__init__(briefing, NoLearning(), NoInfluence(), level)

    @property
    def level(self) -> Level:
        return self.state
