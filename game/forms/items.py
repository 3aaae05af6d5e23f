"""The kinds of items that a form can have, each a typed value read from `forms.toml`.

An answer is a whole number from `least` to `most` (the point of a slider or scale, the position of
the chosen answer, a number), the positions of all chosen answers, or words.
"""

from __future__ import annotations

import re
from typing import Literal

import msgspec

from game.forms.checks import not_empty, told_apart

Role = Literal["none", "mental_state", "preference", "attention", "demographic"]
"""What an item is for, which decides what the analysis does with it."""

Answer = int | tuple[int, ...] | str

MOST_ANSWERS = 40
MOST_LETTERS = 2_000
OTHER_LENGTH = 200
"""The most characters beside the answer `other`."""
OTHER = "_other"
"""Ends the name under which the words beside the answer `other` are kept."""

IDENTIFIER = re.compile(r"[A-Za-z][A-Za-z0-9_]{0,39}")


class Part(
    msgspec.Struct, frozen=True, forbid_unknown_fields=True, kw_only=True, omit_defaults=True
):
    """Something that is written in `forms.toml`."""


class Condition(Part, frozen=True, kw_only=True):
    """Asks for an earlier answer: one of `is` (positions or values), or one in a range.

    Of a question with several answers, one chosen answer among `is` is enough. A question that was
    not answered, or not asked, fulfils nothing.
    """

    item: str
    is_: int | tuple[int, ...] | None = msgspec.field(default=None, name="is")
    at_least: int | None = None
    at_most: int | None = None

    def __post_init__(self) -> None:
        if self.is_ is None and self.at_least is None and self.at_most is None:
            raise ValueError(f"shown_when {self.item}: give is, at_least or at_most")

    def holds(self, answer: Answer | None) -> bool:
        """Whether the earlier answer is as asked for."""
        if answer is None or isinstance(answer, str):
            return False
        given = answer if isinstance(answer, tuple) else (answer,)
        wanted = (self.is_,) if isinstance(self.is_, int) else self.is_
        return any(
            (wanted is None or value in wanted)
            and (self.at_least is None or value >= self.at_least)
            and (self.at_most is None or value <= self.at_most)
            for value in given
        )


class Weights(Part, frozen=True, kw_only=True):
    """How simulated people answer an item: its middle, the sign of their mood, and how much the
    strains of a mission move it, in points of 1 to 100 (docs/simulated-people.md)."""

    middle: float = 50
    valence: int = 1
    overload: float = 0
    underload: float = 0
    hindered: float = 0
    corrections: float = 0
    switches: float = 0


class HeadingItem(Part, frozen=True, kw_only=True, tag_field="kind", tag="heading"):
    """Words between questions."""

    text: str
    shown_when: Condition | None = None

    def __post_init__(self) -> None:
        not_empty("the text of a heading", self.text)


class QuestionItem(Part, frozen=True, kw_only=True, tag_field="kind"):
    """What all questions have. `right` is the right answer: a value, several of which one is
    enough, or, where several can be chosen, all that must be."""

    id: str
    text: str
    role: Role = "none"
    required: bool = True
    shown_when: Condition | None = None
    right: int | tuple[int, ...] | None = None

    def __post_init__(self) -> None:
        if not IDENTIFIER.fullmatch(self.id):
            raise ValueError(
                f"an id must be letters, digits and _, begin with a letter and have at most 40 "
                f"characters: '{self.id}'"
            )
        not_empty(f"the text of {self.id}", self.text)
        if self.role == "attention" and self.right is None:
            raise ValueError(f"{self.id} has the role attention, so it needs its right answer")
        for value in self.rights:
            if not self.least <= value <= self.most:
                raise ValueError(
                    f"right must be between {self.least} and {self.most}, not {value}: {self.id}"
                )

    @property
    def anchors(self) -> tuple[str, ...]:
        """The words beside the answers: the ends, or every answer."""
        return ()

    @property
    def least(self) -> int:
        """The least answer."""
        return 1

    @property
    def most(self) -> int:
        """The greatest answer."""
        return max(1, len(self.anchors))

    @property
    def rights(self) -> tuple[int, ...]:
        """The right answers."""
        if self.right is None:
            return ()
        return (self.right,) if isinstance(self.right, int) else self.right

    def allows(self, answer: Answer) -> bool:
        """Whether it can be answered so."""
        return isinstance(answer, int) and self.least <= answer <= self.most

    def is_right(self, answer: Answer | None) -> bool:
        """Whether an answer is right; nothing is where there is no right answer."""
        if isinstance(answer, tuple):
            return self.right is not None and set(answer) == set(self.rights)
        return answer in self.rights

    def scored(self, value: int) -> int:
        """An answer as composites count it."""
        return value


