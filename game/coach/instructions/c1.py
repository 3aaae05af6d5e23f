"""C1: steps and turns relative to the heading; nothing about the building need be known."""

from __future__ import annotations

from itertools import islice

from game.coach.acts import Level
from game.coach.instructions.legs import Leg, legs, treats
from game.coach.instructions.scene import Instruction, Pose, Scene
from game.coach.instructions.vocabulary import MOST_STEPS, Tuple, Tuples
from game.world.geometry import Cell

MOST_LEGS = 3
"""How many straight runs one instruction holds."""

TURNS: tuple[Tuples, ...] = ((), (("Turn", "Right"),), (("Turn", "Around"),), (("Turn", "Left"),))
"""How to say a turn of so many quarters to the right."""

STOP: Tuple = ("Stop", "0 Steps")
UTILIZE: Tuple = ("Utilize", "MedicalEquipment")


def _run(scene: Scene, start: Cell, leg: Leg) -> tuple[tuple[Cell, ...], Tuple]:
    """The cells of a straight run from `start`, and how to say it. One that is too long to be
    counted is told by the wall or the door that ends it; where none does, as far as can be counted.
    """
    cells, plan = leg.cells, scene.building.plan
    if len(cells) <= MOST_STEPS:
        return cells, ("Walkforward", f"{len(cells)} Steps")
    if not plan.walkable(leg.heading.from_cell(cells[-1])):
        return cells, ("Walkforward", "Wall")
    first_door = next((n for n, cell in enumerate(cells) if plan.is_door(cell)), None)
    if first_door is not None and first_door >= MOST_STEPS and not plan.is_door(start):
        return cells[: first_door + 1], ("Walkforward", "Door")
    return cells[:MOST_STEPS], ("Walkforward", f"{MOST_STEPS} Steps")


def compose(scene: Scene, start: Pose, goal: str) -> Instruction:
    """The next legs of the shortest way, and the treatment where they reach the goal."""
    tuples: list[Tuple] = []
    path = [start.cell]
    pose = start
    for leg in islice(legs(scene, start, goal), MOST_LEGS):
        tuples += TURNS[(leg.heading - pose.heading) % 4]
        cells, said = _run(scene, pose.cell, leg)
        tuples.append(said)
        path += cells
        pose = Pose(cells[-1], leg.heading)
        if len(cells) < len(leg.cells):
            break
    arrived = treats(scene, pose, goal)
    if arrived:
        tuples += [UTILIZE] if tuples else [STOP, UTILIZE]
    sentences = scene.phrases.each(Level.C1, tuple(tuples))
    return Instruction(
        level=Level.C1,
        shown_level=Level.C1,
        goal=goal,
        tuples=tuple(tuples),
        sentences=sentences,
        text=scene.phrases.joined(sentences),
        start=start,
        end=pose,
        path=tuple(path),
        treats=arrived,
        accepts=frozenset({goal}),
    )
