"""M^HR: the coach's estimate of the rescuer as a POMDP (paper 3.2, 3.3 and 5.1.3)."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from enum import Enum
from typing import Any

from game.coach.belief import Belief, StateSpace, Transition
from game.coach.policy import Directions, action_probabilities, directed_moves
from game.world.building import Building
from game.world.events import Action, MissionEvent
from game.world.floodfill import Floodfills
from game.world.observation import Observation
from game.world.settings import MissionSettings
from game.world.sight import Sight


class Component(Enum):
    """The components of the estimate; the values are the fields of `HumanModel`."""

    STATES = "states"
    ACTIONS = "actions"
    TRANSITION = "transition"
    REWARD = "reward"
    OBSERVATIONS = "observations"
    OBSERVATION_FUNCTION = "observation_function"
    BELIEF = "belief"


Learned = Mapping[Component, Any]
"""New values for some components."""


@dataclass(frozen=True)
class ActionSet:
    """A^HR: what the rescuer can do, and how many milliseconds a move takes them."""

    actions: tuple[Action, ...]
    ms_per_move: float

    @classmethod
    def of(cls, settings: MissionSettings) -> ActionSet:
        """All actions of the controls, at the pace of the keys."""
        return cls(_ACTIONS[settings.controls], float(settings.pace_ms))


@dataclass(frozen=True)
class Reward:
    """R^HR: following the directions is rewarded (paper 5.1.3). A step that comes nearer to where
    they lead earns `per_cell`, one that goes away loses it; the policy is the softmax of that, so
    `per_cell` is the beta of the goal inference."""

    per_cell: float = 1.0


@dataclass(frozen=True)
class Observations:
    """Omega^HR: which parts of what is in view the rescuer takes in. What is not taken in rules
    nothing out either: who overlooks victims does not hold the floor in view to be free of them.
    """

    room_names: bool = True
    victims: bool = True

    def taken_in(self, observation: Observation) -> Observation:
        if self.room_names and self.victims:
            return observation
        return observation._replace(
            rooms=observation.rooms if self.room_names else (),
            victims=observation.victims if self.victims else (),
            visible=observation.visible if self.victims else 0,
        )


@dataclass(frozen=True)
class Comprehension:
    """P(g* | path) at one evaluation: the paper's crude proxy for b^HR(s_t) (5.2.1).

    `posterior` is over the waiting victims; `value` is P of the goal or of its room, as the
    preset says; `moves` counts the moves in the window; where `evidence` is false the preset
    holds that they tell nothing.
    """

    goal: str
    posterior: Mapping[str, float]
    value: float
    moves: int
    evidence: bool
    in_goal_room: bool


@dataclass(frozen=True)
class KnownRooms:
    """What the rescuer is held to know of the rooms, brought along or seen: P(its place is known)
    by room, and the mean and standard deviation of the share of rooms known from the start."""

    by_room: Mapping[str, float]
    share: float
    share_sd: float


@dataclass(frozen=True)
class BeliefEstimate:
    """b^HR: the belief over states and, beside it, what a coach may have learned of it: the latest
    proxy, never in its place, and which rooms were known beforehand."""

    state: Belief
    comprehension: Comprehension | None = None
    known: KnownRooms | None = None


@dataclass(frozen=True)
class HumanModel:
    """The tuple (S, A, T, R, Omega, O, b) and the policy it implies.

    `floodfills` are no component but the means by which the policy finds the way to a place.
    """

    states: StateSpace
    actions: ActionSet
    transition: Transition
    reward: Reward
    observations: Observations
    observation_function: Sight
    belief: BeliefEstimate
    floodfills: Floodfills = field(repr=False, compare=False)

    @classmethod
    def of(cls, building: Building, settings: MissionSettings) -> HumanModel:
        """The estimate before a mission: what its rules say, and a belief that knows nothing."""
        states = StateSpace.of(building)
        start = Belief.prior(states, building.start, building.start_heading)
        return cls(
            states=states,
            actions=ActionSet.of(settings),
            transition=Transition(building.plan),
            reward=Reward(),
            observations=Observations(),
            observation_function=building.terrain.sight(settings.sight_radius),
            belief=BeliefEstimate(start),
            floodfills=building.terrain.floodfills,
        )

    def with_learned(self, learned: Learned) -> HumanModel:
        """M' = alpha' with the rest of M (paper 3.3): the components in `learned` are replaced and
        no others. Raises TypeError for a value that is not such a component."""
        for component, value in learned.items():
            expected = type(getattr(self, component.value))
            if not isinstance(value, expected):
                raise TypeError(f"component {component.value} must be a {expected.__name__}")
        return replace(self, **{component.value: value for component, value in learned.items()})

    def seeing(self, observation: Observation) -> HumanModel:
        """The estimate once the rescuer has seen `observation`: b is corrected by it."""
        return self._believing(self._corrected(self.belief.state, observation))

    def after(self, event: MissionEvent, observation: Observation) -> HumanModel:
        """The estimate after `event` and the observation that follows it: b is predicted by T and
        corrected (paper 5.1.3)."""
        predicted = self.belief.state.predict(event, self.transition)
        return self._believing(self._corrected(predicted, observation))

    def policy(self, directions: Directions, belief: Belief) -> dict[Action, float]:
        """pi^HR: the probability of every action of A for a rescuer who is given `directions` and
        believes `belief`. At C1 it does not depend on the belief (paper 5.1.3); at C2 on no more
        of it than the position, from which O gives the view; at C3 on where it holds the goal to
        be."""
        moves = directed_moves(
            directions, belief, self.floodfills, self.observation_function, self.reward.per_cell
        )
        return action_probabilities(moves, self.actions.actions)

    def _corrected(self, belief: Belief, observation: Observation) -> Belief:
        return belief.correct(self.observations.taken_in(observation))

    def _believing(self, state: Belief) -> HumanModel:
        before = self.belief
        if state == before.state:
            return self
        return HumanModel(
            self.states,
            self.actions,
            self.transition,
            self.reward,
            self.observations,
            self.observation_function,
            BeliefEstimate(state, before.comprehension, before.known),
            self.floodfills,
        )


_ACTIONS = {
    "compass": (Action.NORTH, Action.EAST, Action.SOUTH, Action.WEST, Action.TRIAGE),
    "turn": (Action.FORWARD, Action.TURN_LEFT, Action.TURN_RIGHT, Action.TRIAGE),
}
