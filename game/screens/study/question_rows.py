"""How the items of a form are drawn, one function a kind of item: pure."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import zip_longest

from rich.cells import cell_len

from game.forms.items import (
    Answer,
    AnyQuestion,
    ChoiceItem,
    HeadingItem,
    Item,
    NumberItem,
    ScaleItem,
    SliderItem,
    TextItem,
)
from game.screens.widgets.canvas import Row, Run, unbroken, wrapped

CURSOR = "▏"
INDENT = "  "
MOST_NUMBERED = 9
"""So many answers have a digit of their own."""


@dataclass(frozen=True)
class AnswerLook:
    """What of a question is shown: its answer, what was written beside `other`, and, while it is
    the active one, what is being typed and on which answer the mark is, from 0."""

    value: Answer | None = None
    other: str = ""
    active: bool = False
    typing: bool = False
    draft: str | None = None
    mark: int = 0


def item_rows(item: Item, look: AnswerLook, columns: int) -> list[Row]:
    """An item, `columns` wide. Every answer to a slider, scale or number takes as many rows."""
    match item:
        case HeadingItem():
            return [((line, "heading"),) for line in wrapped(item.text, max(10, columns))]
        case SliderItem():
            return slider_rows(item, look, columns)
        case ScaleItem():
            return scale_rows(item, look, columns)
        case ChoiceItem():
            return choice_rows(item, look, columns)
        case NumberItem():
            return number_rows(item, look, columns)
        case TextItem():
            return words_rows(item, look, columns)


def question_rows(question: AnyQuestion, look: AnswerLook, columns: int) -> list[Row]:
    """The question itself; an active one is marked."""
    mark, style = ("▸ ", "active") if look.active else (INDENT, "text")
    lines = wrapped(question.text, max(10, columns - 2))
    return [((mark if n == 0 else INDENT, style), (line, style)) for n, line in enumerate(lines)]


def slider_rows(slider: SliderItem, look: AnswerLook, columns: int) -> list[Row]:
    """The question, the track with its knob, and the names of the ends."""
    value = look.value if isinstance(look.value, int) else None
    rows = question_rows(slider, look, columns)
    track = max(2, columns - 8)
    shown = "–" if value is None else str(value)
    number = f"{shown:>5}{CURSOR if look.typing else ' '}"
    if value is None:
        rows.append(((INDENT, ""), ("─" * track, "faint"), (number, "faint")))
    else:
        at = round((value - slider.least) / (slider.most - slider.least) * (track - 1))
        knob = "knob" if look.active else "set"
        rows.append(
            (
                (INDENT, ""),
                ("━" * at, knob),
                ("●", knob),
                ("─" * (track - 1 - at), "faint"),
                (number, "active" if look.active else "text"),
            )
        )
    return [*rows, *end_rows(slider.low, slider.high, track)]


def end_rows(low: str, high: str, columns: int) -> list[Row]:
    """The names of the ends, each under its own: on a line where they fit, else wrapped."""
    half = columns if cell_len(low) + cell_len(high) + 2 <= columns else max(4, columns // 2 - 2)
    rows: list[Row] = []
    for left, right in zip_longest(wrapped(low, half), wrapped(high, half), fillvalue=""):
        gap = " " * max(0, columns - cell_len(left) - cell_len(right))
        rows.append(((INDENT, ""), (left + gap + right, "quiet")))
    return rows


def scale_rows(scale: ScaleItem, look: AnswerLook, columns: int) -> list[Row]:
    """The question, and its points with their names: side by side, in as many columns where they
    must be wrapped, or below each other where a word would have to be broken."""
    head = question_rows(scale, look, columns)
    numbers = range(1, len(scale.anchors) + 1)
    styles = ["chosen" if n == look.value else "option" for n in numbers]
    signs = ["●" if n == look.value else "○" for n in numbers]
    points = [f" {sign} {name} " for sign, name in zip(signs, scale.anchors, strict=True)]
    if sum(cell_len(point) + 2 for point in points) <= columns:
        side: list[Run] = [(INDENT, "")]
        for point, style in zip(points, styles, strict=True):
            side += [(point, style), (INDENT, "")]
        return [*head, tuple(side)]
    room = (columns - 2) // len(points) - 1
    longest = max(cell_len(piece) for name in scale.anchors for piece in unbroken(name))
    if room - 4 < longest:
        return [
            *head,
            *(
                row
                for point, style in zip(points, styles, strict=True)
                for row in _block(point[:3], point[3:-1], style, columns - 2, indent=2)
            ),
        ]
    blocks = [
        _block(point[:3], point[3:-1], style, room)
        for point, style in zip(points, styles, strict=True)
    ]
    rows: list[Row] = []
    for line in range(max(map(len, blocks))):
        row: list[Run] = [(INDENT, "")]
        for block, style in zip(blocks, styles, strict=True):
            blank: Row = ((" " * room, style),)
            row += [*(block[line] if line < len(block) else blank), (" ", "")]
        rows.append(tuple(row))
    return [*head, *rows]


def choice_rows(choice: ChoiceItem, look: AnswerLook, columns: int) -> list[Row]:
    """The question, and its answers below each other; beside `other` stands what was written."""
    rows = question_rows(choice, look, columns)
    chosen = look.value if isinstance(look.value, tuple) else (look.value,)
    for number, answer in enumerate(choice.anchors, start=1):
        picked = number in chosen
        on = look.active and choice.several and look.mark == number - 1
        signs = ("[x]" if picked else "[ ]") if choice.several else ("(•)" if picked else "( )")
        digit = f"{number}" if look.active and number <= MOST_NUMBERED else " "
        style = "chosen" if picked else "marked" if on else "option"
        words = answer
        if choice.other and number == choice.most and picked:
            written = look.other if look.draft is None else f"{look.draft}{CURSOR}"
            words = f"{answer} {written}"
        pointer = "›" if on else " "
        rows += _block(f"{pointer}{digit} {signs} ", words, style, columns - 2, indent=2)
    return rows


def number_rows(number: NumberItem, look: AnswerLook, columns: int) -> list[Row]:
    """The question, and the number with its unit."""
    typed = ("" if look.value is None else str(look.value)) if look.draft is None else look.draft
    width = max(len(str(number.least)), len(str(number.most))) + 1
    shown = f"{typed}{CURSOR if look.active else ''}".ljust(width)
    return [
        *question_rows(number, look, columns),
        ((INDENT, ""), (f" {shown} ", "field"), (f" {number.unit}", "quiet")),
    ]


def words_rows(words: TextItem, look: AnswerLook, columns: int) -> list[Row]:
    """The question, and what is written, in as many lines as it takes."""
    typed = (str(look.value or "")) if look.draft is None else look.draft
    room = max(10, columns - 4)
    text = f"{typed}{CURSOR if look.active else ''}"
    lines = wrapped(text, room) or [""]
    rows: list[Row] = [
        ((INDENT, ""), (f" {line}{' ' * max(0, room - cell_len(line))} ", "field"))
        for line in lines
    ]
    return [*question_rows(words, look, columns), *rows]


def _block(sign: str, name: str, style: str, columns: int, *, indent: int = 0) -> list[Row]:
    """An answer in lines of `columns`, of which all but the first stand under its name."""
    lead = cell_len(sign)
    lines: Sequence[str] = wrapped(name, max(1, columns - lead - 1)) or [""]
    rows: list[Row] = []
    for number, line in enumerate(lines):
        text = f"{sign if number == 0 else ' ' * lead}{line} "
        filled = text + " " * max(0, columns - cell_len(text))
        rows.append(((" " * indent, ""), (filled, style)) if indent else ((filled, style),))
    return rows
