"""ANA: learns b^HR by goal inference and adapts its level (paper 5.2, Algorithm 1)."""

from __future__ import annotations

from game.coach.acts import CoachRecord, Level, LevelChanged
from game.coach.api import Briefing
from game.coach.comprehension import (
    ComprehensionLearner,
    ThresholdInfluence,
    evaluation_record,
)
from game.coach.guide import Guide, Occasion
from game.coach.instructions import Pose
from game.coach.kinds.ana_by_belief import AnaByBelief
from game.coach.levels import LevelState
from game.coach.presets import Preset
from game.world.events import LevelWish
from game.world.geometry import Cell
from game.world.observation import Observation

_OCCASIONS: dict[str, tuple[Occasion, ...]] = {
    "step": ("step",),
    "instruction": ("completed", "misstep"),
    "every": ("time",),
    "goal": ("goal",),
}
"""The occasions on which a preset evaluates."""


class Ana(Guide[LevelState]):
    """The paper's adaptive instructor, with the choices that the paper leaves open in `preset`."""

    def __init__(self, briefing: Briefing, preset: Preset) -> None:
        self._preset = preset
        self._next_evaluation_ms = preset.every_ms
        self._learner = ComprehensionLearner(preset, briefing.building)
        super().__init__(
            briefing, self._learner, ThresholdInfluence(preset), LevelState.first(preset)
        )

    @property
    def level(self) -> Level:
        return self.state.level

    @property
    def next_evaluation_ms(self) -> int | None:
        return self._next_evaluation_ms

    def evaluate(self, at_ms: int, observation: Observation) -> list[CoachRecord]:
        if self._preset.every_ms is not None:
            self._next_evaluation_ms = at_ms + self._preset.every_ms
        return super().evaluate(at_ms, observation)

    def goal_set(self, goal: str, position: Cell) -> None:
        self._learner.goal_set(goal, position)

    def goal_ended(self, at_ms: int, *, rescued: bool) -> list[CoachRecord]:
        state = self.state
        return self._enter(state.rescued(self._preset) if rescued else state.given_up(), at_ms)

    def asked(self, want: LevelWish) -> None:
        self.state = self.state.asked(want)

    def choose(self, occasion: Occasion, at_ms: int, pose: Pose, goal: str) -> list[CoachRecord]:
        if occasion not in (*_OCCASIONS[self._preset.evaluate], "asked"):
            return []
        comprehension = self.cycle.evaluate().belief.comprehension
        assert comprehension is not None
        return [
            evaluation_record(comprehension, self.state.thresholds(self._preset), at_ms),
            *self._enter(self.cycle.adapt(self.state), at_ms),
        ]

    def _enter(self, state: LevelState, at_ms: int) -> list[CoachRecord]:
        before, self.state = self.state, state
        comprehension = self.cycle.model.belief.comprehension
        if comprehension is None or state.level is before.level:
            return []
        return [LevelChanged(at_ms, before.level, state.level, comprehension.value)]


def ana(briefing: Briefing, preset: Preset) -> Ana | AnaByBelief:
    """ANA as `preset` has it."""
    return AnaByBelief(briefing, preset) if preset.judges == "belief" else Ana(briefing, preset)
