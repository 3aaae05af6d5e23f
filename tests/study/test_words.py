"""Every word of our own that a participant reads is in texts.toml."""

import re
from importlib import resources
from pathlib import Path

import pytest

from game.errors import AnaError
from game.mission_words import ENGLISH
from game.study.texts import read_texts, shipped_texts


def test_the_shipped_texts_are_the_words_of_free_play() -> None:
    assert shipped_texts().words.mission == ENGLISH


@pytest.mark.parametrize(
    ("before", "after", "message"),
    [
        ('yes = "y"\nno = "n"', 'yes = "q"\nno = "n"', "yes must be a single letter"),
        ('yes = "y"\nno = "n"', 'yes = "ja"\nno = "n"', "yes must be a single letter"),
        ('yes = "y"\nno = "n"', 'yes = "x"\nno = "X"', "must be different letters"),
        ('yes = "y"\nno = "n"', 'yes = "n"\nno = "x"', "must be different letters"),
        ("facing {direction}", "facing {way}", "there is no {way} to be filled in"),
        ('stand_beside = "', 'stand_besides = "', "there is no key `stand_besides`"),
    ],
)
def test_words_that_cannot_be_used_are_refused(
    tmp_path: Path, before: str, after: str, message: str
) -> None:
    path = tmp_path / "texts.toml"
    text = (resources.files("game.study") / "template" / "texts.toml").read_text("utf-8")
    assert before in text
    path.write_text(text.replace(before, after), encoding="utf-8")
    with pytest.raises(AnaError, match=re.escape(message)):
        read_texts(path)


def test_older_texts_use_the_shipped_words(tmp_path: Path) -> None:
    path = tmp_path / "texts.toml"
    text = (resources.files("game.study") / "template" / "texts.toml").read_text("utf-8")
    older = re.sub(r"(?s)# The panel beside the office\..*?(?=# Only read by people)", "", text)
    assert "words.mission" not in older
    path.write_text(older, encoding="utf-8")
    assert read_texts(path) == shipped_texts()
