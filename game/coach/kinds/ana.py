"""ANA: learns b^HR by goal inference and adapts its level (paper 5.2, Algorithm 1)."""

from __future__ import annotations

from typing import TYPE_CHECKING

from game.coach.acts import CoachRecord, Level, LevelChanged
from game.coach.api import Briefing
from game.coach.comprehension import (
    ComprehensionLearner,
    ThresholdInfluence,
    evaluation_record,
)
from game.coach.guide import Guide, Occasion
from game.coach.instructions import Pose
from game.coach.levels import LevelState
from game.coach.presets import Preset
from game.world.geometry import Cell

if TYPE_CHECKING:
    from game.coach.kinds.ana_by_belief import AnaByBelief

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
        self._next_choice_ms = preset.every_ms
        self._learner = ComprehensionLearner(preset, briefing.building)
        super().__init__(
            briefing, self._learner, ThresholdInfluence(preset), LevelState.first(preset)
        )

    @property
    def level(self) -> Level:
        return self.state.level

    @property
    def next_choice_ms(self) -> int | None:
        return self._next_choice_ms

    def goal_set(self, goal: str, position: Cell) -> None:
        self._learner.goal_set(goal, position)

    def goal_ended(self, at_ms: int, *, rescued: bool) -> list[CoachRecord]:
        state = self.state
        return self._enter(state.rescued(self._preset) if rescued else state.given_up(), at_ms)

    def choose(self, occasion: Occasion, at_ms: int, pose: Pose, goal: str) -> list[CoachRecord]:
        preset = self._preset
        match occasion:
            case "time" if preset.every_ms is not None:
                self._next_choice_ms = at_ms + preset.every_ms
            case "lost" if preset.lowers_when_lost:
                return self._enter(self.state.lowered(), at_ms, judged=False)
            case "misstep" if preset.lowers_when_lost and self.level is Level.C3:
                return self._enter(self.state.lowered(), at_ms, judged=False)
            case "simpler" | "shorter":
                return self._enter(self.state.asked(occasion), at_ms, judged=False)
        if occasion not in _OCCASIONS[preset.evaluate]:
            return []
        comprehension = self.cycle.evaluate().belief.comprehension
        assert comprehension is not None
        thresholds = self.state.thresholds(preset)
        return [
            evaluation_record(comprehension, thresholds, at_ms),
            *self._enter(self.cycle.adapt(self.state), at_ms),
        ]

    def _enter(self, state: LevelState, at_ms: int, *, judged: bool = True) -> list[CoachRecord]:
        before, self.state = self.state, state
        if state.level is before.level:
            return []
        comprehension = self.cycle.model.belief.comprehension if judged else None
        value = None if comprehension is None else comprehension.value
        return [LevelChanged(at_ms, before.level, state.level, value)]


def ana(briefing: Briefing, preset: Preset) -> Ana | AnaByBelief:
    """ANA as `preset` has it."""
    if preset.judges == "belief":
        from game.coach.kinds.ana_by_belief import AnaByBelief

        return AnaByBelief(briefing, preset)
    return Ana(briefing, preset)
