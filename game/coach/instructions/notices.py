"""What to tell somebody who went astray, before telling them the way from where they stand now."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise

from game.coach.acts import Level
from game.coach.instructions.phrasebook import NoticeName
from game.coach.instructions.scene import Instruction, Pose, Scene
from game.world.geometry import Cell, Heading
from game.world.plan import Plan


def correction(scene: Scene, instruction: Instruction, pose: Pose) -> NoticeName | None:
    """What went wrong since `instruction` was given, as far as `pose` shows it; None where it
    shows nothing.

    Somebody who was told the way (C1, C2) and stands straight beyond the end of one of its legs has
    gone too far, or at C2 has passed the door that the way turns into there. Somebody who is off
    the way and farther from the goal than at its start has gone the wrong way.
    """
    path = instruction.path
    if pose.cell in path:
        return None
    plan = scene.building.plan
    distances = scene.descent(pose, instruction.goal)
    here = distances[plan.index(pose.cell)]
    told = () if instruction.shown_level is Level.C3 else _leg_ends(path)
    for at, heading in told:
        if here > distances[plan.index(path[at])] and _lies_ahead(
            plan, path[at], heading, pose.cell
        ):
            counts_doors = instruction.shown_level is Level.C2
            passed_door = counts_doors and _begins_with_door(plan, path[at:])
            return "passed_door" if passed_door else "too_far"
    return "wrong_way" if here > distances[plan.index(path[0])] else None


def _leg_ends(path: tuple[Cell, ...]) -> Iterator[tuple[int, Heading]]:
    """Where on the path a straight run ends, and which way it led."""
    headings = [_heading(before, after) for before, after in pairwise(path)]
    for at, heading in enumerate(headings, start=1):
        if at == len(headings) or headings[at] is not heading:
            yield at, heading


def _heading(before: Cell, after: Cell) -> Heading:
    return next(heading for heading in Heading if heading.from_cell(before) == after)


def _lies_ahead(plan: Plan, start: Cell, heading: Heading, target: Cell) -> bool:
    """Whether walking straight on from `start` leads to `target`."""
    cell = heading.from_cell(start)
    while plan.walkable(cell):
        if cell == target:
            return True
        cell = heading.from_cell(cell)
    return False


def _begins_with_door(plan: Plan, onward: tuple[Cell, ...]) -> bool:
    """Whether the first leg of what remains leads into a door."""
    end = next((at for at, _ in _leg_ends(onward)), 0)
    return any(plan.is_door(cell) for cell in onward[1 : end + 1])
