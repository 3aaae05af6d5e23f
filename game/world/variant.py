"""How a mission of free play differs from the building as drawn: whose victims, and how hard."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, replace
from datetime import UTC, datetime
from random import Random
from typing import Literal, NamedTuple

from game.world.building import Building, Severity
from game.world.placing import Lying, placed_anew, spots_of, with_victims
from game.world.settings import MissionSettings

Victims = Literal["drawn", "seeded"]
Difficulty = Literal["easy", "standard", "hard"]


class Demands(NamedTuple):
    """What a difficulty asks: people in percent of those drawn, time, and how far one sees."""

    people: int
    duration_ms: int
    sight_radius: int


DEMANDS: dict[Difficulty, Demands] = {
    "easy": Demands(people=75, duration_ms=300_000, sight_radius=7),
    "standard": Demands(people=100, duration_ms=240_000, sight_radius=5),
    "hard": Demands(people=125, duration_ms=210_000, sight_radius=4),
}


@dataclass(frozen=True)
class Variant:
    """`victims` says whether they lie as drawn or where the mission's seed puts them."""

    victims: Victims = "drawn"
    difficulty: Difficulty = "standard"

    def of_seed(self, seed: int) -> str:
        """What is unusual, in a few words: `victims of seed 7, hard`; empty where nothing is."""
        words = [f"victims of seed {seed}"] if self.victims == "seeded" else []
        if self.difficulty != "standard":
            words.append(self.difficulty)
        return ", ".join(words)


USUAL = Variant()


def day_seed(now: datetime) -> int:
    """The seed of the mission of the day: 20261126 on 26 November 2026 (UTC)."""
    return int(f"{now.astimezone(UTC):%Y%m%d}")


def varied(building: Building, variant: Variant, seed: int) -> Building:
    """The building with its victims placed anew, and with fewer or more of them, as asked."""
    if variant.victims == "seeded":
        building = placed_anew(building, seed)
    percent = DEMANDS[variant.difficulty].people
    return building if percent == 100 else _peopled(building, percent, seed)


def with_demands(settings: MissionSettings, difficulty: Difficulty) -> MissionSettings:
    """The settings with the time and the sight of a difficulty."""
    demands = DEMANDS[difficulty]
    return replace(settings, duration_ms=demands.duration_ms, sight_radius=demands.sight_radius)


def _peopled(building: Building, percent: int, seed: int) -> Building:
    """The building with so many percent of its victims of either kind: some left out, or some more
    in the rooms that have fewest."""
    random = Random(f"variant/people/{seed}")
    lying: list[tuple[tuple[int, int], Severity]] = []
    wanted: dict[Severity, int] = {}
    for severity in Severity:
        kind = [victim for victim in building.victims if victim.severity is severity]
        wanted[severity] = round(len(kind) * percent / 100)
        kept = random.sample(kind, min(len(kind), wanted[severity]))
        lying += [(victim.cell, severity) for victim in kept]
    more = [
        severity
        for severity in Severity
        for _ in range(wanted[severity] - sum(kind is severity for _, kind in lying))
    ]
    return with_victims(building, (*lying, *_added(building, tuple(lying), more, random)))


def _added(building: Building, lying: Lying, more: list[Severity], random: Random) -> Lying:
    """Places for `more` victims, in the rooms that have fewest; no more than there is space for."""
    here = {cell for cell, _ in lying}
    count = Counter(building.room_at(cell) for cell in here)
    start = building.room_at(building.start)
    rooms = [room for room in building.rooms if room is not start]
    random.shuffle(rooms)
    added: list[tuple[tuple[int, int], Severity]] = []
    for severity in more:
        for room in sorted(rooms, key=count.__getitem__):
            free = [cell for cell in spots_of(room, building, 4, random) if cell not in here]
            if free:
                added.append((free[0], severity))
                here.add(free[0])
                count[room] += 1
                break
    return tuple(added)
