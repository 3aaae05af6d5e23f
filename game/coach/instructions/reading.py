"""How much there is to read in a text, in any language.

Reading times are known for letters and words of English. In a minute natives of 18 to 35 years read
987 characters or 228 words of an English text aloud, and 357 characters of the same text in
Japanese (Trauzettel-Klosinski, Dietz & the IReST Study Group, 2012, Investigative Ophthalmology &
Visual Science 53(9), 5452-5461, doi:10.1167/iovs.11-8284, Table 2). So a wide character (Chinese,
Japanese, Korean) takes as long as 987/357 = 2.8 letters, here 3, and 357/228 = 1.6 of them take as
long as an English word, here 2.
"""

from __future__ import annotations

from math import ceil
from unicodedata import combining

from game.world.labels import is_wide

LETTERS_IN_WIDE = round(987 / 357)
WIDE_IN_WORD = round(357 / 228)


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
