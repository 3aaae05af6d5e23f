"""Corridors first: how they divide a floor into the blocks that hold the rooms.

A floor is cut by parallel corridors, and each piece by corridors across those, so that every
corridor joins the one before. A scheme says how many there are at each step.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from random import Random
from typing import NamedTuple

from game.world.generation.area import Area

CORRIDOR = 2
"""How wide a corridor is, in cells."""
SHALLOWEST = 8
"""The least depth of a block, in cells."""
_CLEARANCE = CORRIDOR + 2
"""A corridor with the walls on both its sides."""
_BLIND = 0.35
"""How often a corridor ends at a room in place of the outer wall."""
_END_ROOM = (7, 9)
"""The depth of such a room, in cells."""
_END_WIDTH = 45
"""The greatest width of such a room."""


class Layout(NamedTuple):
    """The corridors of a floor, and the blocks between them."""

    corridors: tuple[Area, ...]
    blocks: tuple[Area, ...]


@dataclass(frozen=True)
class _Cut:
    """How a piece is cut: into strips of about these `weights`, and each strip by one of its
    choices in `across`, with corridors the other way. No cuts: the strip is a block."""

    weights: tuple[float, ...]
    across: tuple[tuple[_Cut | None, ...], ...]


_HALVES = _Cut((1, 1), ((None,), (None,)))
_THIRDS = _Cut((1, 1, 1), ((None,), (None,), (None,)))
_FORKED = _Cut((1, 1), ((None, _HALVES), (None, _HALVES)))
_COMB = _Cut((1, 1, 1), ((None, _HALVES), (None, _HALVES), (None, _HALVES)))
_SCHEMES: tuple[tuple[bool, _Cut], ...] = (
    # A long main hallway, with side corridors up and down.
    (False, _Cut((1, 1), ((_COMB, _THIRDS, _FORKED), (_COMB, _THIRDS, _FORKED)))),
    # A ring round a core, with rooms along the outer walls.
    (False, _Cut((1, 2.1, 1), ((None, _HALVES), (_COMB, _THIRDS, _FORKED), (None, _HALVES)))),
    # Two hallways from end to end, joined like a ladder.
    (True, _Cut((1, 1.5, 1), ((_FORKED, _HALVES), (_HALVES, _THIRDS), (_FORKED, _HALVES)))),
    # A spine with wings to both sides.
    (True, _Cut((1, 1), ((_THIRDS, _FORKED), (_THIRDS, _FORKED)))),
)


class _Piece(NamedTuple):
    """A part of the floor, and whether a corridor runs along its west, north, east and south."""

    area: Area
    west: bool = False
    north: bool = False
    east: bool = False
    south: bool = False

    def turned(self) -> _Piece:
        """The piece with x and y exchanged."""
        return _Piece(self.area.turned(), self.north, self.west, self.south, self.east)


def lay_out(width: int, height: int, random: Random) -> Layout | None:
    """A floor of `width` x `height` cells, outer walls included; None where no room is left for
    what was drawn by lot."""
    upright, cut = random.choice(_SCHEMES)
    corridors: list[Area] = []
    blocks: list[Area] = []
    floor = _Piece(Area(1, 1, width - 2, height - 2))
    fits = _divide(floor, cut, upright, random, corridors, blocks)
    return Layout(tuple(corridors), tuple(blocks)) if fits else None


def _divide(
    piece: _Piece,
    cut: _Cut | None,
    upright: bool,
    random: Random,
    corridors: list[Area],
    blocks: list[Area],
) -> bool:
    """Cut a piece by corridors that run up and down if `upright`, else from side to side; note
    its corridors and blocks. False where a block would be too shallow."""
    if cut is None:
        blocks.append(piece.area)
        return True
    work = piece if upright else piece.turned()
    ends, work = _blind_ends(work, random)
    blocks += (end if upright else end.turned() for end in ends)
    strips = _strips(work.area.left, work.area.right, cut.weights, random)
    if strips is None or work.area.height < SHALLOWEST:
        return False
    area, last = work.area, len(strips) - 1
    for (_, left), (right, _) in pairwise(strips):
        top, bottom = area.top - work.north, area.bottom + work.south
        corridor = Area(left + 2, top, right - 2, bottom)
        corridors.append(corridor if upright else corridor.turned())
    for number, ((left, right), choices) in enumerate(zip(strips, cut.across, strict=True)):
        strip = _Piece(
            Area(left, area.top, right, area.bottom),
            work.west or number > 0,
            work.north,
            work.east or number < last,
            work.south,
        )
        part = strip if upright else strip.turned()
        if not _divide(part, random.choice(choices), not upright, random, corridors, blocks):
            return False
    return True


def _blind_ends(piece: _Piece, random: Random) -> tuple[list[Area], _Piece]:
    """Rooms at the north or south end, where corridors would else run into the outer wall."""
    ends: list[Area] = []
    left, top, right, bottom = piece.area
    if piece.area.width > _END_WIDTH:
        return ends, piece
    if not piece.north and piece.south and random.random() < _BLIND:
        depth = random.randint(*_END_ROOM)
        ends.append(Area(left, top, right, top + depth - 1))
        top += depth + 1
    elif not piece.south and piece.north and random.random() < _BLIND:
        depth = random.randint(*_END_ROOM)
        ends.append(Area(left, bottom - depth + 1, right, bottom))
        bottom -= depth + 1
    return ends, piece._replace(area=Area(left, top, right, bottom))


def _strips(
    low: int, high: int, weights: tuple[float, ...], random: Random
) -> list[tuple[int, int]] | None:
    """The strips between parallel corridors, as (first, last) cells; None where one is too thin."""
    drawn = [weight * random.uniform(0.75, 1.25) for weight in weights]
    free = high - low + 1 - _CLEARANCE * (len(drawn) - 1)
    depths = [int(free * weight / sum(drawn)) for weight in drawn]
    depths[-1] += free - sum(depths)
    if min(depths) < SHALLOWEST:
        return None
    strips = []
    for depth in depths:
        strips.append((low, low + depth - 1))
        low += depth + _CLEARANCE
    return strips
