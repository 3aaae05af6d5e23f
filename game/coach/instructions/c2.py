"""C2: doors, intersections, hallways and rooms as the walker meets them, and no names.

Of the best way through the graph of what C2 can say, the first tuples are shown.
"""

from __future__ import annotations

from game.coach.acts import Level
from game.coach.instructions.legs import legs
from game.coach.instructions.scene import Instruction, Pose, Scene
from game.coach.instructions.vocabulary import Tuple
from game.coach.instructions.ways import MOST_DETOUR, ways_in
from game.world.geometry import Cell

MOST_TUPLES = 3
"""How many tuples one instruction holds."""


def compose(scene: Scene, start: Pose, goal: str) -> Instruction | None:
    """The first stages of the best way; None where no way can be told at this level."""
    scene.descent(start, goal)
    plan = scene.building.plan
    known = ways_in(scene)
    ways = known.to(scene, goal)
    tuples: list[Tuple] = []
    path = [start.cell]
    pose, detour, treats = start, 0, False
    while not treats:
        here = plan.index(pose.cell)
        stage = ways.stage(here, pose.heading)
        detour += ways.detour(here, stage.move)
        fits = len(tuples) + len(stage.said) <= MOST_TUPLES and detour <= MOST_DETOUR
        if not stage.said or not fits:
            break
        tuples += stage.said
        if stage.move is None:
            onward, pose = _approach(scene, pose, goal)
            treats = True
        else:
            onward = [plan.cell(index) for index in known.landmarks.path(here, stage.move)]
            pose = Pose(onward[-1], stage.move.heading)
        path += onward
    if not tuples:
        return None
    sentences = scene.phrases.each(Level.C2, tuple(tuples))
    return Instruction(
        level=Level.C2,
        shown_level=Level.C2,
        goal=goal,
        tuples=tuple(tuples),
        sentences=sentences,
        text=scene.phrases.joined(sentences),
        start=start,
        end=pose,
        path=tuple(path),
        treats=treats,
        accepts=frozenset({goal}),
    )


def _approach(scene: Scene, pose: Pose, goal: str) -> tuple[list[Cell], Pose]:
    """A shortest way to where triage treats the goal: the cells after `pose`, and the last pose."""
    cells: list[Cell] = []
    for leg in legs(scene, pose, goal):
        cells += leg.cells
        pose = leg.end
    return cells, pose
