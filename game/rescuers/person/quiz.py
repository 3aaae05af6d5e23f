"""How a person labels the rooms after memorising the map."""

from __future__ import annotations

from collections.abc import Sequence
from random import Random

from game.rescuers.person.memory import MapMemory
from game.rescuers.person.parameters import Traits
from game.world.building import Room
from game.world.geometry import Cell


def labels(
    memory: MapMemory, traits: Traits, rooms: Sequence[Room], names: Sequence[str], chance: Random
) -> dict[Cell, str]:
    """Which of `names` the person gives to which room, by label cell: what is believed first,
    then hunches and guesses among the names that are left. Some rooms stay without."""
    given = {room.label: memory.names[room.label] for room in rooms if room.label in memory.names}
    left = [name for name in names if name not in given.values()]
    for room in rooms:
        if room.label in given or not left:
            continue
        hunches = [(name, memory.hunches[name]) for name in left if name in memory.hunches]
        near = [(_apart(at, room.label), name) for name, at in hunches]
        nearest = min(near, default=None)
        if nearest is not None and nearest[0] <= 2 * traits.gist_cells:
            name = nearest[1]
        elif chance.random() < traits.guess:
            name = chance.choice(left)
        else:
            continue
        given[room.label] = name
        left.remove(name)
    return given


def _apart(one: Cell, other: Cell) -> int:
    return abs(one[0] - other[0]) + abs(one[1] - other[1])
