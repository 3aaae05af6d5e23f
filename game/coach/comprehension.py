"""The paper's adaptive cycle: learn b^HR by goal inference, answer with a level (paper 5.2)."""

from __future__ import annotations

from dataclasses import dataclass, replace

from game.coach.acts import PosteriorEvaluated
from game.coach.bar import OnBar
from game.coach.cycle import Alpha
from game.coach.goal_filter import GoalFilter, StepTable
from game.coach.goals import instructed_prior, uniform_prior
from game.coach.levels import LevelState, verdict
from game.coach.model import Component, Comprehension, HumanModel, Learned
from game.coach.presets import Preset
from game.world.building import Building, Room
from game.world.events import Acted, Expired, MissionEvent, Rescued
from game.world.geometry import Cell
from game.world.observation import Observation


class ComprehensionLearner:
    """Learns b^HR(s_t) by its proxy P(g* | path), as a preset says.

    `goal_set` begins a window; `observe` must be told every event from the start of the mission.
    """

    alpha: Alpha = frozenset({Component.BELIEF})

    def __init__(self, preset: Preset, building: Building) -> None:
        self._preset = preset
        self._building = building
        self._room_of = {site.id: building.room_of(site) for site in building.victims}
        self._waiting = {site.id: site.cell for site in building.victims}
        self._goal: str | None = None
        self._position = building.start
        self._began_in: Room | None = None
        self._together: frozenset[str] = frozenset()
        likelihood, beta, goals = preset.likelihood, preset.beta, dict(self._waiting)
        floodfills = building.terrain.floodfills
        table = building.terrain.shared(
            ("steps", likelihood, beta, tuple(goals.items())),
            lambda: StepTable(floodfills, goals, likelihood=likelihood, beta=beta),
        )
        self._filter = GoalFilter(table, building.start, preset.window_moves)

    def goal_set(self, goal: str | None, position: Cell) -> None:
        """The coach leads to `goal` from now on; None for nowhere."""
        self._goal = goal
        self._together = self._sharing_the_room(goal)
        self._position = position
        self._began_in = self._building.room_at(position)
        self._filter.restart(position)

    def observe(self, event: MissionEvent, observation: Observation, shown: OnBar | None) -> None:
        match event:
            case Acted(position=position):
                told = shown.told if shown is not None and self._preset.told_way else None
                follows = told is not None and told.follows(self._position, position)
                self._filter.moved(position, self._together if follows else ())
                self._position = position
            case Rescued(victim=victim) | Expired(victim=victim):
                self._waiting.pop(victim, None)

    def learned(self, model: HumanModel) -> Learned:
        """The belief with a fresh comprehension; with none while no waiting goal is set."""
        goal = self._goal
        comprehension = self._comprehension(goal) if goal in self._waiting else None
        return {Component.BELIEF: replace(model.belief, comprehension=comprehension)}

    def _sharing_the_room(self, goal: str | None) -> frozenset[str]:
        """The goal, and every victim in its room, waiting or not."""
        if goal is None:
            return frozenset()
        room = self._room_of[goal]
        return frozenset(v for v, r in self._room_of.items() if v == goal or (room and r is room))

    def _comprehension(self, goal: str) -> Comprehension:
        preset, room = self._preset, self._room_of[goal]
        together = [victim for victim in self._waiting if victim in self._together]
        members = together if preset.aggregation == "room" else [goal]
        if preset.prior_mass is None:
            prior = uniform_prior(self._waiting)
        else:
            prior = instructed_prior(self._waiting, members, preset.prior_mass)
        posterior = self._filter.posterior(self._waiting, prior)
        inside = room is not None and self._building.room_at(self._position) is room
        certain = inside and preset.certain_in_goal_room
        no_alternative = len(self._waiting) in (1, len(together))
        began_there = room is not None and self._began_in is room
        blind = preset.skip_without_evidence and (no_alternative or began_there)
        return Comprehension(
            goal=goal,
            posterior=posterior,
            value=1.0 if certain else sum(posterior[member] for member in members),
            moves=self._filter.moves,
            evidence=self._filter.moves >= preset.minimum_moves and not blind,
            in_goal_room=inside,
        )


@dataclass(frozen=True)
class ThresholdInfluence:
    """Algorithm 1 as an influence process: the coach's state and act are its level.

    A coach whose alpha lacks b^HR keeps its level, whatever the model says.
    """

    preset: Preset

    def act(self, state: LevelState, model: HumanModel, alpha: Alpha) -> LevelState:
        comprehension = model.belief.comprehension
        if Component.BELIEF not in alpha or comprehension is None or not comprehension.evidence:
            return state
        return state.evaluated(
            self.preset, comprehension.value, in_goal_room=comprehension.in_goal_room
        )


def evaluation_record(
    comprehension: Comprehension, thresholds: tuple[float, float], at_ms: int
) -> PosteriorEvaluated:
    """What the journal keeps of an evaluation by these thresholds."""
    lower_below, raise_above = thresholds
    said = verdict(comprehension.value, lower_below, raise_above)
    return PosteriorEvaluated(
        at_ms,
        goal=comprehension.goal,
        posterior=dict(comprehension.posterior),
        comprehension=comprehension.value,
        moves=comprehension.moves,
        lower_below=lower_below,
        raise_above=raise_above,
        verdict=said if comprehension.evidence else "none",
    )
