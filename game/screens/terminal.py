"""What the terminal says of itself in the environment."""

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import Literal

from game.screens.preferences import Ground
from game.session.records import Terminal

Colours = Literal["none", "16", "256", "truecolor"]


def this_terminal(columns: int, rows: int) -> Terminal:
    """The terminal that the program runs in, as journals describe it."""
    return Terminal(os.environ.get("TERM", ""), os.environ.get("COLORTERM", ""), columns, rows)


def colours(environ: Mapping[str, str]) -> Colours:
    """How many colours it has, or the user wants: none with NO_COLOR (no-color.org)."""
    if "NO_COLOR" in environ:
        return "none"
    if environ.get("COLORTERM", "").strip().lower() in ("truecolor", "24bit"):
        return "truecolor"
    many = environ.get("TERM", "").endswith(("-256color", "-kitty"))
    return "256" if many else "16"


def ground(environ: Mapping[str, str]) -> Ground:
    """Its own background, where it tells (COLORFGBG); else dark."""
    return "light" if environ.get("COLORFGBG", "").rpartition(";")[2] in ("7", "15") else "dark"
