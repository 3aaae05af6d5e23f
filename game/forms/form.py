"""Forms: where each is asked, its items in order, and what is computed from the answers."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Literal, NamedTuple

import msgspec

from game.forms.items import (
    IDENTIFIER,
    OTHER,
    Answer,
    AnyQuestion,
    ChoiceItem,
    HeadingItem,
    Item,
    NumberItem,
    Part,
    ScaleItem,
    SliderItem,
    TextItem,
)
from game.journal.records import PROTOCOL_PHASES

Place = Literal[
    "before", "in practice", "after practice", "after each mission", "after both", "at the end"
]
"""Where a form is asked: after the consent, at the end of practice with a word on each answer,
after practice, after each mission, after the last mission's forms, and before the debriefing."""

EACH = "after each mission"
CHECK: Place = "in practice"

Repeats = Literal["each", "first", "last"]


class Composite(Part, frozen=True, kw_only=True):
    """A value computed from the answers to `items` of one form: their `sum` or `mean`, turned round
    where they are reversed, less `minus`, times `times`. It is empty unless all were answered."""

    id: str
    items: tuple[str, ...]
    of: Literal["sum", "mean"] = "mean"
    minus: float = 0
    times: float = 1
    meaning: str = ""

    def value(self, scored: Mapping[str, int]) -> float | None:
        """The value for answers that were turned round already."""
        if any(item not in scored for item in self.items):
            return None
        total = sum(scored[item] for item in self.items)
        whole = total if self.of == "sum" else total / len(self.items)
        return (whole - self.minus) * self.times


class Form(Part, frozen=True, kw_only=True):
    """A page of items. `answers` are those of its scales that name none. `repeats` says after which
    missions it is asked. `source` cites the instrument; participants do not see it."""

    id: str
    place: Place | tuple[Place, ...]
    title: str = ""
    body: str = ""
    source: str = ""
    order: Literal["fixed", "drawn"] = "fixed"
    repeats: Repeats = "each"
    answers: tuple[str, ...] = ()
    items: tuple[Item, ...] = msgspec.field(name="item")
    composites: tuple[Composite, ...] = msgspec.field(default=(), name="composite")

    def __post_init__(self) -> None:
        if not IDENTIFIER.fullmatch(self.id):
            raise ValueError(
                f"an id must be letters, digits and _, begin with a letter and have at most 40 "
                f"characters: '{self.id}'"
            )
        if self.id in PROTOCOL_PHASES:
            raise ValueError(f"{self.id} is a phase of the study; give the form another id")
        if not self.places or len(set(self.places)) < len(self.places):
            raise ValueError(f"the form {self.id} needs places, each once")
        if not self.questions:
            raise ValueError(f"the form {self.id} has no question")
        if self.repeats != "each" and EACH not in self.places:
            raise ValueError(f"repeats is for forms that are asked {EACH}: {self.id}")
        if CHECK in self.places and not all(
            isinstance(it, ChoiceItem) and not it.several and it.right for it in self.items
        ):
            raise ValueError(
                f"a form that is asked {CHECK} has questions of the kind choice with a right "
                f"answer alone: {self.id}"
            )

    def check_composites(self) -> None:
        """Raise ValueError for a composite of what cannot be counted."""
        numbered = {
            it.id for it in self.questions if isinstance(it, SliderItem | ScaleItem | NumberItem)
        }
        for composite in self.composites:
            if not IDENTIFIER.fullmatch(composite.id):
                raise ValueError(
                    f"an id must be letters, digits and _, and begin with a letter: "
                    f"'{composite.id}'"
                )
            for item in composite.items:
                if item not in numbered:
                    raise ValueError(
                        f"the composite {composite.id} counts {item}, which is no slider, scale or "
                        f"number of the form {self.id}"
                    )
            if not composite.items or len(set(composite.items)) < len(composite.items):
                raise ValueError(f"the composite {composite.id} needs items, each once")

    @property
    def places(self) -> tuple[Place, ...]:
        return (self.place,) if isinstance(self.place, str) else self.place

    @property
    def questions(self) -> tuple[AnyQuestion, ...]:
        """The items that are answered, in the order of the file."""
        return tuple(it for it in self.items if not isinstance(it, HeadingItem))

    def phase(self, place: Place) -> str:
        """The name that the journal gives to the phase in which it is asked at `place`: its id,
        and, if there are several places, which."""
        return self.id if len(self.places) == 1 else f"{self.id}.{place.replace(' ', '_')}"

    def after(self, round_: int, rounds: int) -> bool:
        """Whether it is asked after the mission of round `round_` of `rounds`."""
        return {"each": True, "first": round_ == 1, "last": round_ == rounds}[self.repeats]

    def in_order(self, drawn: Callable[[Sequence[tuple[Item, ...]]], Sequence[tuple[Item, ...]]]
                 ) -> tuple[Item, ...]:  # fmt: skip
        """The items as they are shown. Where the order is drawn, `drawn` shuffles the items between
        two headings; one that depends on another of the form follows it."""
        if self.order == "fixed":
            return self.items
        shown: list[Item] = []
        for block in self._blocks():
            if isinstance(block[0][0], HeadingItem):
                shown += block[0]
            else:
                shown += [item for group in drawn(block) for item in group]
        return tuple(shown)

    def _blocks(self) -> Iterator[list[tuple[Item, ...]]]:
        """Headings alone, and between them questions, each with those that depend on it."""
        block: list[tuple[Item, ...]] = []
        for item in self.items:
            if isinstance(item, HeadingItem):
                if block:
                    yield block
                yield [(item,)]
                block = []
                continue
            after = item.shown_when.item if item.shown_when else None
            place = next(
                (n for n, group in enumerate(block) if after in {_id(one) for one in group}), None
            )
            if place is None:
                block.append((item,))
            else:
                block[place] = (*block[place], item)
        if block:
            yield block


