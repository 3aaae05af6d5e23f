"""Practice: short guided legs in the practice building, two at each level, without adaptation.

Each leg leads to one victim from where the previous leg ended, so no leg can be missed. The kinds
of instruction come in random order, each explained before its legs.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from game.coach.acts import Level
from game.coach.spec import CoachSpec
from game.study.chance import shuffled
from game.world.building import Building, VictimSite
from game.world.geometry import Cell, Heading
from game.world.plan import Tile
from game.world.settings import MissionSettings
from game.world.writing import with_own_text

LEGS_PER_LEVEL = 2
LEGS = LEGS_PER_LEVEL * len(Level)
LEG_MS = 600_000
"""Long enough that nobody is under time pressure."""


@dataclass(frozen=True)
class PracticeLeg:
    """One victim to find. `opens_kind` means that this leg is the first of its level."""

    number: int
    level: Level
    victim: VictimSite
    opens_kind: bool

    @property
    def spec(self) -> CoachSpec:
        return CoachSpec("static", level=self.level)


def practice_legs(building: Building, seed: int) -> tuple[PracticeLeg, ...]:
    """The legs of a participant's practice; victims are used again if there are too few."""
    levels = shuffled(Level, lambda level: level.name, seed, "practice levels")
    victims = shuffled(building.victims, lambda victim: victim.id, seed, "practice victims")
    return tuple(
        PracticeLeg(
            number,
            levels[number // LEGS_PER_LEVEL],
            victims[number % len(victims)],
            opens_kind=number % LEGS_PER_LEVEL == 0,
        )
        for number in range(LEGS)
    )


def leg_building(building: Building, leg: PracticeLeg, start: Cell, heading: Heading) -> Building:
    """The practice building with only the leg's victim, entered at `start`."""
    victim = replace(leg.victim, id="v01")
    return with_own_text(replace(building, victims=(victim,), start=start, start_heading=heading))


def leg_start(
    building: Building, before: Sequence[PracticeLeg], stand: tuple[Cell, Heading] | None
) -> tuple[Cell, Heading]:
    """Where a leg begins: where the rescuer stands, if that is known and is floor; else at the
    last treated victim; else at the building's entrance."""
    if stand is not None and building.plan.tile(stand[0]) is Tile.FLOOR:
        return stand
    if before:
        return before[-1].victim.cell, building.start_heading
    return building.start, building.start_heading


def leg_settings(mission: MissionSettings) -> MissionSettings:
    """The study's rules without time pressure."""
    return replace(mission, duration_ms=LEG_MS, red_expiry_ms=LEG_MS)
