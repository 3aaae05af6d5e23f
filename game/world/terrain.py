"""Terrain: all that follows from a plan alone and is computed once, for everybody who needs it."""

from __future__ import annotations

from collections.abc import Callable, Hashable
from functools import lru_cache
from typing import Any, TypeVar

from game.world.floodfill import Floodfills
from game.world.plan import Plan
from game.world.sight import Sight

Made = TypeVar("Made")

PLANS_KEPT = 8
"""The terrains of so many plans are kept: a study has three, and practice one plan for all legs."""

MOST_SHARED = 16
"""So much of what is shared over one terrain is kept, by when it was last asked for."""


class Terrain:
    """What can be worked out from walls and doors: ways and views, each when first asked for.

    Buildings of one plan have one terrain; missions, coaches and rescuers are handed it. It holds
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
        made: Made = self._shared.pop(key) if key in self._shared else make()
        self._shared[key] = made
        if len(self._shared) > MOST_SHARED:
            del self._shared[next(iter(self._shared))]
        return made


@lru_cache(maxsize=PLANS_KEPT)
def terrain_of(plan: Plan) -> Terrain:
    """The one terrain of a plan, and of all that equal it."""
    return Terrain(plan)
