"""What a mission was like for the person in it, as far as they could notice."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Literal

from game.rescuers.literal.grammar import GoTo, Sentence, Stop, Triage, Turn, Utilize, Walk, WalkTo

Style = Literal[1, 2, 3]
"""How an instructor talks: in steps, by doors and hallways, by names of rooms."""


@dataclass
class Experience:
    """Times in milliseconds. `knowledge` is the share of rooms the person knew before it began."""

    knowledge: float
    style_ms: dict[Style, int] = field(default_factory=lambda: {1: 0, 2: 0, 3: 0})
    searching_ms: int = 0
    """Walking without knowing where to."""
    puzzled_ms: int = 0
    """Words that could not be carried out, and correcting wrong keys."""
    corrections: int = 0
    switches: int = 0
    rescued: int = 0
    style: Style | None = None
    _until_ms: int = 0

    @property
    def total_ms(self) -> int:
        return self._until_ms

    def passed(self, now_ms: int, *, searching: bool, puzzled: bool) -> None:
        """Time went by until `now_ms`, spent so."""
        spent_ms, self._until_ms = now_ms - self._until_ms, now_ms
        if self.style is not None:
            self.style_ms[self.style] += spent_ms
        if searching:
            self.searching_ms += spent_ms
        elif puzzled:
            self.puzzled_ms += spent_ms

    def told(self, sentences: tuple[Sentence, ...], *, corrected: bool) -> None:
        """New words are on the bar."""
        style = style_of(sentences)
        if style is not None:
            self.switches += self.style is not None and style != self.style
            self.style = style
        self.corrections += corrected


def style_of(sentences: tuple[Sentence, ...]) -> Style | None:
    """How the words talk; None where a turn alone does not tell."""
    if any(isinstance(sentence, GoTo | Triage) for sentence in sentences):
        return 3
    if any(isinstance(sentence, Walk | WalkTo | Utilize | Stop) for sentence in sentences):
        return 1
    return None if all(isinstance(sentence, Turn) for sentence in sentences) else 2
