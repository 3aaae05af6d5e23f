"""Tables described by their row types: what each column means, its unit and its values.

A row is a `msgspec.Struct` whose fields are `Annotated` with `col(...)`. The header of a table,
its codebook and the text of its cells all come from that.
"""

from __future__ import annotations

import types
from collections.abc import Iterator
from dataclasses import dataclass
from enum import Enum
from typing import Annotated, Any, Literal, Union, get_args, get_origin, get_type_hints

import msgspec

DIGITS = 9
"""Real numbers are written with up to this many decimals."""


def col(meaning: str, unit: str = "") -> msgspec.Meta:
    """Describes a field of a row: what it means, and the unit of its values."""
    return msgspec.Meta(description=meaning, extra={"unit": unit})


@dataclass(frozen=True)
class TableColumn:
    """A column of a table. `values` says in words what a cell can hold; if `optional`, a cell may
    be empty."""

    name: str
    meaning: str
    unit: str
    values: str
    optional: bool


def columns(row: type[msgspec.Struct]) -> tuple[TableColumn, ...]:
    """The columns of a table with these rows, in order.

    Raises TypeError, naming the field, if one is not described.
    """
    hints = get_type_hints(row, include_extras=True)
    return tuple(_described(name, hints[name]) for name in row.__struct_fields__)


def cells(row: msgspec.Struct) -> Iterator[str]:
    """The text of a row's cells, in the order of the columns."""
    for name in row.__struct_fields__:
        yield cell(getattr(row, name))


def cell(value: object) -> str:
    """A value as text on one line: empty for None, `true` or `false` for a bool."""
    if value is None:
        return ""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, float):
        return repr(round(value, DIGITS) + 0.0)
    return " ".join(str(value).split())


def _described(name: str, hint: Any) -> TableColumn:
    if get_origin(hint) is not Annotated:
        raise TypeError(f"the column {name} is not described")
    kind, *_, meta = get_args(hint)
    kinds = get_args(kind) if get_origin(kind) in (Union, types.UnionType) else (kind,)
    known = [one for one in kinds if one is not type(None)]
    values = " or ".join(_values(one) for one in known)
    return TableColumn(name, meta.description, meta.extra["unit"], values, len(known) < len(kinds))


def _values(kind: Any) -> str:
    if get_origin(kind) is Literal:
        return ", ".join(map(str, get_args(kind)))
    if isinstance(kind, type) and issubclass(kind, Enum):
        return ", ".join(map(str, (member.value for member in kind)))
    return {bool: "true, false", int: "whole number", float: "number", str: "text"}[kind]
