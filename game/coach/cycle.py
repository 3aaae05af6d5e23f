"""The adaptive cycle: learn a component of the human model, then influence (paper section 4)."""

from __future__ import annotations

from typing import Generic, Protocol, TypeVar

from game.coach.bar import OnBar
from game.coach.model import Component, HumanModel, Learned
from game.world.events import MissionEvent
from game.world.observation import Observation

Alpha = frozenset[Component]
"""The adaptation parameter: which components a coach learns (paper 3.3)."""

State = TypeVar("State")
Act = TypeVar("Act")
_StateIn = TypeVar("_StateIn", contravariant=True)
_ActOut = TypeVar("_ActOut", covariant=True)


class LearningProcess(Protocol):
    """Turns what the rescuer did into new values of alpha (paper 4.1)."""

    @property
    def alpha(self) -> Alpha: ...

    def observe(self, event: MissionEvent, observation: Observation, shown: OnBar | None) -> None:
        """Take in something that happened, what was to be seen right after it, and the instruction
        that stood on the bar meanwhile."""
        ...

    def learned(self, model: HumanModel) -> Learned:
        """The values of alpha as they are held now; none where nothing was learned."""
        ...


class InfluenceProcess(Protocol[_StateIn, _ActOut]):
    """f with parameters M^R, M^HR and alpha, from the coach's states to its acts (paper 4.2).

    M^R, the coach's own decision process, is whatever the object holds.
    """

    def act(self, state: _StateIn, model: HumanModel, alpha: Alpha) -> _ActOut: ...


class AdaptiveCycle(Generic[State, Act]):
    """Holds a human model and runs the two processes on it."""

    def __init__(
        self, model: HumanModel, learning: LearningProcess, influence: InfluenceProcess[State, Act]
    ) -> None:
        self.model = model
        self._learning = learning
        self._influence = influence

    def begin(self, observation: Observation) -> None:
        """The rescuer sees the building for the first time."""
        self.model = self.model.seeing(observation)

    def observe(
        self, event: MissionEvent, observation: Observation, shown: OnBar | None = None
    ) -> None:
        """The model's belief follows what happened, and the learning process takes it in."""
        self.model = self.model.after(event, observation)
        self._learning.observe(event, observation, shown)

    def evaluate(self) -> HumanModel:
        """EVALUATE: put what was learned into the model. Raises ValueError when the learning
        process oversteps its alpha."""
        learned = self._learning.learned(self.model)
        if beyond := learned.keys() - self._learning.alpha:
            names = ", ".join(sorted(component.value for component in beyond))
            raise ValueError(f"the learning process has learned {names}, which alpha lacks")
        self.model = self.model.with_learned(learned)
        return self.model

    def adapt(self, state: State) -> Act:
        """ADAPT: the coach's next act."""
        return self._influence.act(state, self.model, self._learning.alpha)
