"""Missteps and disobedience: how well the rescuer does what the instruction says.

Pure state: the coach tells what happened, and asks what it means. Both words are defined by the
level that is shown, since only what was said can be done wrong.
"""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass, replace
from itertools import pairwise

from game.coach.acts import Level
from game.coach.instructions import Instruction, Pose, Scene
from game.world.geometry import Cell, Heading
from game.world.settings import Controls

MISSTEP_EXCESS = {Level.C1: 1, Level.C2: 3, Level.C3: 8}
"""By how many cells the cost-to-go must exceed its minimum since the instruction was issued."""

HEEDED_CELLS = 3
"""After so many cells the right way a notice has been understood."""

READING_MS = 2_000
"""How long a rescuer may take to act on a correction. At C1 each cell too far is a misstep: without
it, a key held for a second would be disobedience five times over."""

STRICT_LEVELS = frozenset({Level.C1, Level.C2})
"""The levels at which a misstep that follows another is disobedience: what they say can be done
by anybody, whereas C3 asks for knowledge."""


@dataclass(frozen=True)
class Compliance:
    """The walk since an instruction was issued at `level` (the shown one).

    `most`, `least` and `distance` are the largest cost-to-go since, the smallest and the present
    one, `rising` whether the last action raised it; `warned_ms` is when a strict misstep was
    corrected that counts, since an instruction was completed.
    """

    level: Level
    most: int
    least: int
    distance: int
    rising: bool = False
    warned_ms: int | None = None

    def issued(self, level: Level, distance: int) -> Compliance:
        """Another instruction stands on the bar."""
        return Compliance(level, distance, distance, distance, warned_ms=self.warned_ms)

    def completed(self) -> Compliance:
        return replace(self, warned_ms=None)

    def acted(self, distance: int) -> Compliance:
        """After a move, bump or turn that leaves `distance` cells to go."""
        rising = distance > self.distance
        return replace(
            self,
            most=max(self.most, distance),
            least=min(self.least, distance),
            distance=distance,
            rising=rising,
        )

    @property
    def excess(self) -> int:
        return self.distance - self.least

    @property
    def misstep(self) -> bool:
        """Whether the last action was a misstep."""
        return self.rising and self.excess >= MISSTEP_EXCESS[self.level]

    def disobeys(self, at_ms: int) -> bool:
        """Whether this misstep, at `at_ms`, is disobedience (`repeat_misstep`)."""
        strict = self.misstep and self.level in STRICT_LEVELS
        return strict and self.warned_ms is not None and at_ms - self.warned_ms >= READING_MS

    @property
    def heeded(self) -> bool:
        """Whether the rescuer clearly does what was asked: a notice may go."""
        return self.most - self.distance >= HEEDED_CELLS

    def corrected(self, at_ms: int) -> Compliance:
        """The misstep has been noted at `at_ms`. Those within `READING_MS` belong to it."""
        counts = self.warned_ms is None or self.disobeys(at_ms)
        return replace(self, warned_ms=at_ms) if counts and self.level in STRICT_LEVELS else self


NOTHING_ASKED = Compliance(Level.C3, 0, 0, 0)
"""Before the first instruction."""


def track(instruction: Instruction, controls: Controls) -> frozenset[Pose]:
    """All poses of a rescuer who is carrying `instruction` out. Turning around by the turn controls
    passes the headings between."""
    path = instruction.path
    headings = [instruction.start.heading]
    headings += [_towards(a, b) for a, b in pairwise(path)]
    headings.append(instruction.end.heading)
    poses: set[Pose] = set()
    for cell, (arriving, leaving) in zip(path, pairwise(headings), strict=True):
        poses |= {Pose(cell, arriving), Pose(cell, leaving)}
        if controls == "turn" and leaving is arriving.back:
            poses |= {Pose(cell, arriving.left), Pose(cell, arriving.right)}
    return frozenset(poses)


def reached(instruction: Instruction, pose: Pose) -> bool:
    """Whether `pose` is where an instruction without treatment ends; one that only turns ends
    with the turn."""
    if instruction.treats or pose.cell != instruction.end.cell:
        return False
    return len(instruction.path) > 1 or pose.heading is instruction.end.heading


def fits(scene: Scene, instruction: Instruction, victim: str, in_view: Collection[Cell]) -> bool:
    """Whether treating `victim` is what the words of `instruction` ask for.

    Besides those that it accepts: where a C2 instruction names a victim, any other of that
    severity that lies in the goal's room, or is treated while the goal is `in_view` too.
    """
    if victim in instruction.accepts:
        return True
    goal, treated = scene.victim(instruction.goal), scene.victim(victim)
    if not instruction.treats or instruction.shown_level is Level.C1:
        return False
    room = scene.building.room_of(goal)
    together = room is not None and scene.building.room_of(treated) is room
    return treated.severity is goal.severity and (together or goal.cell in in_view)


def _towards(start: Cell, end: Cell) -> Heading:
    return next(heading for heading in Heading if heading.from_cell(start) == end)
