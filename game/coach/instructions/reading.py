"""How much there is to read in a text, in any language.

Reading times are known for letters and words of English. A wide character (Chinese, Japanese,
Korean) takes about as long as three letters, and two of them as long as a word: 357 characters or
193 words of Japanese against 987 letters or 228 words of English a minute (Trauzettel-Klosinski and
Dietz, 2012, Investigative Ophthalmology & Visual Science 53).
"""

from __future__ import annotations

from math import ceil
from unicodedata import combining

from game.world.labels import is_wide

LETTERS_IN_WIDE = 3
WIDE_IN_WORD = 2


def letters(text: str) -> int:
    """The letters that take as long to read as `text`, blanks and marks included."""
    if text.isascii():
        return len(text)
    return sum(LETTERS_IN_WIDE if is_wide(it) else not combining(it) for it in text)


def words(text: str) -> int:
    """The words that take as long to read as `text`."""
    if text.isascii():
        return len(text.split())
    wide = sum(map(is_wide, text))
    others = "".join(" " if is_wide(it) else it for it in text)
    narrow = sum(any(map(str.isalnum, it)) for it in others.split())
    return narrow + ceil(wide / WIDE_IN_WORD)