class Occasion(NamedTuple):
    """A form where it is asked."""

    form: Form
    place: Place


class Forms(Part, frozen=True, kw_only=True):
    """forms.toml: everything that participants are asked."""

    version: str
    forms: tuple[Form, ...] = msgspec.field(default=(), name="form")

    def __post_init__(self) -> None:
        ids = [form.id for form in self.forms]
        _once("forms", ids)
        names = [it.id for form in self.forms for it in form.questions]
        names += [composite.id for form in self.forms for composite in form.composites]
        _once("items", names)
        for name in names:
            if name.endswith(OTHER) and name.removesuffix(OTHER) in names:
                raise ValueError(f"the id {name} is taken by the words beside an answer")
        if sum(CHECK in form.places for form in self.forms) > 1:
            raise ValueError(f"two forms are asked {CHECK}; join them")
        for form in self.forms:
            form.check_composites()
        self._check_conditions()

    def _check_conditions(self) -> None:
        earlier: dict[str, AnyQuestion] = {}
        for form in self.forms:
            for item in form.items:
                condition = item.shown_when
                if condition is not None:
                    asked = earlier.get(condition.item)
                    name = "a heading" if isinstance(item, HeadingItem) else item.id
                    if asked is None:
                        raise ValueError(
                            f"{name} is shown when {condition.item} has an answer, but no earlier "
                            "item has this id"
                        )
                    _check_condition(name, asked, condition.is_)
                if not isinstance(item, HeadingItem):
                    earlier[item.id] = item

    @property
    def check(self) -> Form | None:
        """The form that ends practice."""
        return next((form for form in self.forms if CHECK in form.places), None)

    @property
    def questions(self) -> dict[str, AnyQuestion]:
        """Every question by its id."""
        return {it.id: it for form in self.forms for it in form.questions}

    def at(self, place: Place) -> tuple[Occasion, ...]:
        """What is asked at a place, in order."""
        return tuple(Occasion(form, place) for form in self.forms if place in form.places)

    def occasion(self, phase: str) -> Occasion:
        """What is asked in a phase of the journal. Raises KeyError for any other phase."""
        for form in self.forms:
            for place in form.places:
                if form.phase(place) == phase:
                    return Occasion(form, place)
        raise KeyError(phase)


def shown(items: Sequence[Item], answer_to: Callable[[str], Answer | None]) -> tuple[Item, ...]:
    """The items that are shown, given the answers so far. An item that depends on one that is not
    shown is not shown either."""
    hidden: set[str] = set()
    seen: list[Item] = []
    for item in items:
        condition = item.shown_when
        if condition is None or (
            condition.item not in hidden and condition.holds(answer_to(condition.item))
        ):
            seen.append(item)
        elif not isinstance(item, HeadingItem):
            hidden.add(item.id)
    return tuple(seen)


def _id(item: Item) -> str:
    return "" if isinstance(item, HeadingItem) else item.id


def _once(what: str, ids: Sequence[str]) -> None:
    for identifier in ids:
        if ids.count(identifier) > 1:
            raise ValueError(
                f"two {what} have the id {identifier}; delete one of them, or give it another id"
            )


def _check_condition(name: str, asked: AnyQuestion, wanted: int | tuple[int, ...] | None) -> None:
    if isinstance(asked, TextItem):
        raise ValueError(f"{name} cannot depend on the words of {asked.id}")
    for value in (wanted,) if isinstance(wanted, int) else wanted or ():
        if not asked.least <= value <= asked.most:
            raise ValueError(
                f"{name} is shown when {asked.id} is {value}, but its answers go from "
                f"{asked.least} to {asked.most}"
            )
