"""C1: steps and turns relative to the heading; nothing about the building need be known."""

from __future__ import annotations

from itertools import islice

from game.coach.acts import Level
from game.coach.instructions.legs import legs, treats
from game.coach.instructions.scene import Instruction, Pose, Scene
from game.coach.instructions.text import render
from game.coach.instructions.vocabulary import Tuple, Tuples

MOST_LEGS = 3
"""How many straight runs one instruction holds."""

TURNS: tuple[Tuples, ...] = ((), (("Turn", "Right"),), (("Turn", "Around"),), (("Turn", "Left"),))
"""How to say a turn of so many quarters to the right."""

STOP: Tuple = ("Stop", "0 Steps")
UTILIZE: Tuple = ("Utilize", "MedicalEquipment")


def compose(scene: Scene, start: Pose, goal: str) -> Instruction:
    """The next legs of the shortest way, and the treatment where they reach the goal."""
    tuples: list[Tuple] = []
    path = [start.cell]
    pose = start
    for leg in islice(legs(scene, start, goal), MOST_LEGS):
        tuples += TURNS[(leg.heading - pose.heading) % 4]
        tuples.append(("Walkforward", f"{len(leg.cells)} Steps"))
        path += leg.cells
        pose = leg.end
    arrived = treats(scene, pose, goal)
    if arrived:
        tuples += [UTILIZE] if tuples else [STOP, UTILIZE]
    return Instruction(
        level=Level.C1,
        shown_level=Level.C1,
        goal=goal,
        tuples=tuple(tuples),
        text=render(Level.C1, tuple(tuples)),
        start=start,
        end=pose,
        path=tuple(path),
        treats=arrived,
        accepts=frozenset({goal}),
    )
