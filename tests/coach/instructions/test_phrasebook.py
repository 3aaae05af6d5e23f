"""The sentences of instructions.toml: what may be written there, and what is refused."""

import re
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from game.coach.acts import Level
from game.coach.instructions.phrasebook import FORMS, Phrasebook
from game.coach.instructions.phrasebook_file import PhrasebookError, english, parse_phrasebook
from game.coach.instructions.reading import letters, words
from game.coach.instructions.vocabulary import Tuple
from game.toml_lines import line_of

ROOT = Path(__file__).parents[3]
JAPANESE = (ROOT / "tests/data/japanese/instructions.toml").read_text(encoding="utf-8")
ENGLISH = english().text


def read(text: str) -> Phrasebook:
    return parse_phrasebook(text, "instructions.toml")


def refusal(text: str) -> PhrasebookError:
    with pytest.raises(PhrasebookError) as refused:
        read(text)
    return refused.value


def said(number: int, room: str) -> list[tuple[Level, Tuple]]:
    """Every tuple, with that number and that room."""
    filled = (
        (level, form.format(number=number, room=room)) for level in Level for form in FORMS[level]
    )
    return [(level, (phrase.split(" ", 1)[0], phrase.split(" ", 1)[1])) for level, phrase in filled]


@given(st.integers(1, 10), st.sampled_from(["Records Room", "Office A", "3"]))
def test_a_translation_says_every_tuple_in_words_of_its_own(number: int, room: str) -> None:
    there, here = read(JAPANESE), english()
    for level, one in said(number, room):
        sentence = there.render(level, (one,))
        assert sentence and sentence != here.render(level, (one,))
        assert not re.search(r"[{}]", sentence)


def test_several_sentences_are_joined_as_the_language_does() -> None:
    tuples: tuple[Tuple, ...] = (("Turn", "left"), ("Enter", "3 Door left"))
    assert english().render(Level.C2, tuples) == "Turn left. Enter the third door on your left."
    assert read(JAPANESE).render(Level.C2, tuples) == (
        "左を向いてください。左側の3番目のドアに入ってください。"
    )


def test_a_language_may_have_more_plural_forms_than_two() -> None:
    text = ENGLISH.replace("one = [1]", "one = [1]\nfew = [2, 3, 4]").replace(
        '{ one = "Walk forward {number} step.", other = "Walk forward {number} steps." }',
        '{ one = "krok", few = "{number} kroki", other = "{number} kroków" }',
    )
    steps = [read(text).render(Level.C1, (("Walkforward", f"{n} Steps"),)) for n in (1, 3, 5, 12)]
    assert steps == ["krok", "3 kroki", "5 kroków", "12 kroków"]


def test_several_lists_of_ordinals_can_be_used() -> None:
    text = ENGLISH.replace(
        "[C1]",
        'nten = ["1ten","2ten","3ten","4ten","5ten","6ten","7ten","8ten","9ten","10ten"]\n[C1]',
    ).replace("Enter the {nth} door on your left", "Zur {nten} Tür ({number}, {nth})")
    assert read(text).render(Level.C2, (("Enter", "3 Door left"),)) == "Zur 3ten Tür (3, third)."


def test_a_room_may_have_a_sentence_of_its_own() -> None:
    text = ENGLISH.replace("[notices]", '"Goto Records Room" = "Off to the records!"\n[notices]')
    assert read(text).render(Level.C3, (("Goto", "Records Room"),)) == "Off to the records!"
    assert read(text).render(Level.C3, (("Goto", "Lobby"),)) == "Go to the Lobby."


LINES = ENGLISH.splitlines()
SENTENCES = [n for n, line in enumerate(LINES) if re.match(r'"[^"]+" = |[a-z_]+ = "[A-Z]', line)]


@pytest.mark.parametrize("number", SENTENCES, ids=lambda n: LINES[n].split(" = ")[0])
def test_each_sentence_is_missed(number: int) -> None:
    key = LINES[number].split(" = ")[0].strip('"')
    error = refusal("\n".join([*LINES[:number], *LINES[number + 1 :]]))
    assert f"lacks '{key}'" in error.message
    assert re.fullmatch(r"instructions.toml, line \d+", error.place)