class _Reversible(QuestionItem, frozen=True, kw_only=True):
    """`reverse` turns an answer round in composites and in their alpha; tables keep it as given."""

    reverse: bool = False
    weights: Weights | None = None

    def scored(self, value: int) -> int:
        return self.least + self.most - value if self.reverse else value


class SliderItem(_Reversible, frozen=True, kw_only=True, tag="slider"):
    """Answered from `from` (at `low`) to `to` (at `high`), 1 to 100 if not said."""

    low: str
    high: str
    from_: int = msgspec.field(default=1, name="from")
    to: int = 100

    def __post_init__(self) -> None:
        if not self.from_ < self.to:
            raise ValueError(f"from must be below to: {self.id}")
        told_apart("low and high", self.low, self.high)
        super().__post_init__()

    @property
    def anchors(self) -> tuple[str, ...]:
        return self.low, self.high

    @property
    def least(self) -> int:
        return self.from_

    @property
    def most(self) -> int:
        return self.to


class ScaleItem(_Reversible, frozen=True, kw_only=True, tag="scale"):
    """Answered by one of the named points, from 1; without `answers`, those of its form."""

    answers: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        _check_answers(self.id, self.answers)
        super().__post_init__()

    @property
    def anchors(self) -> tuple[str, ...]:
        return self.answers


class ChoiceItem(QuestionItem, frozen=True, kw_only=True, tag="choice"):
    """Answered by one of the answers, or, with `several`, by any number of them. `other` names a
    last answer, beside which something can be written."""

    answers: tuple[str, ...] = ()
    several: bool = False
    other: str = ""

    def __post_init__(self) -> None:
        _check_answers(self.id, self.anchors)
        super().__post_init__()

    @property
    def anchors(self) -> tuple[str, ...]:
        return (*self.answers, self.other) if self.other else self.answers

    def allows(self, answer: Answer) -> bool:
        if not self.several:
            return super().allows(answer)
        return (
            isinstance(answer, tuple)
            and bool(answer)
            and list(answer) == sorted(set(answer))
            and all(self.least <= one <= self.most for one in answer)
        )

    def has_other(self, answer: Answer | None) -> bool:
        """Whether an answer is, or holds, `other`."""
        chosen = answer if isinstance(answer, tuple) else (answer,)
        return bool(self.other) and self.most in chosen


class NumberItem(QuestionItem, frozen=True, kw_only=True, tag="number"):
    """Answered by a whole number from `from` to `to`, in `unit`s."""

    from_: int = msgspec.field(default=0, name="from")
    to: int = 1_000_000
    unit: str = ""

    def __post_init__(self) -> None:
        if not self.from_ < self.to:
            raise ValueError(f"from must be below to: {self.id}")
        super().__post_init__()

    @property
    def anchors(self) -> tuple[str, ...]:
        return (self.unit,) if self.unit else ()

    @property
    def least(self) -> int:
        return self.from_

    @property
    def most(self) -> int:
        return self.to


class TextItem(QuestionItem, frozen=True, kw_only=True, tag="text"):
    """Answered in the participant's own words, at most `length` characters of them."""

    length: int = 200

    def __post_init__(self) -> None:
        if not 1 <= self.length <= MOST_LETTERS:
            raise ValueError(f"length must be between 1 and {MOST_LETTERS}: {self.id}")
        if self.right is not None:
            raise ValueError(f"words have no right answer: {self.id}")
        super().__post_init__()

    def allows(self, answer: Answer) -> bool:
        return isinstance(answer, str) and len(answer) <= self.length


AnyQuestion = SliderItem | ScaleItem | ChoiceItem | NumberItem | TextItem
Item = AnyQuestion | HeadingItem


def _check_answers(identifier: str, answers: tuple[str, ...]) -> None:
    if not 2 <= len(answers) <= MOST_ANSWERS:
        raise ValueError(
            f"{identifier} must have from 2 to {MOST_ANSWERS} answers, not {len(answers)}"
        )
    told_apart("the answers", *answers)
