"""A bounded person: reads at a pace, remembers part of a map, miscounts doors, presses wrong keys.

Receives the Observation and nothing more, and acts through the same timed actions as anybody.
`docs/simulated-people.md` says in words what is assumed and why.
"""

from game.rescuers.person.memory import MapMemory, memorised
from game.rescuers.person.parameters import Population, Traits, drawn
from game.rescuers.person.rescuer import BoundedPerson
from game.rescuers.person.worlds import POPULATIONS, world

__all__ = [
    "POPULATIONS",
    "BoundedPerson",
    "MapMemory",
    "Population",
    "Traits",
    "drawn",
    "memorised",
    "world",
]
