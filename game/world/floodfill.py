"""Cost-to-go of every cell to one goal, in four-neighbour moves (paper 5.2, Algorithm 1)."""

from __future__ import annotations

from array import array
from typing import TypeAlias

from game.world.geometry import Cell
from game.world.plan import Plan

UNREACHABLE = 0xFFFF
"""The floodfill value of a wall, or of a cell from which the goal cannot be reached."""

Floodfill: TypeAlias = "array[int]"
"""Values by cell index (`Plan.index`)."""


def cost_to_go(plan: Plan, goal: Cell) -> Floodfill:
    """The floodfill D_g of `goal`: moves from each cell to it, `UNREACHABLE` where none lead."""
    values = array("H", [UNREACHABLE]) * (plan.width * plan.height)
    neighbours = plan.neighbours
    start = plan.index(goal)
    values[start] = 0
    frontier, distance = [start], 0
    while frontier:
        distance += 1
        reached = []
        for index in frontier:
            for near in neighbours[index]:
                if values[near] == UNREACHABLE:
                    values[near] = distance
                    reached.append(near)
        frontier = reached
    return values


class Floodfills:
    """The floodfills of one plan, each computed when first asked for."""

    def __init__(self, plan: Plan) -> None:
        self.plan = plan
        self._by_goal: dict[Cell, Floodfill] = {}

    def to(self, goal: Cell) -> Floodfill:
        values = self._by_goal.get(goal)
        if values is None:
            values = self._by_goal[goal] = cost_to_go(self.plan, goal)
        return values

    def distance(self, start: Cell, goal: Cell) -> int:
        """Moves from `start` to `goal`, `UNREACHABLE` if there is no way."""
        return self.to(goal)[self.plan.index(start)]