@pytest.mark.parametrize("number", SENTENCES, ids=lambda n: LINES[n].split(" = ")[0])
def test_each_misspelt_name_is_reported_with_its_line_and_the_right_one(number: int) -> None:
    key, sentence = LINES[number].split(" = ", 1)
    name = key.strip('"')
    wrong = f'"{name[:-1]}"' if not name.endswith("}") else f'"{name[:-2]}}}"'
    error = refusal("\n".join([*LINES[:number], f"{wrong} = {sentence}", *LINES[number + 1 :]]))
    assert error.place == f"instructions.toml, line {number + 1}"
    assert f"Did you mean {name}?" in error.hint


@pytest.mark.parametrize(
    ("before", "after", "message", "hint"),
    [
        ('{nth} door on your left."', '{nht} door on your left."', "no {nht}", "mean {nth}?"),
        ('"Turn left."', '"Turn {side}."', "no {side}", "Write the words themselves"),
        ('"Go to {room}."', '"Go to {roon}."', "no {roon}", "Did you mean {room}?"),
        ('"Go to {room}." }', '"Go there." }', "lacks {room}", "Add {room}"),
        ('"Turn right."', '"Turn right }."', "no }", "Write the words"),
        ('one = "Walk forward {number} step.", ', "", "lacks the plural form one", 'one = "..."'),
        ("{ one = \"Walk forward {number} step.\", other = \"Walk forward {number} steps.\" }",
         '"Walk forward {number} steps."', "lacks the plural forms one, other", 'other = "..."'),
        ("step.\", other", "step.\", otter", "no form 'otter'", "Did you mean other?"),
        ("step.\", other = \"Walk forward {number} steps.\"", "step.\", other = \"Walk on.\"",
         "does not say which number", "{number}"),
        (', "tenth"', "", "must be a list of 10 words, not 9", "first to tenth"),
        ("one = [1]", "one = [1]\ntwo = [1]", "1 has two forms", "one"),
        ("one = [1]", "one = 1", "must be a list of numbers", "one = [1]"),
        ('"Turn right."', '"Turn left."', "same sentence as 'Turn Left'", "change one"),
        ('"Turn around."', '""', "the sentence is missing", "one line of text"),
        ('"Turn around."', '"Turn\\naround."', "not a sentence", "one line of text"),
        ('language = "en"', "", "language is missing", "Add language"),
        ("[notices]", "[notice]", "no part 'notice'", "Did you mean notices?"),
        ("[C2]", "[C4]", "no part 'C4'", "C2"),
    ],
)  # fmt: skip
def test_what_cannot_be_used_is_refused_with_its_line(
    before: str, after: str, message: str, hint: str
) -> None:
    changed = ENGLISH.replace(before, after, 1)
    assert changed != ENGLISH
    error = refusal(changed)
    assert message in error.message
    assert hint in error.hint
    if "missing" not in message or "sentence" in message:
        line = int(error.place.rpartition(" ")[2])
        assert 1 <= line <= len(changed.splitlines())


def test_no_toml_is_refused() -> None:
    assert "not TOML" in refusal("[C1\n").message


def test_lines_are_found_in_tables_and_below_long_texts() -> None:
    text = 'a = 1\n[b.c]\n"d e" = """\nd = 2\n"""\nf = 3 # f\n[[g]]\nh = 4\n'
    found = [
        line_of(text, *path) for path in (["a"], ["b", "c", "d e"], ["b", "c", "f"], ["g", "h"])
    ]
    assert found == [1, 3, 6, 8]
    assert line_of(text, "b", "c", "d") == 2
    assert line_of(text, "z") is None


def test_what_there_is_to_read_is_measured_in_letters_and_words_of_english() -> None:
    assert (letters("Turn left."), words("Turn left.")) == (10, 2)
    assert (letters("Zur Tür"), words("Zur dritten Tür.")) == (7, 3)
    assert (letters("左へ2歩"), words("左へ2歩")) == (10, 3)
    assert letters("Tür") == 3
