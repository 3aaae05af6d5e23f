"""What to tell somebody who went astray, before telling them the way from where they stand now."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise

from game.coach.instructions.scene import Instruction, Pose, Scene
from game.coach.records import Level
from game.world.geometry import Cell, Heading
from game.world.plan import Plan

PASSED_DOOR = "You have passed the door."
TOO_FAR = "You have gone too far."
WRONG_WAY = "That is the wrong way."


def correction(scene: Scene, instruction: Instruction, pose: Pose) -> str:
    """What went wrong since `instruction` was given, as far as `pose` shows it; empty where it
    shows nothing.

    Somebody who stands straight beyond the end of one of the path's legs has gone too far, or at C2
    has passed the door that the path turns into there. Somebody who is off the path and farther
    from the goal than when the instruction was given has gone the wrong way.
    """
    if pose.cell in instruction.path:
        return ""
    plan = scene.building.plan
    distances = scene.descent(pose, instruction.goal)
    here = distances[plan.index(pose.cell)]
    for at, heading in _leg_ends(instruction.path):
        end = instruction.path[at]
        if here > distances[plan.index(end)] and _lies_ahead(plan, end, heading, pose.cell):
            at_door = instruction.shown_level is Level.C2 and _next_is_door(
                plan, instruction.path[at:]
            )
            return PASSED_DOOR if at_door else TOO_FAR
    return WRONG_WAY if here > distances[plan.index(instruction.start.cell)] else ""


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


def _next_is_door(plan: Plan, onward: tuple[Cell, ...]) -> bool:
    """Whether the path's next leg leads into a door."""
    end = next((at for at, _ in _leg_ends(onward)), 0)
    return any(plan.is_door(cell) for cell in onward[1 : end + 1])
