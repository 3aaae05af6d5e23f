"""Simulated rescuers by name, for watching."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from game.errors import AnaError, choose_from
from game.rescuers.driver import Rescuer
from game.rescuers.literal import LiteralReader
from game.rescuers.person import POPULATIONS, BoundedPerson, drawn, memorised
from game.rescuers.person.randomness import stream
from game.world.building import Building
from game.world.settings import MissionSettings

Maker = Callable[[Building, MissionSettings, int], Rescuer]

LITERAL = "literal"
SHORT_MS, LONG_MS = 60_000, 180_000
"""The memorise times of the study."""


@dataclass(frozen=True)
class Character:
    """A kind of simulated rescuer. `summary` is what is said of one; `make` takes the building, the
    rules and a seed."""

    name: str
    summary: str
    make: Maker


def _literal(building: Building, settings: MissionSettings, _seed: int) -> Rescuer:
    places = {room.name: room.label for room in building.rooms}
    return LiteralReader(settings.controls, places)


def _person(population: str, memorise_ms: int) -> Maker:
    def make(building: Building, settings: MissionSettings, seed: int) -> Rescuer:
        traits = drawn(POPULATIONS[population], seed, "traits")
        memory = memorised(building, memorise_ms, traits, stream(seed, "map", building.name))
        return BoundedPerson(traits, memory, settings.controls, stream(seed, "mission"))

    return make


RESCUERS = {
    character.name: character
    for character in (
        Character(LITERAL, "follows every word and knows every room", _literal),
        Character("person", "a person who saw the map for 3 minutes", _person("default", LONG_MS)),
        Character(
            "newcomer", "a person who saw the map for 1 minute", _person("default", SHORT_MS)
        ),
        Character("stranger", "a person who never saw the map", _person("default", 0)),
        Character("hasty", "a quick person who makes mistakes", _person("hasty", LONG_MS)),
        Character("careful", "a slow person who makes few mistakes", _person("careful", LONG_MS)),
    )
}


def character(name: str) -> Character:
    """The character of this name. Raises AnaError, with the nearest right name."""
    if name in RESCUERS:
        return RESCUERS[name]
    raise AnaError(
        f"there is no rescuer '{name}'", place="--rescuer", hint=choose_from(name, RESCUERS)
    )
