"""The words of the three levels (paper 5.1.2), with the additions Door, BlueVictim and Around, and
at C1 Wall and Door, which end a run that is too long to be counted.

An instruction is a sequence of (action, object) tuples. An object is a phrase of the level's own
words: a number where one is needed, a thing, and at C2 the side on which the walker meets it, as in
`("Enter", "3 Door left")`. At C3 it is a room's name or a victim.
"""

from __future__ import annotations

from game.coach.acts import Level
from game.world.building import Severity

Tuple = tuple[str, str]
Tuples = tuple[Tuple, ...]

ACTIONS: dict[Level, frozenset[str]] = {
    Level.C1: frozenset({"Walkforward", "Turn", "Stop", "Utilize"}),
    Level.C2: frozenset({"Turn", "Proceed", "Enter", "Exit", "ApproachAndSave"}),
    Level.C3: frozenset({"Goto", "Triage"}),
}

THINGS: dict[Level, frozenset[str]] = {
    Level.C1: frozenset({"Steps", "Left", "Right", "Around", "Wall", "Door", "MedicalEquipment"}),
    Level.C2: frozenset(
        [
            "Room",
            "Hallway",
            "Intersection",
            "left",
            "right",
            "redvictim",
            "Door",
            "BlueVictim",
            "Around",
        ]
    ),
    Level.C3: frozenset({"RedVictim", "BlueVictim"}),
}
"""What objects are made of, besides the natural numbers and, at C3, the building's room names."""

VICTIM_AT_C2 = {Severity.RED: "redvictim", Severity.BLUE: "BlueVictim"}
VICTIM_AT_C3 = {Severity.RED: "RedVictim", Severity.BLUE: "BlueVictim"}

MOST_STEPS = 12
"""How many steps a person is asked to count in one go."""
MOST_COUNTED = 10
"""The highest number of doors or intersections that a person is asked to count."""


def belongs(level: Level, said: Tuple) -> bool:
    """Whether a tuple is made of the level's words alone; after Goto any name may stand."""
    action, thing = said
    if action not in ACTIONS[level]:
        return False
    words = thing.split()
    return action == "Goto" or all(word.isdigit() or word in THINGS[level] for word in words)
