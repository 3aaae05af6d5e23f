"""How a problem that the user can fix is reported."""

import pickle

import pytest

from game.errors import AnaError, choose_from


@pytest.mark.parametrize(
    ("error", "text"),
    [
        (AnaError("it is torn"), "it is torn"),
        (AnaError("it is torn", place="a.txt"), "a.txt: it is torn"),
        (AnaError("it is torn", hint="Sew it."), "it is torn. Sew it."),
        (AnaError("it is torn.", place="a.txt", hint="Sew it."), "a.txt: it is torn. Sew it."),
    ],
)
def test_the_text_has_place_message_and_hint(error: AnaError, text: str) -> None:
    assert str(error) == text


def test_it_can_be_pickled() -> None:
    class_kept = pickle.loads(pickle.dumps(AnaError("m", place="p", hint="n")))
    assert str(class_kept) == "p: m. n"


@pytest.mark.parametrize(
    ("name", "hint"),
    [
        ("FOUNDRI", "Did you mean foundry? Choose from foundry, Harbour, or a file."),
        ("harbor", "Did you mean Harbour? Choose from foundry, Harbour, or a file."),
        ("xyz", "Choose from foundry, Harbour, or a file."),
    ],
)
def test_an_unknown_name_gets_the_nearest_one_and_all_others(name: str, hint: str) -> None:
    assert choose_from(name, ("foundry", "Harbour"), ", or a file") == hint
