"""The experimental design: design cells, allocated in seeded permuted blocks (docs/lab.md).

A design crosses memorise times, orders of the two instructors, static levels, and which building
comes first. A part of a block has every memorise time x order x static level once; these three
determine which building comes first, and each further part has the next one. So a block has every
design cell once, and each part is balanced by itself. The paper's design has 24 design cells in two
parts of 12. The order of slots comes from hashes of the seed: it is the same on every machine and
Python.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator
from itertools import product

import msgspec

from game.coach.acts import Level
from game.study.chance import digest, shuffled

HALF_BLOCK = 12
BLOCK = 2 * HALF_BLOCK
"""The design cells of the paper's design."""


ORDER_CODES = ("SA", "AS")
"""In names of design cells: the static instructor first, or the adaptive one."""
CODES_MEAN = (
    "1, 3, m3 ...: the first, second, third memorise time; SA or AS: static or adaptive first; "
    "C1 to C3: the static level; b0, b1 ...: the first building"
)
"""How to read the name of a design cell."""


def memorise_code(which: int) -> str:
    """How names of design cells begin with this memorise time, from 0: as the paper's minutes for
    the first two, whatever their length."""
    return {0: "1", 1: "3"}.get(which, f"m{which + 1}")


class DesignCell(msgspec.Struct, frozen=True, order=True, omit_defaults=True):
    """A combination of conditions that a participant can be given.

    `long_memorise` tells whether it is not the shortest of the memorise times, and `memorise_at`
    which one where there are more than two. `adaptive_first` selects the second instructor of the
    pair for the first round. `first_building` is the index of the first round's building; the
    following rounds have the following ones.
    """

    long_memorise: bool
    adaptive_first: bool
    static_level: Level
    first_building: int
    memorise_at: int = 0

    @property
    def memorise(self) -> int:
        """Which of the memorise times, from 0."""
        return self.memorise_at or int(self.long_memorise)

    @property
    def buildings(self) -> tuple[int, int]:
        """The building indices of the two rounds, where there are two."""
        return self.first_building, 1 - self.first_building

    @property
    def code(self) -> str:
        """A short name: memorise time (1 the first, 3 the second), order, level and first building,
        as `1-SA-C2-b0`."""
        memorise, order = memorise_code(self.memorise), ORDER_CODES[self.adaptive_first]
        return f"{memorise}-{order}-{self.static_level.name}-b{self.first_building}"


class Design(msgspec.Struct, frozen=True):
    """What is crossed: the number of memorise times, the static levels, and the number of
    buildings."""

    memorise: int = 2
    levels: tuple[Level, ...] = tuple(Level)
    buildings: int = 2

    @property
    def part(self) -> int:
        """The length of the shortest sequence that is balanced by itself."""
        return self.memorise * 2 * len(self.levels)

    @property
    def block(self) -> int:
        """The number of design cells."""
        return self.part * self.buildings

    def cells(self, shift: int) -> tuple[DesignCell, ...]:
        """The design cells of one part of a block, in canonical order."""
        found = []
        for time, second_first, place in product(
            range(self.memorise), (False, True), range(len(self.levels))
        ):
            building = (time + second_first + (place % 2 == 1) + shift) % self.buildings
            found.append(
                DesignCell(
                    time > 0,
                    second_first,
                    self.levels[place],
                    building,
                    time if time > 1 else 0,
                )
            )
        return tuple(found)

    def cell(self, seed: int, stream: str, slot: int) -> DesignCell:
        """The design cell of `slot` (from 0) in the allocation sequence `stream` of a study.

        `stream` separates live, pilot and simulated sessions. Raises ValueError for a negative
        slot.
        """
        if slot < 0:
            raise ValueError(f"slots count from 0, not {slot}")
        block, place = divmod(slot, self.block)
        part, place = divmod(place, self.part)
        first = digest(seed, stream, block, "complement")[0]
        cells = self.cells(first + part)
        return shuffled(cells, lambda cell: cell.code, seed, stream, block, part)[place]


PAPER = Design()


def half_block(complemented: bool) -> tuple[DesignCell, ...]:
    """The 12 design cells of one half of a block of the paper's design, in canonical order."""
    return PAPER.cells(int(complemented))


def design_cell(seed: int, stream: str, slot: int) -> DesignCell:
    """The design cell of `slot` (from 0) in a sequence of the paper's design."""
    return PAPER.cell(seed, stream, slot)


class Balance(msgspec.Struct, frozen=True):
    """How often each value of a factor is allocated, with the fewest and most of any."""

    factor: str
    counts: dict[str, int]

    @property
    def even(self) -> bool:
        """Whether each value comes equally often."""
        return len(set(self.counts.values())) == 1


def balances(design: Design, seed: int, places: int) -> Iterator[Balance]:
    """The counts of each factor, and of the design cells, when all live places are taken."""
    cells = [design.cell(seed, "live", slot) for slot in range(places)]
    every = [cell for shift in range(design.buildings) for cell in design.cells(shift)]
    factors: dict[str, Callable[[DesignCell], str]] = {
        "memorise time": lambda cell: str(cell.memorise),
        "order": lambda cell: str(int(cell.adaptive_first)),
        "static level": lambda cell: cell.static_level.name,
        "first building": lambda cell: str(cell.first_building),
        "design cell": lambda cell: cell.code,
    }
    for factor, value in factors.items():
        counts = Counter({value(cell): 0 for cell in sorted(every)})
        counts.update(value(cell) for cell in cells)
        yield Balance(factor, dict(counts))
