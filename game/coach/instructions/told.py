"""The way that an instruction tells: by it, and not by the shortest one, a walk is judged."""

from __future__ import annotations

from itertools import pairwise

from game.coach.acts import Level
from game.coach.instructions.scene import Instruction, Scene
from game.world.geometry import Cell


class ToldWay:
    """What counts as going the way that `instruction` tells.

    At C1 and C2 that is the instruction's own path, which may take a detour for the sake of words.
    C3 names a room: every step nearer to its label counts, and every step inside the room, where
    the victim has to be looked for.
    """

    def __init__(self, scene: Scene, instruction: Instruction) -> None:
        self._steps = frozenset(pairwise(instruction.path))
        self._left = {cell: left for left, cell in enumerate(reversed(instruction.path))}
        room = scene.room(instruction.goal)
        names_room = instruction.shown_level is Level.C3 and room is not None
        self._room = room if names_room else None
        self._index = scene.building.plan.index
        self._room_at = scene.building.room_at
        self._to_label = scene.floodfills.to(room.label) if room and names_room else None

    def follows(self, start: Cell, end: Cell) -> bool:
        """Whether the step from `start` to `end` goes the way that was told."""
        if (start, end) in self._steps:
            return True
        if self._to_label is None:
            return False
        nearer = self._to_label[self._index(end)] < self._to_label[self._index(start)]
        return nearer or self._room_at(end) is self._room

    def left(self, cell: Cell) -> int | None:
        """How many steps of the way are left at `cell`: of the path, or to the label of the room
        that was named; None off the path."""
        if self._to_label is not None:
            return self._to_label[self._index(cell)]
        return self._left.get(cell)

    def searches(self, cell: Cell) -> bool:
        """Whether the victim has to be looked for at `cell`."""
        return self._room is not None and self._room_at(cell) is self._room
