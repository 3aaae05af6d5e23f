"""Chance in simulated people: streams named by purpose, the same on every machine.

Only sums and comparisons of `Random.random()` decide anything, never a library's own normal
distribution, whose last digits differ between machines.
"""

from __future__ import annotations

from random import Random

_DRAWS = 12


def stream(*parts: object) -> Random:
    """The source of chance for one purpose; the first part is the seed, the others name it."""
    return Random("/".join(str(part) for part in parts))


def normal(chance: Random) -> float:
    """A draw with mean 0 and standard deviation 1: the sum of 12 even draws, less 6."""
    return sum(chance.random() for _ in range(_DRAWS)) - _DRAWS / 2


def clipped(value: float, low: float, high: float) -> float:
    """The nearest value from `low` to `high`."""
    return min(high, max(low, value))
