"""Somebody who plays by what is told in lines of text alone."""

from __future__ import annotations

import io
import re
from collections.abc import Iterator

ORDINALS = (
    "first", "second", "third", "fourth", "fifth", "sixth", "seventh", "eighth", "ninth", "tenth",
)  # fmt: skip
PATIENCE = 40
"""So many steps are walked at most towards one thing."""
_PROCEED = re.compile(r"Proceed to the (\w+) (door|intersection) on your (\w+)")
_STRAIGHT_ON = frozenset(
    {"Enter the door ahead", "Exit by the door ahead", "Enter the room", "Enter the hallway"}
)
_DOOR = re.compile(r"A door, (?:not )?seen: (.*), \d+ steps? to walk\.")
_PLACE = re.compile(r"(?:(\d+) (ahead|behind))?(?: and )?(?:(\d+) (left|right))?")


class Listener:
    """Types lines; what was answered is in `out`, and nothing else is known."""

    def __init__(self, out: io.StringIO) -> None:
        self._out = out
        self._from = 0
        self._answer = ""

    def lines(self) -> Iterator[str]:
        """Carry out the bar's text, again and again."""
        yield from self._type("bar")
        while True:
            bar = self._bar()
            for sentence in (part.strip() for part in bar.rstrip(".").split(".")):
                yield from self._carry_out(sentence)
                if self._bar() != bar:
                    break
            else:
                yield from self._type("wait 1")

    def _type(self, line: str) -> Iterator[str]:
        self._from = len(self._out.getvalue())
        yield line
        self._answer = self._out.getvalue()[self._from :]

    def _bar(self) -> str:
        told = [line for line in self._out.getvalue().splitlines() if line.startswith("Bar: ")]
        return told[-1].removeprefix("Bar: ")

    def _carry_out(self, sentence: str) -> Iterator[str]:
        if found := re.fullmatch(r"Turn (left|right|around)", sentence):
            yield from self._type(f"turn {found[1]}")
        elif found := re.fullmatch(
            r"Proceed to the (\w+) (door|intersection) on your (\w+)", sentence
        ):
            yield from self._count(*found.groups())
        elif found := re.fullmatch(r"(?:Enter|Exit by) the (\w+) door on your (\w+)", sentence):
            yield from self._count(found[1], "door", found[2])
            yield from self._type(f"turn {found[2]}")
            yield from self._through()
        elif sentence in _STRAIGHT_ON:
            yield from self._through()
        elif sentence.startswith("Proceed to the end"):
            yield from self._type("f end")
        elif sentence == "Exit by the nearest door":
            yield from self._to_the_nearest(_DOOR, onto=True)
            yield from self._beyond()
        elif found := re.fullmatch(r"Proceed until you see a (\w+) victim", sentence):
            yield from self._until(f"A {found[1]} victim")
        elif found := re.fullmatch(r"Approach and save the (\w+) victim", sentence):
            victim = re.compile(rf"A {found[1]} victim: (.*)\.")
            yield from self._to_the_nearest(victim, onto=False)
            yield from self._type("treat")
        else:
            yield from self._type(sentence)

    def _count(self, ordinal: str, thing: str, side: str) -> Iterator[str]:
        wanted, seen = ORDINALS.index(ordinal) + 1, 0
        for _ in range(PATIENCE):
            yield from self._type("f")
            seen += len(re.findall(rf"past an? {thing} on the {side}", self._answer))
            if seen >= wanted or "wall stops you" in self._answer:
                return

    def _through(self) -> Iterator[str]:
        yield from self._type("f door")
        for _ in range(4):
            yield from self._type("f")
            if "doorway" not in self._answer:
                return

    def _until(self, words: str) -> Iterator[str]:
        for _ in range(PATIENCE):
            yield from self._type("f")
            if words in self._answer or "wall stops you" in self._answer:
                return

    def _to_the_nearest(self, told: re.Pattern[str], *, onto: bool) -> Iterator[str]:
        """Walk to the first place that `look` and `map` tell like this, along one side and then the
        other, as often as that is needed."""
        for longer_first in (True, False, True, False):
            yield from self._type("look. map")
            found = next(
                (it for line in self._answer.splitlines() if (it := told.search(line))), None
            )
            if found is None:
                return
            ahead, right = _offset(found[1])
            legs = [
                ("f" if ahead > 0 else "b", abs(ahead)),
                ("r" if right > 0 else "l", abs(right)),
            ]
            legs.sort(key=lambda leg: leg[1], reverse=longer_first)
            ways = [(self._compass(way), steps) for way, steps in legs if steps]
            if not ways:
                return
            for way, steps in ways:
                yield from self._type(f"{way} {steps}")
                if not onto and "is in reach" in self._answer:
                    return

    def _beyond(self) -> Iterator[str]:
        """From a doorway on to where it leads that is not the room that was left."""
        for _ in range(3):
            yield from self._type("f")
            if "doorway" not in self._answer:
                return

    def _compass(self, way: str) -> str:
        """A side by its point of the compass, as seen when `look` was typed last."""
        told = self._out.getvalue()
        ahead = re.match(r"Ahead, (\w+):", told[told.rindex("Ahead, ") :])
        assert ahead is not None
        points = ["north", "east", "south", "west"]
        return points[(points.index(ahead[1]) + {"f": 0, "r": 1, "b": 2, "l": 3}[way]) % 4]


def _offset(place: str) -> tuple[int, int]:
    """Steps ahead and to the right."""
    found = _PLACE.fullmatch(place)
    if found is None:
        return 0, 0
    ahead, way, right, side = found.groups()
    return (
        int(ahead or 0) * (-1 if way == "behind" else 1),
        int(right or 0) * (-1 if side == "left" else 1),
    )
