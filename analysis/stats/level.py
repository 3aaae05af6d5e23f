"""The one alpha of an analysis: tests are judged at it, and intervals have the level 1 - alpha.

Intervals of what a one-sided test asks (equivalence, partial eta squared) have 1 - 2 alpha.
"""

ALPHA = 0.05


def percent(level: float) -> str:
    """A level from 0 to 1 in words: "95%"."""
    return f"{100 * level:g}%"
