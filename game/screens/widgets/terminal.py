"""What the terminal says of itself in the environment.

It is asked before anything else of the screens is imported, and so imports none of it itself.
"""

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import TYPE_CHECKING, Literal

if TYPE_CHECKING:
    from game.journal.records import Terminal
    from game.screens.widgets.preferences import Ground

Colours = Literal["none", "16", "256", "truecolor"]


def this_terminal(columns: int, rows: int) -> Terminal:
    """The terminal that the program runs in, as journals describe it."""
    from game.journal.records import Terminal

    return Terminal(os.environ.get("TERM", ""), os.environ.get("COLORTERM", ""), columns, rows)


def colours(environ: Mapping[str, str]) -> Colours:
    """How many colours it has, or the user wants: none with NO_COLOR (no-color.org).

    Within GNU screen (`TERM` begins so), COLORTERM speaks of the terminal around it, and does not
    count: screen 4 misreads 24-bit colours.
    """
    if "NO_COLOR" in environ:
        return "none"
    term = environ.get("TERM", "")
    told = environ.get("COLORTERM", "").strip().lower()
    if told in ("truecolor", "24bit") and not term.startswith("screen"):
        return "truecolor"
    return "256" if "-256color" in term or term.endswith("-kitty") else "16"


def colour_system(environ: Mapping[str, str]) -> str:
    """What Textual is to send, in its own words: the value of TEXTUAL_COLOR_SYSTEM."""
    found = colours(environ)
    return "standard" if found in ("none", "16") else found


def ground(environ: Mapping[str, str]) -> Ground:
    """Its own background, where it tells (COLORFGBG); else dark."""
    return "light" if environ.get("COLORFGBG", "").rpartition(";")[2] in ("7", "15") else "dark"
