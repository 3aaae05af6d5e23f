"""What a study's forms add to its tables: columns for its items, and what analyses do with them.

The paper's items have their columns in `game.tables.rows`; a study that asks nothing else has no
other columns. Answers to items after each mission are columns of `rounds`, all others of
`participants`. What is written in own words is in `freetext` alone.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import lru_cache
from typing import Annotated, Any, Literal, cast

import msgspec

from game.forms.form import CHECK, EACH, Composite, Form, Forms, Place
from game.forms.items import AnyQuestion, ChoiceItem, NumberItem, ScaleItem, SliderItem, TextItem
from game.forms.reading import FormsError
from game.journal.history import History, Step
from game.tables.columns import col
from game.tables.rows import ParticipantRow, RoundRow, TableRow

TableName = Literal["participants", "rounds"]
FAILED = "attention_failed"
"""The column that counts wrong answers to attention checks."""
PAPER_RANGES: Mapping[str, tuple[int, int]] = {
    **dict.fromkeys(("engagement", "confidence", "frustration", "confusion"), (1, 100)),
    **dict.fromkeys(("pref1", "pref2", "pref3", "pref4"), (1, 5)),
}
PREFERENCE = "preference"


@dataclass(frozen=True)
class AskedColumn:
    """A column for an item, for one answer to an item that can have several (`option`), or for a
    composite, asked at `place` in the form `form`."""

    name: str
    form: Form
    place: Place
    item: AnyQuestion | Composite
    option: int = 0

    @property
    def table(self) -> TableName:
        return "rounds" if self.place == EACH else "participants"

    @property
    def kind(self) -> Any:
        """The type of its cells, with what they mean."""
        item = self.item
        if isinstance(item, Composite):
            return Annotated[float | None, col(_sentence(item.meaning) or _composite(item))]
        if self.option:
            answer = item.anchors[self.option - 1]
            return Annotated[bool | None, col(f"{_asked(item)} Whether '{answer}' was marked.")]
        return Annotated[int | None, col(f"{_asked(item)} {_answers(item)}", _unit(item))]

    def value(self, history: History, round_: int) -> float | int | bool | None:
        """Its cell for a session, in a round (0 for the table of participants)."""
        step = Step(self.form.phase(self.place), round_)
        if isinstance(self.item, Composite):
            found = self.item.value(_scored(self.form, history, step))
            whole = found is not None and found == int(found)
            return int(found) if whole and found is not None else found
        answer = history.answer(step, self.item.id)
        if self.option:
            return self.option in answer if isinstance(answer, tuple) else None
        return answer if isinstance(answer, int) else None


def _scored(form: Form, history: History, step: Step) -> dict[str, int]:
    given = ((it, history.answer(step, it.id)) for it in form.questions)
    return {it.id: it.scored(answer) for it, answer in given if isinstance(answer, int)}


@lru_cache(8)
def asked_columns(forms: Forms) -> tuple[AskedColumn, ...]:
    """Every column that the forms of a study have, those of the paper's items included.

    Raises FormsError where an id is the name of another column.
    """
    columns = tuple(_columns(forms))
    taken = {"participants": ParticipantRow, "rounds": RoundRow}
    for column in columns:
        known = column.name in taken[column.table].__struct_fields__ or column.name == FAILED
        of_paper = column.table == "rounds" and column.name in (*PAPER_RANGES, PREFERENCE)
        if known and not of_paper:
            raise FormsError(
                f"the id {column.name} is the name of another column of the table {column.table}",
                place=f"form {column.form.id}",
                hint="Choose another id",
            )
    return columns


def _columns(forms: Forms) -> Iterator[AskedColumn]:
    for form in forms.forms:
        for place in form.places:
            if place == CHECK:
                continue
            end = "" if len(form.places) == 1 else f"_{place.replace(' ', '_')}"
            for item in form.questions:
                if isinstance(item, ChoiceItem) and item.several:
                    for option in range(1, item.most + 1):
                        name = f"{item.id}_{option}{end}"
                        yield AskedColumn(name, form, place, item, option)
                elif not isinstance(item, TextItem):
                    yield AskedColumn(item.id + end, form, place, item)
            for composite in form.composites:
                yield AskedColumn(composite.id + end, form, place, composite)


def wider(
    types: Mapping[str, type[TableRow]], columns: tuple[AskedColumn, ...], *, attention: bool
) -> dict[str, type[TableRow]]:
    """The row types with the columns of a study's forms; the same where it asks what the paper
    asked."""
    found = dict(types)
    for table in ("participants", "rounds"):
        row = types[table]
        more = [
            (column.name, column.kind, None)
            for column in columns
            if column.table == table and not _has(row, column)
        ]
        if attention and table == "participants":
            more.append((FAILED, Annotated[int | None, col(_FAILED)], None))
        if more:
            made = msgspec.defstruct(
                row.__name__, more, bases=(row,), namespace={"__doc__": row.__doc__},
                module=row.__module__, frozen=True, kw_only=True,
            )  # fmt: skip
            found[table] = cast("type[TableRow]", made)
    return found


_FAILED = "Attention checks that were answered wrongly, over all forms."


def _has(row: type[TableRow], column: AskedColumn) -> bool:
    """Whether a row has the column already, with the range that the paper gave it."""
    if column.name not in row.__struct_fields__:
        return False
    if isinstance(column.item, Composite):
        return column.name == PREFERENCE and column.item.items == tuple(PAPER_RANGES)[4:]
    return PAPER_RANGES.get(column.name) == (column.item.least, column.item.most)


def attention_failed(forms: Forms, history: History) -> int | None:
    """How many attention checks were answered wrongly; None where the study has none."""
    checks = [
        (form, place, it)
        for form in forms.forms
        for place in form.places
        for it in form.questions
        if it.role == "attention"
    ]
    if not checks:
        return None
    failed = 0
    for form, place, item in checks:
        phase = form.phase(place)
        for step in {step for step in history.phases if step.phase == phase}:
            answer = history.answer(step, item.id)
            failed += answer is not None and not item.is_right(answer)
    return failed


@dataclass(frozen=True)
class Outcomes:
    """What analyses take of the answers after each mission: the mental states, the composites with
    their items, the ends of every item, and those that are turned round."""

    mental_states: tuple[str, ...]
    composites: Mapping[str, tuple[str, ...]]
    ranges: Mapping[str, tuple[int, int]]
    reversed_items: frozenset[str] = frozenset()


def outcomes_of(forms: Forms) -> Outcomes:
    """The outcomes of a study's forms."""
    states: list[str] = []
    composites: dict[str, tuple[str, ...]] = {}
    ranges: dict[str, tuple[int, int]] = {}
    turned: set[str] = set()
    for column in asked_columns(forms):
        if column.table != "rounds" or column.option:
            continue
        item = column.item
        if isinstance(item, Composite):
            composites[column.name] = item.items
        elif isinstance(item, SliderItem | ScaleItem | NumberItem):
            ranges[column.name] = item.least, item.most
            if item.role == "mental_state":
                states.append(column.name)
            if getattr(item, "reverse", False):
                turned.add(column.name)
    return Outcomes(tuple(states), composites, ranges, frozenset(turned))


def _asked(item: AnyQuestion) -> str:
    return f"Answer to: {_sentence(item.text)}"


def _answers(item: AnyQuestion) -> str:
    match item:
        case SliderItem():
            ends = f"{item.least} ({item.low}) to {item.most} ({item.high})."
            return ends + (" Turned round in composites." if item.reverse else "")
        case NumberItem():
            return f"{item.least} to {item.most}."
        case _:
            named = "; ".join(f"{n} {answer}" for n, answer in enumerate(item.anchors, start=1))
            turned = isinstance(item, ScaleItem) and item.reverse
            return f"{named}." + (" Turned round in composites." if turned else "")


def _unit(item: AnyQuestion) -> str:
    return item.unit if isinstance(item, NumberItem) else ""


def _composite(composite: Composite) -> str:
    what = f"The {composite.of} of {', '.join(composite.items)}"
    less = f", less {composite.minus:g}" if composite.minus else ""
    return f"{what}{less}{f', times {composite.times:g}' if composite.times != 1 else ''}."


def _sentence(text: str) -> str:
    plain = " ".join(text.split())
    return plain if not plain or plain[-1] in ".?!:" else f"{plain}."
