"""What every kind of cell looks like: one table for the office, the help and the maps.

A cell of the office is two columns wide, or four and two rows high where there is room. Kinds
differ in shape as well as colour; where colours are few or none (`PLAIN`), every kind has a shape
of its own.
"""

from __future__ import annotations

from enum import IntEnum
from typing import NamedTuple

from game.world.building import Severity
from game.world.geometry import Heading
from game.world.observation import VictimState


class Kind(IntEnum):
    """What a cell of the office shows.

    The first nine are tile + 3 x explored + 3 x visible, which the office view relies on.
    """

    DARK = 0
    DARK_WALL = 1
    DARK_DOOR = 2
    SEEN_FLOOR = 3
    SEEN_WALL = 4
    SEEN_DOOR = 5
    FLOOR = 6
    WALL = 7
    DOOR = 8
    RED = 9
    BLUE = 10
    RESCUED = 11
    EXPIRED = 12
    SEEN_RED = 13
    SEEN_BLUE = 14
    SEEN_RESCUED = 15
    SEEN_EXPIRED = 16
    TREATED_RED = 17
    TREATED_BLUE = 18
    PLAYER_NORTH = 19
    PLAYER_EAST = 20
    PLAYER_SOUTH = 21
    PLAYER_WEST = 22
    ON_RED_NORTH = 23
    ON_RED_EAST = 24
    ON_RED_SOUTH = 25
    ON_RED_WEST = 26
    ON_BLUE_NORTH = 27
    ON_BLUE_EAST = 28
    ON_BLUE_SOUTH = 29
    ON_BLUE_WEST = 30


class Glyph(NamedTuple):
    """Two characters and the component class that colours them."""

    text: str
    style: str


HEADING_GLYPHS = {
    Heading.NORTH: "◢◣",
    Heading.EAST: "━▶",
    Heading.SOUTH: "◥◤",
    Heading.WEST: "◀━",
}
HEADING_ARROWS = {
    Heading.NORTH: "▲",
    Heading.EAST: "▶",
    Heading.SOUTH: "▼",
    Heading.WEST: "◀",
}
HEADING_NAMES = {
    Heading.NORTH: "north",
    Heading.EAST: "east",
    Heading.SOUTH: "south",
    Heading.WEST: "west",
}

GlyphSet = tuple[Glyph, ...]
"""Glyphs by kind."""


def _players(first: Kind, style: str) -> dict[Kind, Glyph]:
    return {Kind(first + way): Glyph(HEADING_GLYPHS[way], style) for way in Heading}


_FIGURES = {
    Kind.RED: Glyph("◖◗", "red"),
    Kind.BLUE: Glyph("()", "blue"),
    Kind.RESCUED: Glyph("✓ ", "rescued"),
    Kind.EXPIRED: Glyph("✗ ", "expired"),
    Kind.SEEN_RED: Glyph("◖◗", "seen-red"),
    Kind.SEEN_BLUE: Glyph("()", "seen-blue"),
    Kind.SEEN_RESCUED: Glyph("✓ ", "seen-rescued"),
    Kind.SEEN_EXPIRED: Glyph("✗ ", "seen-expired"),
    Kind.TREATED_RED: Glyph("◖◗", "treated-red"),
    Kind.TREATED_BLUE: Glyph("()", "treated-blue"),
    **_players(Kind.PLAYER_NORTH, "player"),
    **_players(Kind.ON_RED_NORTH, "on-red"),
    **_players(Kind.ON_BLUE_NORTH, "on-blue"),
}


def _glyph_set(tiles: dict[Kind, Glyph]) -> GlyphSet:
    dark = Glyph("  ", "dark")
    return tuple((tiles | _FIGURES).get(kind, dark) for kind in Kind)


