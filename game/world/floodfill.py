"""Cost-to-go of every cell to one goal, in four-neighbour moves (paper 5.2, Algorithm 1)."""

from __future__ import annotations

import sys
from array import array
from typing import TypeAlias

from game.world.geometry import Cell
from game.world.plan import Plan

UNREACHABLE = 0xFFFF
"""The floodfill value of a wall, or of a cell from which the goal cannot be reached."""

Floodfill: TypeAlias = "array[int]"
"""Values by cell index (`Plan.index`)."""

_BYTE = 8


def cost_to_go(plan: Plan, goal: Cell) -> Floodfill:
    """The floodfill D_g of `goal`: moves from each cell to it, `UNREACHABLE` where none lead.

    The cells at one distance are a mask, from which those one step farther follow at once. Binary
    digit d of all distances together is a mask too: `digits[d]`.
    """
    unseen = plan.walkable_mask
    frontier = plan.bit(goal)
    digits = [0] * (2 * _BYTE)
    distance = 0
    while frontier:
        unseen &= ~frontier
        for digit in range(distance.bit_length()):
            if distance >> digit & 1:
                digits[digit] |= frontier
        frontier = plan.around(frontier) & unseen
        distance += 1
    size = len(plan.tiles)
    never = (1 << size) - 1 & ~plan.walkable_mask | unseen
    return _numbers(plan, [digit | never for digit in digits])


def _numbers(plan: Plan, digits: list[int]) -> Floodfill:
    """A number of 16 bits for every cell: its binary digit d is set where `digits[d]` has it."""
    size = len(plan.tiles)
    lanes = bytearray(2 * size)
    for lane in (0, 1):
        number, before, flags = 0, -1, 0
        for place, mask in enumerate(digits[lane * _BYTE : (lane + 1) * _BYTE]):
            if mask != before:
                before, flags = mask, int.from_bytes(plan.flags(mask))
            number |= flags << place
        first = lane if sys.byteorder == "little" else 1 - lane
        lanes[first::2] = number.to_bytes(size)
    return array("H", bytes(lanes))


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
