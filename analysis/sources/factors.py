"""The words of the analysis: factors, levels, outcomes and the ranges of answers (paper 5.3)."""

from typing import Final

KNOWLEDGE: Final = ("LOW", "MED", "HIGH")
COMPLEXITY: Final = ("C1", "C2", "C3")
ADAPTIVITY: Final = ("static", "adaptive")

MENTAL_STATES: Final = ("engagement", "confidence", "frustration", "confusion")
LIKERT_ITEMS: Final = ("pref1", "pref2", "pref3", "pref4")
OUTCOMES: Final = ("victims", *MENTAL_STATES, "preference")

ALIGNED: Final = (("LOW", "C1"), ("MED", "C2"), ("HIGH", "C3"))

ORDERS: Final = ("static_first", "adaptive_first")

#: Least and greatest legal answer of each measured column; None where there is no upper end.
RANGES: Final[dict[str, tuple[int, int | None]]] = {
    "victims": (0, None),
    **dict.fromkeys(MENTAL_STATES, (1, 100)),
    **dict.fromkeys(LIKERT_ITEMS, (1, 5)),
}
