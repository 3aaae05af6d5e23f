"""A menu of lines, some of which hold a choice."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

from game.screens.widgets.canvas import Row

_COLUMNS = 56
"""A menu is at least as wide, so that it stands still while its choices change."""


class Item(NamedTuple):
    """A line of the menu; a `choice` changes with left and right, a `note` stands there."""

    action: str
    text: str
    choice: str = ""
    note: str = ""


def menu_rows(items: Sequence[Item], selected: int) -> list[Row]:
    """The menu as a block of equally wide rows."""
    lines = [
        f" {'▸' if number == selected else ' '} {item.text:<16}"
        + (f"‹ {item.choice} ›" if item.choice else item.note)
        for number, item in enumerate(items)
    ]
    columns = max(_COLUMNS, *(len(line) + 1 for line in lines))
    return [
        ((f"{line:<{columns}}", "selected" if number == selected else "item"),)
        for number, line in enumerate(lines)
    ]


def after(names: Sequence[Any], name: object, way: int) -> Any:
    """The choice that follows `name`, or with `way` -1 the one before; after the last the first."""
    return names[(names.index(name) + way) % len(names)]
