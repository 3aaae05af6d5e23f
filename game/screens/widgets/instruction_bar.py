"""The yellow bar: the coach's instruction, always whole."""

from __future__ import annotations

import re
from collections.abc import Iterable
from time import monotonic
from typing import ClassVar

from rich.cells import cell_len

from game.coach.acts import Level
from game.coach.instructions.c1 import MOST_LEGS, UTILIZE
from game.coach.instructions.phrasebook import Phrasebook, everything_said
from game.coach.instructions.vocabulary import Tuples
from game.screens.widgets.canvas import Canvas, Row, wrapped
from game.screens.widgets.program import Program
from game.world.observation import Guidance

LINES = 3
"""Rows of the bar; a longer text makes it taller rather than being cut."""
FLASH_S = 0.6
"""How long a new instruction stands out."""


_WIDE_STOPS = ("。", "！", "？")
_SENTENCE = re.compile(r"(?<=[.!?]) +|(?<=[。！？])(?=.)")


def sentences_in_rows(text: str, columns: int) -> list[str]:
    """A text in rows of `columns`: broken between sentences where that takes no more rows."""
    rows = wrapped(text, columns)
    whole: list[str] = []
    for sentence in _SENTENCE.split(text) if len(rows) > 1 else ():
        before = "".join(whole[-1:])
        joined = f"{before}{'' if before.endswith(_WIDE_STOPS) else ' '}{sentence}"
        if before and cell_len(joined) <= columns:
            whole[-1] = joined
        else:
            whole += wrapped(sentence, columns)
    return whole if 0 < len(whole) <= len(rows) else rows


def bar_rows(
    guidance: Guidance,
    columns: int,
    *,
    fresh: bool = False,
    lines: int = LINES,
    by_sentence: bool = True,
) -> list[Row]:
    """Notice and instruction, wrapped into at least `lines` rows of `columns`.

    The notice has rows of its own above the text, which stands where it would without one. A
    notice without an instruction, as at the end, is the text.
    """
    style = "fresh" if fresh else "text"
    if not guidance.text:
        guidance = Guidance(guidance.notice)
    wide = max(1, columns - 4)
    text = sentences_in_rows(guidance.text, wide) if by_sentence else wrapped(guidance.text, wide)
    rows: list[Row] = [((line, style),) for line in text]
    above = max(0, lines - len(rows) + 1) // 2
    if guidance.notice:
        told = wrapped(guidance.notice, wide - 2)
        notice: list[Row] = [((f" {line} ", "notice"),) for line in told]
        rows = [()] * (above - len(notice)) + notice + rows
    else:
        rows = [()] * above + rows
    rows += [()] * (lines - len(rows))
    edge = "▌ " if fresh else "  "
    return [((edge, style), *row, (" " * columns, style)) for row in rows]


def longest_guidance(phrases: Phrasebook, rooms: Iterable[str]) -> tuple[Guidance, ...]:
    """The longest text of each level, in a building with these rooms, each with the longest
    notice."""
    notice = max(phrases.notices.values(), key=cell_len)
    exit_room = ("Exit", "Room")
    texts: list[tuple[Level, Tuples]] = []
    for level in Level:
        said = list(everything_said(level, rooms))
        sentences = {one: phrases.render(level, (one,)) for one in said}
        longest = sorted(said, key=lambda one: cell_len(sentences[one]))[::-1]
        turn = next((one for one in longest if one[0] == "Turn"), None)
        move = next(one for one in longest if one[0] not in ("Turn", "Stop", "Utilize"))
        match level:
            case Level.C1 if turn:
                texts.append((level, (turn, move) * MOST_LEGS + (UTILIZE,)))
            case Level.C2 if turn:
                texts += [(level, (move, turn, move)), (level, (exit_room, move, move))]
            case _:
                texts.append((level, (move, next(one for one in longest if one[0] == "Triage"))))
    return tuple(Guidance(phrases.render(*one), notice) for one in texts)


def lines_needed(phrases: Phrasebook, rooms: Iterable[str], columns: int) -> int:
    """How many rows the bar has, so that nothing said there changes its height."""
    longest = longest_guidance(phrases, rooms)
    return max(len(bar_rows(guidance, columns)) for guidance in longest)


def announces(guidance: Guidance, before: Guidance) -> bool:
    """Whether something is said that was not said before, rather than only taken back."""
    return guidance.notice not in ("", before.notice) or guidance.text not in ("", before.text)


class InstructionBar(Canvas):
    """Shows a Guidance and lets a new one stand out for a moment.

    It settles with the first picture after that moment, not by a timer of its own, so that it
    never takes a paint to itself.
    """

    COMPONENT_CLASSES: ClassVar[set[str]] = {"text", "fresh", "notice"}

    def __init__(self) -> None:
        super().__init__([()] * LINES, id="bar")
        self.lines = LINES
        self.flashes = True
        """Whether new words stand out for a moment."""
        self._guidance = Guidance("")
        self._fresh_until = 0.0

    def show(self, guidance: Guidance | None) -> None:
        """Put `guidance` on the bar."""
        guidance = guidance or Guidance("")
        settles = self._fresh_until > 0 and monotonic() >= self._fresh_until
        if settles:
            self._fresh_until = 0.0
        if guidance != self._guidance:
            if self.flashes and announces(guidance, self._guidance):
                self._fresh_until = monotonic() + FLASH_S
            self._guidance = guidance
            self._draw()
        elif settles:
            self._draw()

    def stand_out(self) -> None:
        """Let what is shown stand out, as if it were new."""
        if self.flashes:
            self._fresh_until = monotonic() + FLASH_S
            self._draw()

    def _draw(self) -> None:
        if self.size.width:
            fresh = self._fresh_until > 0
            by_sentence = not isinstance(self.app, Program) or self.app.look > 1
            rows = bar_rows(
                self._guidance,
                self.size.width,
                fresh=fresh,
                lines=self.lines,
                by_sentence=by_sentence,
            )
            self.draw(rows)

    def on_resize(self) -> None:
        self._draw()
