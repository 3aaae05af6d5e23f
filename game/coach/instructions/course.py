"""A course: the whole chain of instructions that leads to a goal."""

from __future__ import annotations

from game.coach.acts import Level
from game.coach.instructions.scene import Instruction, Pose, Scene
from game.coach.instructions.transformation import instruct

MOST_INSTRUCTIONS = 60
"""No course on any building is as long; a chain that is, does not lead anywhere."""


def course(scene: Scene, pose: Pose, goal: str, level: Level) -> tuple[Instruction, ...]:
    """All that is said at `level` to a rescuer at `pose` who carries out each instruction in turn,
    up to the treatment of `goal`; each has its words (`text`, `tuples`) and its moves (`path`).

    Raises ValueError when no such victim waits, when no way leads there, or when the chain does not
    end.
    """
    said: list[Instruction] = []
    while not (said and said[-1].treats):
        if len(said) == MOST_INSTRUCTIONS:
            raise ValueError(f"the instructions at {level.name} do not lead to victim {goal}")
        said.append(instruct(scene, said[-1].end if said else pose, goal, level))
    return tuple(said)
