"""A building as text in the building format: the inverse of reading."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from string import ascii_letters, digits

from game.world.building import Building, Severity
from game.world.geometry import Cell
from game.world.reading import COMMENT, TILE_GLYPHS

_START_GLYPH = ">"
_VICTIM_GLYPHS = {Severity.RED: "*", Severity.BLUE: "o"}
_TAKEN = {_START_GLYPH, COMMENT, *_VICTIM_GLYPHS.values(), *TILE_GLYPHS}
_LATIN = (chr(code) for code in range(0xC0, 0x250))
_ROOM_GLYPHS = [glyph for glyph in (*ascii_letters, *digits, *_LATIN) if glyph not in _TAKEN]
_DRAWN = bytes.maketrans(bytes(TILE_GLYPHS.values()), "".join(TILE_GLYPHS).encode("ascii"))


def render_building(building: Building) -> str:
    """The text of a building; reading it gives an equal building, except for `text`.

    Raises ValueError if there are more rooms than glyphs, or if a room has no free cell for one.
    """
    if len(building.rooms) > len(_ROOM_GLYPHS):
        raise ValueError(f"{len(building.rooms)} rooms, but only {len(_ROOM_GLYPHS)} glyphs")
    plan = building.plan
    drawn = plan.tiles.translate(_DRAWN).decode("ascii")
    grid = [list(drawn[at : at + plan.width]) for at in range(0, len(drawn), plan.width)]

    def draw(cell: Cell, glyph: str) -> None:
        grid[cell[1]][cell[0]] = glyph

    legend = [f"{_START_GLYPH} = start facing {building.start_heading.name.lower()}"]
    draw(building.start, _START_GLYPH)
    for severity, glyph in _VICTIM_GLYPHS.items():
        lying = [victim.cell for victim in building.victims if victim.severity is severity]
        if lying:
            legend.append(f"{glyph} = {severity} victim")
        for cell in lying:
            draw(cell, glyph)
    occupied = {building.start, *(victim.cell for victim in building.victims)}
    for glyph, room in zip(_ROOM_GLYPHS, building.rooms, strict=False):
        free = [cell for cell in room.cells if cell not in occupied]
        if not free:
            raise ValueError(f"{room.name} has no free cell for its glyph")
        draw(_nearest(free, room.label), glyph)
        legend.append(f"{glyph} = room {room.name}")
    rows = ("".join(row) for row in grid)
    return "\n".join([f"name: {building.name}", "", "plan:", *rows, "", "legend:", *legend, ""])


def with_own_text(building: Building) -> Building:
    """The building with `text` rendered from it."""
    return replace(building, text=render_building(building))


def _nearest(cells: Iterable[Cell], to: Cell) -> Cell:
    return min(cells, key=lambda cell: (abs(cell[0] - to[0]) + abs(cell[1] - to[1]), cell))
