"""Terrain: all that follows from a plan alone and is computed once, for everybody who needs it."""

from __future__ import annotations

from collections.abc import Callable, Hashable
from typing import Any, TypeVar

from game.world.floodfill import Floodfills
from game.world.plan import Plan
from game.world.sight import Sight

Made = TypeVar("Made")


class Terrain:
    """What can be worked out from walls and doors: ways and views, each when first asked for.

    A building owns the terrain of its plan; missions, coaches and rescuers are handed it. It holds
    nothing that the mini-map does not show.
    """

    def __init__(self, plan: Plan) -> None:
        self.plan = plan
        self.floodfills = Floodfills(plan)
        self._sights: dict[int, Sight] = {}
        self._shared: dict[Hashable, Any] = {}

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Terrain) and self.plan == other.plan

    def __hash__(self) -> int:
        return hash(self.plan)

    def sight(self, radius: int) -> Sight:
        """The fields of view of `radius` cells."""
        if radius not in self._sights:
            self._sights[radius] = Sight(self.plan, radius)
        return self._sights[radius]

    def shared(self, key: Hashable, make: Callable[[], Made]) -> Made:
        """What `make` gives, made once and kept: for rooms that work out more from the terrain,
        as a coach does with its landmarks. `key` must name all that the result depends on."""
        made: Made
        if key not in self._shared:
            self._shared[key] = make()
        made = self._shared[key]
        return made
