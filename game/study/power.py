"""How large an effect a design can find: planning figures by the normal approximation.

The analysis has exact and simulated power (docs/analyst.md); these need nothing but the standard
library, so that they can be had where the study is set up. For a comparison within people d is the
mean difference over the standard deviation of the differences; between two groups it is over the
standard deviation within them (Cohen, 1988, chapter 2).
"""

from __future__ import annotations

from math import sqrt
from statistics import NormalDist

ALPHA = 0.05
POWER = 0.8
EFFECTS = (0.2, 0.35, 0.5, 0.8)
"""Effects for which power is shown."""

_NORMAL = NormalDist()


def smallest_effect(n: float, alpha: float = ALPHA, power: float = POWER) -> float:
    """The smallest d that is found with this power; `n` are people, or for two groups of g people
    each g / 2."""
    return (_NORMAL.inv_cdf(1 - alpha / 2) + _NORMAL.inv_cdf(power)) / sqrt(n)


def power_of(d: float, n: float, alpha: float = ALPHA) -> float:
    """The chance of finding an effect of d, in a two-sided test."""
    critical = _NORMAL.inv_cdf(1 - alpha / 2)
    return _NORMAL.cdf(d * sqrt(n) - critical) + _NORMAL.cdf(-d * sqrt(n) - critical)


def corrected(alpha: float, tests: int, correction: str) -> float:
    """The level at which the first of several tests is judged."""
    if correction == "none":
        return alpha
    if correction == "sidak":
        return float(1 - (1 - alpha) ** (1 / tests))
    return alpha / tests
