"""How hard the shipped missions are: `python -m tests.bench.difficulty`.

A perfect follower, a well-prepared person (who knows every room) and an unprepared one (who knows
none) with the same instructor, in both buildings: rescues of 20, mean and 95% interval of the mean.
Nothing here passes or fails; the parameters are in `game.rescuers.person.parameters`.
"""

from __future__ import annotations

from collections.abc import Callable
from math import sqrt
from statistics import mean, stdev

import click

from game.coach.spec import CoachSpec, parse_coach
from game.rescuers.driver import Rescuer, drive
from game.rescuers.literal import LiteralReader
from game.rescuers.person import POPULATIONS, BoundedPerson, MapMemory, drawn
from game.rescuers.person.memory import nothing_memorised
from game.rescuers.person.randomness import stream
from game.session.playing import start_in_memory
from game.world import load_building
from game.world.building import Building
from game.world.settings import MissionSettings

BUILDINGS = ("harbour", "foundry")
SETTINGS = MissionSettings()
LEVELS = (1, 2, 3)

Maker = Callable[[Building, int], Rescuer]


def everything_memorised(building: Building) -> MapMemory:
    """Knows the place of every room."""
    places = {room.label: room.name for room in building.rooms}
    return MapMemory(tuple(places), places, {})


def follower(building: Building, _seed: int) -> Rescuer:
    """Who does every word at once and without error."""
    return LiteralReader(SETTINGS.controls, {room.name: room.label for room in building.rooms})


def person(population: str, know: Callable[[Building], MapMemory]) -> Maker:
    """Somebody of a population who knows so much of the map."""

    def make(building: Building, seed: int) -> Rescuer:
        traits = drawn(POPULATIONS[population], seed, "difficulty")
        return BoundedPerson(traits, know(building), SETTINGS.controls, stream(seed, building.name))

    return make


def rescues(building: Building, spec: CoachSpec, make: Maker, people: int) -> list[int]:
    """Of so many people, one mission each."""
    counts = []
    for seed in range(people):
        run, _ = start_in_memory(building, SETTINGS, spec, seed, rescuer="difficulty")
        drive(run, make(building, seed))
        counts.append(run.mission.rescued)
    return counts


@click.command()
@click.option("--people", default=40, show_default=True, type=click.IntRange(2))
@click.option("--population", default="default", show_default=True)
def difficulty(people: int, population: str) -> None:
    """Print rescues by building, level and preparation."""
    makers = {
        "perfect follower": follower,
        "knows all rooms": person(population, everything_memorised),
        "knows no room": person(population, nothing_memorised),
    }
    for name in BUILDINGS:
        building = load_building(name)
        for who, make in makers.items():
            told = []
            for level in LEVELS:
                counts = rescues(building, parse_coach("static", level), make, people)
                margin = 1.96 * stdev(counts) / sqrt(people)
                told.append(f"C{level} {mean(counts):5.1f} \N{PLUS-MINUS SIGN} {margin:.1f}")
            click.echo(f"{name:8} {who:17} " + "   ".join(told))


if __name__ == "__main__":
    difficulty()
