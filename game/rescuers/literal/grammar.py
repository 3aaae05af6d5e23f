"""The English on the yellow bar, as somebody understands it who knows the language and no more."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

from game.world.building import Severity

Way = Literal["left", "right", "around"]
Side = Literal["left", "right"]
Landmark = Literal["door", "intersection"]


class UnreadableInstruction(ValueError):
    """A sentence on the bar that the reader does not know."""


@dataclass(frozen=True)
class Turn:
    way: Way


@dataclass(frozen=True)
class Walk:
    steps: int


@dataclass(frozen=True)
class WalkTo:
    """Ahead to the last cell before the wall, or onto the first door cell."""

    end: Literal["wall", "door"]


@dataclass(frozen=True)
class Stop:
    pass


@dataclass(frozen=True)
class Utilize:
    pass


@dataclass(frozen=True)
class ProceedToEnd:
    pass


@dataclass(frozen=True)
class ProceedTo:
    """To the `number`th landmark that comes abreast on one side."""

    number: int
    landmark: Landmark
    side: Side


@dataclass(frozen=True)
class ProceedUntilSeen:
    severity: Severity


@dataclass(frozen=True)
class TakeDoor:
    """Through the `number`th door that comes abreast on one side."""

    number: int
    side: Side


@dataclass(frozen=True)
class TakeDoorAhead:
    pass


@dataclass(frozen=True)
class LeaveDoorway:
    """From a doorway onto the first cell beyond it."""


@dataclass(frozen=True)
class ExitRoom:
    pass


@dataclass(frozen=True)
class Approach:
    severity: Severity


@dataclass(frozen=True)
class GoTo:
    """`room` as it stands in the sentence, perhaps with its article."""

    room: str


@dataclass(frozen=True)
class Triage:
    severity: Severity


Sentence = (
    Turn
    | Walk
    | WalkTo
    | Stop
    | Utilize
    | ProceedToEnd
    | ProceedTo
    | ProceedUntilSeen
    | TakeDoor
    | TakeDoorAhead
    | LeaveDoorway
    | ExitRoom
    | Approach
    | GoTo
    | Triage
)

_ORDINALS = "first second third fourth fifth sixth seventh eighth ninth tenth"
_NUMBERS = {word: number for number, word in enumerate(_ORDINALS.split(" "), start=1)}
_SIDES: dict[str, Side] = {"left": "left", "right": "right"}
_WAYS: dict[str, Way] = {"left": "left", "right": "right", "around": "around"}
_LANDMARKS: dict[str, Landmark] = {"door": "door", "intersection": "intersection"}
_ENDS: dict[str, Literal["wall", "door"]] = {"wall": "wall", "door": "door"}

_NUMBER = f"({'|'.join(_NUMBERS)})"
_PATTERNS: tuple[tuple[str, Callable[..., Sentence]], ...] = (
    (r"Turn (left|right|around)", lambda way: Turn(_WAYS[way])),
    (r"Walk forward (\d+) steps?", lambda steps: Walk(int(steps))),
    (r"Walk forward to the (wall|door)", lambda end: WalkTo(_ENDS[end])),
    (r"Stop", Stop),
    (r"Utilize medical equipment", Utilize),
    (r"Proceed to the end of the (?:hallway|room)", ProceedToEnd),
    (
        rf"Proceed to the {_NUMBER} (door|intersection) on your (left|right)",
        lambda number, thing, side: ProceedTo(_NUMBERS[number], _LANDMARKS[thing], _SIDES[side]),
    ),
    (
        r"Proceed until you see a (red|blue) victim",
        lambda colour: ProceedUntilSeen(Severity(colour)),
    ),
    (
        rf"(?:Enter|Exit by) the {_NUMBER} door on your (left|right)",
        lambda number, side: TakeDoor(_NUMBERS[number], _SIDES[side]),
    ),
    (r"(?:Enter|Exit by) the door ahead", TakeDoorAhead),
    (r"Enter the (?:room|hallway)", LeaveDoorway),
    (r"Exit by the nearest door", ExitRoom),
    (r"Approach and save the (red|blue) victim", lambda colour: Approach(Severity(colour))),
    (r"Go to (.+)", GoTo),
    (r"Triage the (red|blue) victim", lambda colour: Triage(Severity(colour))),
)
_GRAMMAR = tuple((re.compile(pattern), sentence) for pattern, sentence in _PATTERNS)


def parse(text: str) -> tuple[Sentence, ...]:
    """The sentences of a text, each ended by a full stop. Raises `UnreadableInstruction`, naming
    the first sentence that is not known."""
    return tuple(_read(sentence.strip()) for sentence in re.findall(r"[^.]+\.?", text.strip()))


def _read(sentence: str) -> Sentence:
    if sentence.endswith("."):
        for pattern, made in _GRAMMAR:
            match = pattern.fullmatch(sentence[:-1])
            if match is not None:
                return made(*match.groups())
    raise UnreadableInstruction(f"I cannot read '{sentence}'")
