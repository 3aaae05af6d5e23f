"""Missteps, disobedience and being lost: how well the rescuer does what the instruction says.

Pure state: the coach tells what happened and when, and asks what it means. Missteps and
disobedience are defined by the level that is shown, since only what was said can be done wrong. All
times are mission milliseconds.
"""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass, replace
from itertools import pairwise

from game.coach.acts import Level
from game.coach.instructions import Instruction, Pose, Scene
from game.coach.instructions.reading import letters
from game.world.geometry import Cell, Heading
from game.world.settings import Controls

MISSTEP_EXCESS = {Level.C1: 1, Level.C2: 3, Level.C3: 8}
"""By how many cells the cost-to-go must exceed its minimum since the instruction was issued."""

HEEDED_CELLS = 3
"""After so many cells the right way a notice has been understood."""

READING_MS, READING_MS_PER_LETTER = 400, 42
"""How soon the words that say what to do next can have been read: 238 words a minute (Brysbaert,
2019, Journal of Memory and Language 109), after a reaction. Until then the rescuer still acts on
what was there before, and no step is a misstep."""

NOTICE_MS, NOTICE_MS_PER_LETTER = 2_000, 60
"""How long a notice is left to be read, at a pace that suits anybody, before another may take its
place."""

LOST_MS, MOST_LOST_MS = 10_000, 11_900
"""A rescuer who has not come any nearer for so long is lost, whether standing, pacing or going
round: the first, or as long as it takes to read the words at half the usual speed, but never more
than the second."""

STRICT_LEVELS = frozenset({Level.C1, Level.C2})
"""The levels at which a misstep that follows another is disobedience: what they say can be done
by anybody, whereas C3 asks for knowledge."""


@dataclass(frozen=True)
class Compliance:
    """The walk since an instruction was issued at `level` (the shown one).

    `most`, `least` and `distance` are the largest cost-to-go since then, the smallest and the
    present one; `rising` is whether the last action raised it other than on the way that was told,
    which happened at `at_ms`. Until `read_ms` the words cannot have been read; until `notice_ms` no
    notice may replace the last; `nearer_ms` is when the rescuer last came nearer, or was told
    something new, and `patience_ms` how long after that they are lost. `warned` is whether a strict
    misstep was corrected since an instruction was completed.
    """

    level: Level
    most: int
    least: int
    distance: int
    at_ms: int = 0
    rising: bool = False
    read_ms: int = 0
    notice_ms: int = 0
    nearer_ms: int = 0
    patience_ms: int = LOST_MS
    warned: bool = False

    def issued(
        self,
        level: Level,
        distance: int,
        at_ms: int,
        opening: str,
        rest: str = "",
        notice: str = "",
    ) -> Compliance:
        """Another instruction stands on the bar, whose `opening` says what to do next; `rest` are
        its other words."""
        read_ms = at_ms + READING_MS + READING_MS_PER_LETTER * letters(opening + notice)
        slowly_ms = 2 * (READING_MS + READING_MS_PER_LETTER * letters(opening + rest + notice))
        notice_ms = self.notice_ms
        if notice:
            notice_ms = at_ms + NOTICE_MS + NOTICE_MS_PER_LETTER * letters(notice)
        return Compliance(
            level,
            most=distance,
            least=distance,
            distance=distance,
            at_ms=at_ms,
            read_ms=read_ms,
            notice_ms=notice_ms,
            nearer_ms=at_ms,
            patience_ms=min(MOST_LOST_MS, max(LOST_MS, slowly_ms)),
            warned=self.warned,
        )

    def restated(self, level: Level, distance: int) -> Compliance:
        """The same way is told from where the rescuer stands: nothing that need be read first, and
        no progress."""
        return replace(self, level=level, most=distance, least=distance, distance=distance)

    def completed(self) -> Compliance:
        return replace(self, warned=False)

    def acted(
        self, distance: int, at_ms: int, *, nearer: bool = False, follows: bool = False
    ) -> Compliance:
        """After a move, bump or turn at `at_ms` that leaves `distance` cells to go. Even if the
        distance says otherwise, `nearer` is whether it was progress on the way that was told, and
        `follows` whether it went that way."""
        progress = nearer or distance < self.least
        return Compliance(
            self.level,
            most=max(self.most, distance),
            least=min(self.least, distance),
            distance=distance,
            at_ms=at_ms,
            rising=distance > self.distance and not follows,
            read_ms=self.read_ms,
            notice_ms=self.notice_ms,
            nearer_ms=at_ms if progress else self.nearer_ms,
            patience_ms=self.patience_ms,
            warned=self.warned,
        )

    @property
    def excess(self) -> int:
        return self.distance - self.least

    @property
    def astray(self) -> bool:
        """Whether the last action led too far away."""
        return self.rising and self.excess >= MISSTEP_EXCESS[self.level]

    @property
    def misstep(self) -> bool:
        """Whether the last action was a misstep: too far away, though the words could be read."""
        return self.astray and self.at_ms >= self.read_ms

    @property
    def may_notice(self) -> bool:
        """Whether the last notice has been there long enough to be read."""
        return self.at_ms >= self.notice_ms

    @property
    def disobeys(self) -> bool:
        """Whether this misstep is disobedience (`repeat_misstep`). Those made while a notice is
        still being read belong to the one that it is about."""
        return self.misstep and self.warned and self.may_notice and self.level in STRICT_LEVELS

    @property
    def heeded(self) -> bool:
        """Whether the rescuer clearly does what was asked: a notice may go."""
        return self.most - self.distance >= HEEDED_CELLS

    @property
    def lost_at_ms(self) -> int:
        """When the rescuer will be lost, if there is no progress until then."""
        return self.nearer_ms + self.patience_ms

    def corrected(self) -> Compliance:
        """The misstep has been noted."""
        return replace(self, warned=self.warned or self.level in STRICT_LEVELS)


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
