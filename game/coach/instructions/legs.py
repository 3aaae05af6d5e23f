"""The shortest way to a goal, as straight legs down its floodfill."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

from game.coach.instructions.scene import Pose, Scene
from game.world.geometry import Cell, Heading

BY_EFFORT = {heading: (heading, heading.right, heading.left, heading.back) for heading in Heading}
"""For each heading all four, the ones that need the least turning first."""


class Leg(NamedTuple):
    """Some steps straight ahead, over `cells` (without the one they start from)."""

    heading: Heading
    cells: tuple[Cell, ...]

    @property
    def end(self) -> Pose:
        return Pose(self.cells[-1], self.heading)


def legs(scene: Scene, pose: Pose, goal: str) -> Iterator[Leg]:
    """The legs from `pose` to where triage would treat `goal`, each step one cell nearer.

    Each leg is the longest straight run there is; of equal ones the one that needs no turn, then
    right, left and around. Raises ValueError when no way leads there.
    """
    distances = scene.descent(pose, goal)
    index = scene.building.plan.index

    def run(start: Cell, heading: Heading) -> Leg:
        cells: list[Cell] = []
        to_go = distances[index(start)] - 1
        cell = heading.from_cell(start)
        while distances[index(cell)] == to_go:
            cells.append(cell)
            if to_go <= 1 and treats(scene, Pose(cell, heading), goal):
                break
            cell = heading.from_cell(cell)
            to_go -= 1
        return Leg(heading, tuple(cells))

    while not treats(scene, pose, goal):
        runs = [run(pose.cell, heading) for heading in BY_EFFORT[pose.heading]]
        leg = max(runs, key=lambda leg: len(leg.cells))
        yield leg
        pose = leg.end


def treats(scene: Scene, pose: Pose, goal: str) -> bool:
    """Whether triage at `pose` would treat `goal` and nobody else."""
    site = scene.treated_at(pose)
    return site is not None and site.id == goal
