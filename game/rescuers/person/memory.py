"""What a person knows of a building: which room is where, from the map and from walking."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from math import exp
from random import Random

from game.rescuers.person.parameters import Traits
from game.rescuers.person.randomness import normal
from game.world.building import Building
from game.world.floodfill import UNREACHABLE, Floodfills
from game.world.geometry import Cell

MINUTE_MS = 60_000
HUNCH_PULL = 1.5
"""How much farther somebody walks to a room that lies where the hunch points."""


class MapMemory:
    """Rooms as shapes on the plan (`sites`, their label cells), and which name belongs where.

    `names` holds what is believed, right or wrong; `hunches` about where a room is whose place
    is not known.
    """

    def __init__(
        self,
        sites: tuple[Cell, ...],
        names: Mapping[Cell, str],
        hunches: Mapping[str, Cell],
    ) -> None:
        self.sites = sites
        self.names = dict(names)
        self.hunches = dict(hunches)

    @property
    def knowledge(self) -> float:
        """The share of rooms whose name the person believes to know."""
        return len(self.names) / len(self.sites) if self.sites else 0.0

    def place(self, name: str) -> Cell | None:
        """Where the room of this name is, as far as the person knows."""
        return next((site for site, known in self.names.items() if known == name), None)

    def learn(self, site: Cell, name: str) -> None:
        """Take note of the name that was seen at a place; what was believed otherwise is wrong."""
        if self.names.get(site) == name:
            return
        self.names = {at: known for at, known in self.names.items() if known != name}
        self.names[site] = name

    def nearest(self, ways: Floodfills, here: Cell, sites: Collection[Cell]) -> Cell | None:
        """The room of some that is nearest; None where there is none that can be reached."""
        near = [(ways.distance(here, site), site) for site in sites]
        return min((site for site in near if site[0] != UNREACHABLE), default=(0, None))[1]

    def next_guess(
        self, ways: Floodfills, name: str, here: Cell, ruled_out: frozenset[Cell]
    ) -> Cell | None:
        """Where to look next for a room whose place is not known: near by, and near the hunch.
        None where every place has been ruled out."""
        open_sites = [site for site in self.sites if site not in ruled_out]
        nameless = [site for site in open_sites if site not in self.names]
        hunch = self.hunches.get(name)

        def effort(site: Cell) -> tuple[float, Cell]:
            walk = ways.distance(here, site)
            apart = abs(site[0] - hunch[0]) + abs(site[1] - hunch[1]) if hunch else 0
            return (walk + HUNCH_PULL * apart, site)

        reachable = [s for s in nameless or open_sites if ways.distance(here, s) != UNREACHABLE]
        return min(reachable, key=effort, default=None)


def memorised(building: Building, memorise_ms: int, traits: Traits, chance: Random) -> MapMemory:
    """What stays of a map with all names that was looked at for so long."""
    learned = 1 - exp(-traits.ability * memorise_ms / MINUTE_MS)
    names: dict[Cell, str] = {}
    hunches: dict[str, Cell] = {}
    sites = tuple(room.label for room in building.rooms)
    for room in building.rooms:
        luck, near, confused = chance.random(), chance.random(), chance.random()
        off = round(traits.gist_cells * normal(chance)), round(traits.gist_cells * normal(chance))
        if luck < learned and confused < traits.mix_up:
            names.setdefault(_neighbour(sites, room.label), room.name)
        elif luck < learned:
            names[room.label] = room.name
        elif near < traits.gist:
            hunches[room.name] = room.label[0] + off[0], room.label[1] + off[1]
    return MapMemory(sites, names, hunches)


def nothing_memorised(building: Building) -> MapMemory:
    """Knows which shapes are rooms, and no name."""
    return MapMemory(tuple(room.label for room in building.rooms), {}, {})


def _neighbour(sites: tuple[Cell, ...], site: Cell) -> Cell:
    others = [other for other in sites if other != site]
    return min(
        others or [site],
        key=lambda other: (abs(other[0] - site[0]) + abs(other[1] - site[1]), other),
    )
