"""From tuples to sentences, in the language of a phrasebook: `instructions.toml`.

The words come from the tuples alone. `phrasebook_file` reads and checks such a file; the one beside
it is the shipped English.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Literal

from game.coach.acts import Level
from game.coach.instructions.vocabulary import MOST_COUNTED, MOST_STEPS, Tuple, Tuples, belongs

NUMBER, ROOM = "{number}", "{room}"
"""What stands in a form for the part of a tuple that varies."""

_SIDES = ("left", "right")
FORMS: Mapping[Level, tuple[str, ...]] = MappingProxyType(
    {
        Level.C1: (
            "Turn Left",
            "Turn Right",
            "Turn Around",
            f"Walkforward {NUMBER} Steps",
            "Walkforward Wall",
            "Walkforward Door",
            "Stop 0 Steps",
            "Utilize MedicalEquipment",
        ),
        Level.C2: (
            "Turn left",
            "Turn right",
            "Turn Around",
            "Proceed Hallway",
            "Proceed Room",
            *(f"Proceed {NUMBER} Intersection {side}" for side in _SIDES),
            *(f"Proceed {NUMBER} Door {side}" for side in _SIDES),
            "Proceed 1 redvictim",
            "Proceed 1 BlueVictim",
            *(f"Enter {NUMBER} Door {side}" for side in _SIDES),
            "Enter Door",
            "Enter Room",
            "Enter Hallway",
            *(f"Exit {NUMBER} Door {side}" for side in _SIDES),
            "Exit Door",
            "Exit Room",
            "ApproachAndSave redvictim",
            "ApproachAndSave BlueVictim",
        ),
        Level.C3: (f"Goto {ROOM}", "Triage RedVictim", "Triage BlueVictim"),
    }
)
"""All that can be said at each level: action and object, as in a tuple, with what varies in braces.
"""

OTHER = "other"
"""The plural form of all numbers that have none of their own."""
ARTICLE, NO_ARTICLE = "article", "no_article"
"""The two forms of a sentence with a room's name."""

NoticeName = Literal[
    "passed_door",
    "too_far",
    "wrong_way",
    "too_late",
    "another_first",
    "standing",
    "wandering",
    "all_safe",
    "nobody_in_time",
]


@dataclass(frozen=True)
class Phrasebook:
    """The sentences of one language.

    `text` is the file that they come from. `sentences` holds for each level and form (or whole
    tuple, where it has a sentence of its own) one sentence, or several by plural form or article;
    `plural` the plural form of each number that has one of its own; `ordinals` lists of the words
    for first to tenth, by name.
    """

    text: str = field(repr=False)
    language: str
    between: str
    sentences: Mapping[tuple[Level, str], str | Mapping[str, str]] = field(repr=False)
    notices: Mapping[NoticeName, str] = field(repr=False)
    plural: Mapping[int, str] = field(repr=False)
    ordinals: Mapping[str, tuple[str, ...]] = field(repr=False)
    _said: dict[tuple[Level, Tuple], str] = field(
        default_factory=dict, init=False, repr=False, compare=False
    )

    @property
    def own_sentences(self) -> tuple[str, ...]:
        """The rooms that have a sentence of their own."""
        forms = (form.partition(" ") for level, form in self.sentences if level is Level.C3)
        return tuple(thing for action, _, thing in forms if action == "Goto" and thing != ROOM)

    def each(self, level: Level, tuples: Tuples) -> tuple[str, ...]:
        """The sentence of each tuple. Raises ValueError for one that `level` does not have."""
        return tuple(self._sentence(level, said) for said in tuples)

    def joined(self, sentences: Iterable[str]) -> str:
        """Several sentences in one text."""
        return self.between.join(sentences)

    def render(self, level: Level, tuples: Tuples) -> str:
        """The text that says `tuples`. Raises ValueError for one that `level` does not have."""
        return self.joined(self.each(level, tuples))

    def _sentence(self, level: Level, said: Tuple) -> str:
        sentence = self._said.get((level, said))
        if sentence is None:
            sentence = self._said[level, said] = self._made(level, said)
        return sentence

    def _made(self, level: Level, said: Tuple) -> str:
        action, thing = said
        if not belongs(level, said):
            raise _not_of(level, said)
        number = next((int(word) for word in thing.split() if word.isdigit()), None)
        if action == "Goto":
            form = f"Goto {ROOM}"
        elif number is not None:
            form = f"{action} {thing.replace(str(number), NUMBER, 1)}"
        else:
            form = f"{action} {thing}"
        found = self.sentences.get((level, f"{action} {thing}"), self.sentences.get((level, form)))
        if found is None:
            raise _not_of(level, said)
        if action == "Goto":
            return _chosen(found, _article(thing)).replace(ROOM, thing)
        if number is None:
            return _chosen(found, OTHER)
        sentence = _chosen(found, self.plural.get(number, OTHER)).replace(NUMBER, str(number))
        for name, words in self.ordinals.items():
            if f"{{{name}}}" in sentence:
                if number > len(words):
                    raise _not_of(level, said)
                sentence = sentence.replace(f"{{{name}}}", words[number - 1])
        return sentence


def everything_said(level: Level, rooms: Iterable[str]) -> Iterator[Tuple]:
    """Every tuple of a level, in a building with these rooms."""
    for form in FORMS[level]:
        action, thing = form.split(" ", 1)
        if thing == ROOM:
            yield from ((action, room) for room in rooms)
        elif NUMBER in thing:
            most = MOST_STEPS if thing.endswith("Steps") else MOST_COUNTED
            numbers = range(1, most + 1)
            yield from ((action, thing.replace(NUMBER, str(number))) for number in numbers)
        else:
            yield action, thing


def _chosen(found: str | Mapping[str, str], form: str) -> str:
    return found if isinstance(found, str) else found[form]


def _article(room: str) -> str:
    """`the Records Room`, but `Office A` and `Room 12`, which are names by themselves."""
    last = room.split()[-1]
    is_proper = len(last) == 1 or any(letter.isdigit() for letter in last)
    return NO_ARTICLE if is_proper or room.lower().startswith("the ") else ARTICLE


def _not_of(level: Level, said: Tuple) -> ValueError:
    return ValueError(f"{said} is not a tuple of level {level.name}")
