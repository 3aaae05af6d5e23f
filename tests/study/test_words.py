"""Every word of our own that a participant reads is in texts.toml."""

from game.mission_words import ENGLISH
from game.study.texts import shipped_texts


def test_the_shipped_texts_are_the_words_of_free_play() -> None:
    assert shipped_texts().words.mission == ENGLISH
