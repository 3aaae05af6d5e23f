"""The vocabularies and the English made of them."""

from itertools import product
from textwrap import wrap

import pytest
from hypothesis import given
from hypothesis import strategies as st

from game.coach.acts import Level
from game.coach.instructions import instruct
from game.coach.instructions.phrasebook_file import english
from game.coach.instructions.vocabulary import MOST_COUNTED, THINGS, Tuple, belongs
from game.rescuers.literal.grammar import parse
from tests.coach.instructions.office import office, poses, scene

render = english().render
SIDES = ("left", "right")
COUNTED = [
    f"{n} {thing} {side}"
    for n in range(1, MOST_COUNTED + 1)
    for thing, side in product(("Door", "Intersection"), SIDES)
]
DOORS = ["Door", *(phrase for phrase in COUNTED if "Door" in phrase)]
WHAT_CAN_BE_SAID: dict[Level, list[Tuple]] = {
    Level.C1: [
        *(("Turn", way) for way in ("Left", "Right", "Around")),
        *(("Walkforward", f"{steps} Steps") for steps in range(1, 96)),
        ("Stop", "0 Steps"),
        ("Utilize", "MedicalEquipment"),
    ],
    Level.C2: [
        *(("Turn", way) for way in ("left", "right", "Around")),
        *(("Proceed", to) for to in ("Hallway", "Room", "1 redvictim", "1 BlueVictim", *COUNTED)),
        *(("Enter", door) for door in ("Room", "Hallway", *DOORS)),
        *(("Exit", door) for door in ("Room", *DOORS)),
        ("ApproachAndSave", "redvictim"),
        ("ApproachAndSave", "BlueVictim"),
    ],
    Level.C3: [
        ("Goto", "Records Room"),
        ("Triage", "RedVictim"),
        ("Triage", "BlueVictim"),
    ],
}
EVERYTHING = [(level, said) for level, tuples in WHAT_CAN_BE_SAID.items() for said in tuples]


@pytest.mark.parametrize(("level", "said"), EVERYTHING)
def test_every_tuple_is_one_sentence_that_a_reader_knows(level: Level, said: Tuple) -> None:
    assert belongs(level, said)
    assert len(parse(render(level, (said,)))) == 1


def test_no_two_tuples_of_a_level_sound_alike() -> None:
    for level, tuples in WHAT_CAN_BE_SAID.items():
        heard = {render(level, (said,)) for said in tuples if said[0] != "Exit"}
        assert len(heard) == len([said for said in tuples if said[0] != "Exit"])


@pytest.mark.parametrize("level", [Level.C1, Level.C2])
def test_the_longest_of_everything_fits_two_lines(level: Level) -> None:
    moves = sorted((render(level, (said,)) for said in WHAT_CAN_BE_SAID[level]), key=len)
    if level is Level.C1:
        longest = "Turn around. Walk forward 95 steps. " * 3 + "Utilize medical equipment."
    else:
        longest = f"{moves[-1]} Turn around. {moves[-1]}"
    assert len(wrap(longest, 78)) <= 2


def test_everything_the_office_hears_is_made_of_the_vocabulary() -> None:
    place = scene()
    rooms = {room.name for room in office().rooms}
    heard = set()
    for pose in poses():
        for goal in place.waiting:
            for level in Level:
                instruction = instruct(place, pose, goal, level)
                heard |= {(instruction.shown_level, said) for said in instruction.tuples}
                assert instruction.text == render(instruction.shown_level, instruction.tuples)
    for level, (action, thing) in heard:
        words = [] if thing in rooms and action == "Goto" else thing.split()
        assert belongs(level, (action, thing))
        assert all(word.isdigit() or word in THINGS[level] for word in words)
    assert {level for level, _ in heard} == set(Level)


@pytest.mark.parametrize(
    ("level", "said"),
    [
        (Level.C1, ("Proceed", "Hallway")),
        (Level.C1, ("Walkforward", "Left")),
        (Level.C2, ("Goto", "Records Room")),
        (Level.C2, ("Enter", "3 Steps left")),
        (Level.C2, ("Enter", "left")),
        (Level.C3, ("Triage", "Records Room")),
        (Level.C3, ("Turn", "left")),
    ],
)
def test_what_a_level_cannot_say_is_refused(level: Level, said: Tuple) -> None:
    with pytest.raises(ValueError, match=f"is not a tuple of level {level.name}"):
        render(level, (said,))


@pytest.mark.parametrize(
    ("room", "sentence"),
    [
        ("Records Room", "Go to the Records Room."),
        ("Office A", "Go to Office A."),
        ("Room 12", "Go to Room 12."),
        ("The Atrium", "Go to The Atrium."),
    ],
)
def test_a_proper_name_has_no_article(room: str, sentence: str) -> None:
    assert render(Level.C3, (("Goto", room),)) == sentence


@given(st.lists(st.sampled_from(WHAT_CAN_BE_SAID[Level.C2]), min_size=1, max_size=3))
def test_sentences_are_read_one_by_one(tuples: list[Tuple]) -> None:
    together = parse(render(Level.C2, tuple(tuples)))
    assert together == tuple(parse(render(Level.C2, (said,)))[0] for said in tuples)
