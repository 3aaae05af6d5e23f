"""From tuples to English. The words come from the tuples alone."""

from __future__ import annotations

from game.coach.acts import Level
from game.coach.instructions.vocabulary import ORDINALS, Tuple, Tuples, belongs


def render(level: Level, tuples: Tuples) -> str:
    """The sentences that say `tuples`, one each. Raises ValueError for a tuple that `level` does
    not have."""
    for said in tuples:
        if not belongs(level, said):
            raise _not_of(level, said)
    return " ".join(_SENTENCES[level](said) for said in tuples)


def _at_c1(said: Tuple) -> str:
    action, phrase = said
    match action, *phrase.split():
        case "Turn", way:
            return f"Turn {way.lower()}."
        case "Walkforward", count, "Steps":
            return f"Walk forward {count} {'step' if count == '1' else 'steps'}."
        case "Walkforward", ("Wall" | "Door") as end:
            return f"Walk forward to the {end.lower()}."
        case "Stop", "0", "Steps":
            return "Stop."
        case "Utilize", "MedicalEquipment":
            return "Utilize medical equipment."
    raise _not_of(Level.C1, said)


def _at_c2(said: Tuple) -> str:
    action, phrase = said
    match action, *phrase.split():
        case "Turn", way:
            return f"Turn {way.lower()}."
        case "Proceed", ("Hallway" | "Room") as space:
            return f"Proceed to the end of the {space.lower()}."
        case "Proceed", "1", victim:
            return f"Proceed until you see a {_colour(victim)} victim."
        case "Proceed", number, thing, side:
            return f"Proceed to the {_counted(number, thing, side)}."
        case "Enter" | "Exit", *where:
            return _through(action, where)
        case "ApproachAndSave", victim:
            return f"Approach and save the {_colour(victim)} victim."
    raise _not_of(Level.C2, said)


def _through(action: str, where: list[str]) -> str:
    verb = "Enter" if action == "Enter" else "Exit by"
    match where:
        case ["Room" | "Hallway" as space]:
            return f"{action} the {space.lower()}."
        case ["Door"]:
            return f"{verb} the door ahead."
        case [number, thing, side]:
            return f"{verb} the {_counted(number, thing, side)}."
    raise _not_of(Level.C2, (action, " ".join(where)))


def _at_c3(said: Tuple) -> str:
    match said:
        case "Goto", room:
            return f"Go to {_with_article(room)}."
        case "Triage", victim:
            return f"Triage the {_colour(victim)} victim."
    raise _not_of(Level.C3, said)


_SENTENCES = {Level.C1: _at_c1, Level.C2: _at_c2, Level.C3: _at_c3}


def _counted(number: str, thing: str, side: str) -> str:
    return f"{ORDINALS[int(number) - 1]} {thing.lower()} on your {side}"


def _colour(victim: str) -> str:
    return victim.lower().removesuffix("victim")


def _with_article(room: str) -> str:
    """`the Records Room`, but `Office A` and `Room 12`, which are names by themselves."""
    last = room.split()[-1]
    is_proper = len(last) == 1 or any(letter.isdigit() for letter in last)
    return room if is_proper or room.lower().startswith("the ") else f"the {room}"


def _not_of(level: Level, said: Tuple) -> ValueError:
    return ValueError(f"{said} is not a tuple of level {level.name}")
