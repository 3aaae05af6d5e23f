"""The experimental design: 24 design cells, allocated in seeded permuted blocks (docs/lab.md).

A block of 24 slots is two half-blocks of 12. A half-block has every memorise time x order x
static level once; these three determine which building comes first, and the other half-block has
it the other way round. So a block has every design cell once, and each half-block is balanced.
The order of slots comes from hashes of the seed: it is the same on every machine and Python.
"""

from __future__ import annotations

from itertools import product

import msgspec

from game.coach.acts import Level
from game.study.chance import digest, shuffled

HALF_BLOCK = 12
BLOCK = 2 * HALF_BLOCK


class DesignCell(msgspec.Struct, frozen=True, order=True):
    """One of the 24 combinations of conditions that a participant can be given.

    `long_memorise` selects the longer of the two memorise times; `first_building` is the index (0
    or 1) of the first round's building; the second round has the other one.
    """

    long_memorise: bool
    adaptive_first: bool
    static_level: Level
    first_building: int

    @property
    def buildings(self) -> tuple[int, int]:
        """The building indices of the two rounds."""
        return self.first_building, 1 - self.first_building

    @property
    def code(self) -> str:
        """A short name: memorise time, order, level and first building, as `1-SA-C2-b0`."""
        memorise = "3" if self.long_memorise else "1"
        order = "AS" if self.adaptive_first else "SA"
        return f"{memorise}-{order}-{self.static_level.name}-b{self.first_building}"


def half_block(complemented: bool) -> tuple[DesignCell, ...]:
    """The 12 design cells of one half-block, in canonical order."""
    cells = []
    for long_memorise, adaptive_first, level in product((False, True), (False, True), Level):
        building = (long_memorise + adaptive_first + (level is Level.C2) + complemented) % 2
        cells.append(DesignCell(long_memorise, adaptive_first, level, building))
    return tuple(cells)


def design_cell(seed: int, stream: str, slot: int) -> DesignCell:
    """The design cell of `slot` (from 0) in the allocation sequence `stream` of a study.

    `stream` separates live, pilot and simulated sessions. Raises ValueError for a negative slot.
    """
    if slot < 0:
        raise ValueError(f"slots count from 0, not {slot}")
    block, place = divmod(slot, BLOCK)
    half, place = divmod(place, HALF_BLOCK)
    complement_first = digest(seed, stream, block, "complement")[0] % 2 == 1
    cells = half_block(complemented=complement_first != (half == 1))
    return shuffled(cells, lambda cell: cell.code, seed, stream, block, half)[place]
