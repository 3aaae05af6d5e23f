"""The preset `belief`: the paper's thresholds applied to b^HR itself, not to its proxy."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

from game.coach.acts import ChoiceReason, CoachRecord, Level, LevelChanged
from game.coach.api import Briefing
from game.coach.cycle import Alpha
from game.coach.guide import Guide, Occasion
from game.coach.instructions import Pose
from game.coach.kinds.knowledge import DecisionPoint, LevelChoice, hopeful, judged
from game.coach.knowledge.assumed import ASSUMED, Assumed
from game.coach.knowledge.learner import KnowledgeLearner
from game.coach.levels import granted, thresholds, verdict
from game.coach.model import Component, HumanModel
from game.coach.presets import Preset
from game.world.geometry import Cell

_OCCASIONS: Mapping[Occasion, ChoiceReason] = {
    "goal": "soonest",
    "lost": "lost",
    "simpler": "asked",
    "shorter": "asked",
}
"""When it chooses, and what the journal gives as the reason."""
_LEVELS: Mapping[str, Level] = {"lower": Level.C1, "keep": Level.C2, "raise": Level.C3}


@dataclass(frozen=True)
class BeliefThresholds:
    """C1 while P(the goal's room is known) is below the lower threshold, C3 above the upper one, C2
    between; what is uncertain is given a bonus, since only C3 tells. Where the goal lies in no room
    the level stays."""

    preset: Preset
    assumed: Assumed

    def act(self, state: LevelChoice, model: HumanModel, alpha: Alpha) -> LevelChoice:
        known, point = model.belief.known, state.point
        if Component.BELIEF not in alpha or known is None or point is None:
            return state
        room = point.scene.room(point.goal)
        if room is None:
            return state
        chance = known.by_room[room.name]
        if point.occasion == "goal":
            chance = hopeful(chance, known.share_sd, self.assumed.belief_optimism)
        said = verdict(chance, *thresholds(self.preset, state.preference))
        level = _LEVELS[said]
        if point.occasion == "simpler" or point.occasion == "shorter":
            level = granted(point.occasion, state.level, level)
        return replace(state, level=level)


class AnaByBelief(Guide[LevelChoice]):
    """Chooses the level of each goal, and again for a rescuer who is lost or asks for other words,
    by what `knowledge` learns."""

    def __init__(self, briefing: Briefing, preset: Preset) -> None:
        self._learner = KnowledgeLearner(briefing, ASSUMED)
        influence = BeliefThresholds(preset, ASSUMED)
        super().__init__(briefing, self._learner, influence, LevelChoice(preset.first_level))

    @property
    def level(self) -> Level:
        return self.state.level

    def goal_set(self, goal: str, position: Cell) -> None:
        self._learner.goal_given_up()

    def choose(self, occasion: Occasion, at_ms: int, pose: Pose, goal: str) -> list[CoachRecord]:
        if occasion not in _OCCASIONS:
            return []
        match occasion:
            case "lost" if self.bar.shown is not None:
                self._learner.lost(self.bar.shown)
            case "simpler" | "shorter":
                self._learner.asked(occasion)
                self.state = self.state.asked(occasion)
        before, model = self.level, self.cycle.evaluate()
        point = DecisionPoint(occasion, self.lead.scene, pose, goal)
        self.state = self.cycle.adapt(replace(self.state, point=point, why=_OCCASIONS[occasion]))
        records: list[CoachRecord] = [judged(at_ms, self.state, model)]
        if self.level is not before and self.bar.shown is not None:
            records.append(LevelChanged(at_ms, before, self.level))
        return records
