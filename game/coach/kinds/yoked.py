"""`yoked`: repeats the levels of somebody else's mission, the control for mere switching (5.5)."""

from __future__ import annotations

from game.coach.acts import CoachRecord, Level, LevelChanged
from game.coach.api import Briefing
from game.coach.guide import Guide, Occasion
from game.coach.instructions import Pose
from game.coach.kinds.static import NoInfluence, NoLearning
from game.coach.yoke import Yoke
from game.errors import AnaError


class YokedCoach(Guide[Level]):
    """Speaks at each moment at the level that was in force then, whatever this rescuer does; a
    change takes effect with the rescuer's next step.

    Raises AnaError where the levels are of another building.
    """

    def __init__(self, briefing: Briefing, yoke: Yoke) -> None:
        if yoke.building_sha256 != briefing.building.hash:
            raise AnaError(
                "the levels are those of a mission in another building",
                place=f"session {yoke.session}",
                hint="Play in the building in which that mission was played.",
            )
        super().__init__(briefing, NoLearning(), NoInfluence(), yoke.level_at(0))
        self._yoke = yoke

    @property
    def level(self) -> Level:
        return self.state

    def choose(self, occasion: Occasion, at_ms: int, pose: Pose, goal: str) -> list[CoachRecord]:
        before, self.state = self.state, self._yoke.level_at(at_ms)
        return [] if self.state is before else [LevelChanged(at_ms, before, self.state)]
