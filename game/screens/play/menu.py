"""A menu of lines, some of which hold a choice."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

from game.screens.widgets.canvas import Row


class Item(NamedTuple):
    """A line of the menu; a `choice` changes with left and right, a `note` stands there."""

    action: str
    text: str
    choice: str = ""
    note: str = ""


def menu_rows(items: Sequence[Item], selected: int) -> list[Row]:
    """The menu as a block of equally wide rows."""
    rows: list[Row] = []
    for number, item in enumerate(items):
        chosen = number == selected
        choice = f"‹ {item.choice} ›" if item.choice else item.note
        text = f" {'▸' if chosen else ' '} {item.text:<15}{choice}"
        rows.append(((f"{text:<48}", "selected" if chosen else "item"),))
    return rows


def after(names: Sequence[Any], name: object, way: int) -> Any:
    """The choice that follows `name`, or with `way` -1 the one before; after the last the first."""
    return names[(names.index(name) + way) % len(names)]
