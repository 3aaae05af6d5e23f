"""What stands in a room: desks, shelves, tables, booths, screens. Furniture is drawn as wall.

An arrangement proposes pieces for a room that is at least as wide as it is high; a higher one is
turned for it. What stands free has aisles around it, and what stands at a wall is short.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator
from random import Random

from game.world.generation.area import Area
from game.world.geometry import Cell

Arrangement = Callable[[Area, Random], Iterator[Area]]

_AISLE = 2


def furnished(
    room: Area, arrange: Arrangement, clear: Collection[Cell], random: Random
) -> set[Cell]:
    """The cells of a room that furniture takes, none of them `clear`."""
    turned = room.height > room.width
    taken: set[Cell] = set()
    for piece in arrange(room.turned() if turned else room, random):
        cells = set((piece.turned() if turned else piece).cells())
        left = cells.difference(clear)
        if len(left) > 1 or left == cells:
            taken |= left
    return taken


def nothing(_room: Area, _random: Random) -> Iterator[Area]:
    """An empty room."""
    return iter(())


def shelves(room: Area, random: Random) -> Iterator[Area]:
    """Long shelves across the room, with aisles between."""
    apart = random.choice((3, 4))
    for x in range(room.left + _AISLE, room.right - 1, apart):
        if room.height >= 12:
            middle = (room.top + room.bottom) // 2
            yield Area(x, room.top + _AISLE, x, middle - 1)
            yield Area(x, middle + 2, x, room.bottom - _AISLE)
        else:
            yield Area(x, room.top + _AISLE, x, room.bottom - _AISLE)


def desks(room: Area, random: Random) -> Iterator[Area]:
    """Rows of desks."""
    length = random.choice((2, 3, 4))
    across, down = length + random.choice((2, 3)), random.choice((3, 4))
    for y in range(room.top + _AISLE, room.bottom - 1, down):
        for x in range(room.left + _AISLE, room.right - length, across):
            yield Area(x, y, x + length - 1, y)


def workplaces(room: Area, random: Random) -> Iterator[Area]:
    """Desks and, between them, the partitions of an open-plan floor."""
    across, down = random.choice(((8, 5), (9, 5), (7, 4)))
    for y in range(room.top + _AISLE, room.bottom - 1, down):
        for x in range(room.left + 3, room.right - 4, across):
            yield Area(x, y, x + 3, y)
            if y + 1 < room.bottom - 1 and down > 4:
                yield Area(x, y + 1, x, y + 1)


def one_table(room: Area, random: Random) -> Iterator[Area]:
    """A long table to one side of the middle, and a sideboard across from it."""
    inset, depth = max(3, room.width // 4), max(1, room.height // 7)
    first = room.top + max(_AISLE, room.height // 4)
    last = room.bottom - max(_AISLE, room.height // 4)
    table, sideboard = (first, last) if random.random() < 0.5 else (last - depth + 1, first)
    yield Area(room.left + inset, table, room.right - inset, table + depth - 1)
    if room.height >= 12:
        yield Area(room.left + inset + 2, sideboard, room.left + inset + 4, sideboard)


def tables(room: Area, random: Random) -> Iterator[Area]:
    """Small tables all over the room."""
    across, down = random.choice((5, 6)), random.choice((4, 5))
    for row, y in enumerate(range(room.top + _AISLE, room.bottom - 2, down)):
        for x in range(room.left + _AISLE + row % 2, room.right - 2, across):
            yield Area(x, y, x + 1, y + 1)


def booths(room: Area, random: Random) -> Iterator[Area]:
    """Partitions along one long wall."""
    depth = min(3, room.height // 3)
    apart = random.choice((4, 5))
    for x in range(room.left + apart - 1, room.right - 1, apart):
        if room.height % 2:
            yield Area(x, room.top, x, room.top + depth - 1)
        else:
            yield Area(x, room.bottom - depth + 1, x, room.bottom)


def screens(room: Area, random: Random) -> Iterator[Area]:
    """A partition or two that stand out from opposite walls."""
    depth = room.height // 2 - 1
    near, far = room.left + room.width // 3, room.left + 2 * room.width // 3
    yield Area(near, room.top, near, room.top + depth - 1)
    if room.width >= 12 and random.random() < 0.6:
        yield Area(far, room.bottom - depth + 1, far, room.bottom)


def counter(room: Area, random: Random) -> Iterator[Area]:
    """A counter along one wall, with a way round it, and a block of cupboards."""
    y = room.top + _AISLE if random.random() < 0.5 else room.bottom - _AISLE
    yield Area(room.left + 3, y, room.right - 3, y)
    if room.height >= 10:
        other = room.bottom - 3 if y < (room.top + room.bottom) // 2 else room.top + 2
        yield Area(room.left + 3, other, min(room.left + 6, room.right - 3), other + 1)


def pillars(room: Area, _random: Random) -> Iterator[Area]:
    """Pillars in two rows."""
    if room.height < 8:
        return
    for x in range(room.left + 3, room.right - 2, 6):
        yield Area(x, room.top + 2, x + 1, room.top + 2)
        yield Area(x, room.bottom - 2, x + 1, room.bottom - 2)


def machines(room: Area, _random: Random) -> Iterator[Area]:
    """Big machines or benches, two cells deep."""
    width = 4 if room.width >= 16 else 3
    for y in range(room.top + 2, room.bottom - 2, 5):
        for x in range(room.left + 2, room.right - width, width + 3):
            yield Area(x, y, x + width - 1, y + 1)
