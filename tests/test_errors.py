"""How a problem that the user can mend is told."""

import pickle

import pytest

from game.errors import AnaError


@pytest.mark.parametrize(
    ("error", "text"),
    [
        (AnaError("it is torn"), "it is torn"),
        (AnaError("it is torn", place="a.txt"), "a.txt: it is torn"),
        (AnaError("it is torn", mend="Sew it."), "it is torn. Sew it."),
        (AnaError("it is torn.", place="a.txt", mend="Sew it."), "a.txt: it is torn. Sew it."),
    ],
)
def test_text_has_place_message_and_mend(error: AnaError, text: str) -> None:
    assert str(error) == text


def test_survives_the_way_between_processes() -> None:
    class_kept = pickle.loads(pickle.dumps(AnaError("m", place="p", mend="n")))
    assert str(class_kept) == "p: m. n"
