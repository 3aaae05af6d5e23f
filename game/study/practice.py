"""Practice: short guided legs in the practice building, two at each level, without adaptation.

Each leg leads to one victim from where the leg before ended, so no leg can be missed; the kinds
of instruction come in an order of chance, each explained before its legs (design 7).
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
"""Long enough never to press anyone."""


@dataclass(frozen=True)
class Leg:
    """One victim to be found. `opens_kind` tells that its level is new."""

    number: int
    level: Level
    victim: VictimSite
    opens_kind: bool

    @property
    def spec(self) -> CoachSpec:
        return CoachSpec("static", level=self.level)


def legs(building: Building, seed: int) -> tuple[Leg, ...]:
    """The legs of a participant's practice; victims come round again where there are too few."""
    levels = shuffled(Level, lambda level: level.name, seed, "practice levels")
    victims = shuffled(building.victims, lambda victim: victim.id, seed, "practice victims")
    return tuple(
        Leg(
            number,
            levels[number // LEGS_PER_LEVEL],
            victims[number % len(victims)],
            opens_kind=number % LEGS_PER_LEVEL == 0,
        )
        for number in range(LEGS)
    )


def leg_building(building: Building, leg: Leg, start: Cell, heading: Heading) -> Building:
    """The practice building with the leg's victim alone, entered at `start`."""
    victim = replace(leg.victim, id="v01")
    return with_own_text(replace(building, victims=(victim,), start=start, start_heading=heading))


def leg_start(
    building: Building, before: Sequence[Leg], stand: tuple[Cell, Heading] | None
) -> tuple[Cell, Heading]:
    """Where a leg begins: where the rescuer stands, if that is known and is floor, else at the
    victim treated last, else at the building's entrance."""
    if stand is not None and building.plan.tile(stand[0]) is Tile.FLOOR:
        return stand
    if before:
        return before[-1].victim.cell, building.start_heading
    return building.start, building.start_heading


def leg_settings(mission: MissionSettings) -> MissionSettings:
    """The study's rules without their haste."""
    return replace(mission, duration_ms=LEG_MS, red_expiry_ms=LEG_MS)
