"""C3: a room and a victim; the rescuer must know where the room is."""

from __future__ import annotations

from game.coach.acts import Level
from game.coach.instructions.legs import legs
from game.coach.instructions.scene import Instruction, Pose, Scene
from game.coach.instructions.vocabulary import VICTIM_AT_C3, Tuple


def compose(scene: Scene, start: Pose, goal: str) -> Instruction | None:
    """The goal's room and colour; None where the goal lies in no named room."""
    site, room = scene.victim(goal), scene.room(goal)
    if room is None:
        return None
    triage: Tuple = ("Triage", VICTIM_AT_C3[site.severity])
    inside = scene.building.room_at(start.cell) is room
    tuples = (triage,) if inside else (("Goto", room.name), triage)
    path, end = [start.cell], start
    for leg in legs(scene, start, goal):
        path += leg.cells
        end = leg.end
    alike = (
        other.id
        for other in scene.waiting.values()
        if other.severity is site.severity and scene.building.room_of(other) is room
    )
    sentences = scene.phrases.each(Level.C3, tuples)
    return Instruction(
        level=Level.C3,
        shown_level=Level.C3,
        goal=goal,
        tuples=tuples,
        sentences=sentences,
        text=scene.phrases.joined(sentences),
        start=start,
        end=end,
        path=tuple(path),
        treats=True,
        accepts=frozenset(alike),
    )
