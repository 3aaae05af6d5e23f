"""Terrain: all that follows from a plan alone and is computed once, for everybody who needs it."""

from __future__ import annotations

from game.world.floodfill import Floodfills
from game.world.plan import Plan
from game.world.sight import Sight


class Terrain:
    """What can be worked out from walls and doors: ways and views, each when first asked for.

    A building owns the terrain of its plan; missions, coaches and rescuers are handed it. It holds
    nothing that the mini-map does not show.
    """

    def __init__(self, plan: Plan) -> None:
        self.plan = plan
        self.floodfills = Floodfills(plan)
        self._sights: dict[int, Sight] = {}

    def sight(self, radius: int) -> Sight:
        """The fields of view of `radius` cells."""
        if radius not in self._sights:
            self._sights[radius] = Sight(self.plan, radius)
        return self._sights[radius]
