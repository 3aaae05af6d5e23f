"""Between levels: an instruction is made at C3 from the goal, and every lower level from the one
above it (paper 5.1.2). A transformation keeps the goal and the place; it changes the words."""

from __future__ import annotations

from dataclasses import replace

from game.coach.acts import Level
from game.coach.instructions import c1, c2, c3
from game.coach.instructions.scene import Instruction, Pose, Scene


def instruct(scene: Scene, pose: Pose, goal: str, level: Level) -> Instruction:
    """What to say at `level` to somebody at `pose` who is to rescue victim `goal`.

    Raises ValueError when no such victim waits, or no way leads there.
    """
    instruction = _compose(scene, pose, goal, Level.C3)
    while instruction.level > level:
        instruction = lower(scene, instruction)
    return instruction


def lower(scene: Scene, instruction: Instruction) -> Instruction:
    """The same goal from the same place, one level less abstract. Raises ValueError at C1."""
    if instruction.level is Level.C1:
        raise ValueError("C1 is the lowest level")
    return _compose(scene, instruction.start, instruction.goal, Level(instruction.level - 1))


def _compose(scene: Scene, pose: Pose, goal: str, level: Level) -> Instruction:
    """The instruction of `level`, or of the highest level below it that exists here."""
    if level is Level.C1:
        return c1.compose(scene, pose, goal)
    compose = c2.compose if level is Level.C2 else c3.compose
    composed = compose(scene, pose, goal)
    if composed is not None:
        return composed
    return replace(_compose(scene, pose, goal, Level(level - 1)), level=level)