SOLID = _glyph_set(
    {
        Kind.SEEN_FLOOR: Glyph("  ", "seen-floor"),
        Kind.SEEN_WALL: Glyph("  ", "seen-wall"),
        Kind.SEEN_DOOR: Glyph("▐▌", "seen-door"),
        Kind.FLOOR: Glyph("· ", "floor"),
        Kind.WALL: Glyph("  ", "wall"),
        Kind.DOOR: Glyph("▐▌", "door"),
    }
)
"""Grounds of many colours: walls and floor are filled, a door stands in the middle of its cell."""

PLAIN = _glyph_set(
    {
        Kind.SEEN_FLOOR: Glyph(" .", "seen-floor"),
        Kind.SEEN_WALL: Glyph("▒▒", "seen-wall"),
        Kind.SEEN_DOOR: Glyph("::", "seen-door"),
        Kind.FLOOR: Glyph("· ", "floor"),
        Kind.WALL: Glyph("██", "wall"),
        Kind.DOOR: Glyph("[]", "door"),
    }
)
"""Sixteen colours, or none: tiles are drawn."""


class CellSize(NamedTuple):
    """How many of the terminal's cells one of the office takes."""

    columns: int
    rows: int


NORMAL, LARGE = CellSize(2, 1), CellSize(4, 2)

_LARGE_FIGURES = {
    "◖◗": ("▗██▖", "▝██▘"),
    "()": ("╭──╮", "╰──╯"),
    "✓ ": (" ✓  ", "    "),
    "✗ ": (" ✗  ", "    "),
    HEADING_GLYPHS[Heading.NORTH]: (" ▗▖ ", "▟██▙"),
    HEADING_GLYPHS[Heading.EAST]: (" ▙▖ ", " ▛▘ "),
    HEADING_GLYPHS[Heading.SOUTH]: ("▜██▛", " ▝▘ "),
    HEADING_GLYPHS[Heading.WEST]: (" ▗▟ ", " ▝▜ "),
    "▐▌": ("▐██▌", "▐██▌"),
    "[]": ("[  ]", "[  ]"),
    "· ": ("·   ", "    "),
    " .": ("   .", "    "),
}
"""The two rows of a large cell, by the text of a normal one; any other text is repeated."""


def rows_of(glyphs: GlyphSet, size: CellSize) -> tuple[GlyphSet, ...]:
    """The glyphs of each row of a cell of that size, from the top."""
    if size == NORMAL:
        return (glyphs,)
    return tuple(
        tuple(
            glyph._replace(text=_LARGE_FIGURES.get(glyph.text, (2 * glyph.text,) * 2)[row])
            for glyph in glyphs
        )
        for row in range(size.rows)
    )


STYLES = frozenset(glyph.style for glyph in SOLID)
"""The component classes that a widget needs to draw glyphs."""

_VICTIMS = {
    VictimState.WAITING: {Severity.RED: Kind.RED, Severity.BLUE: Kind.BLUE},
    VictimState.RESCUED: {Severity.RED: Kind.RESCUED, Severity.BLUE: Kind.RESCUED},
    VictimState.EXPIRED: {Severity.RED: Kind.EXPIRED, Severity.BLUE: Kind.EXPIRED},
}


def victim_kind(severity: Severity, state: VictimState, *, in_view: bool = True) -> Kind:
    """How a victim is drawn, in view or as remembered."""
    kind = _VICTIMS[state][severity]
    return kind if in_view else Kind(kind + (Kind.SEEN_RED - Kind.RED))


def treated_kind(severity: Severity) -> Kind:
    """How a victim is drawn while it is treated."""
    return Kind.TREATED_RED if severity is Severity.RED else Kind.TREATED_BLUE


def player_kind(heading: Heading, victim: Severity | None = None) -> Kind:
    """The rescuer, perhaps standing on a waiting victim."""
    first = {
        None: Kind.PLAYER_NORTH,
        Severity.RED: Kind.ON_RED_NORTH,
        Severity.BLUE: Kind.ON_BLUE_NORTH,
    }
    return Kind(first[victim] + heading)
