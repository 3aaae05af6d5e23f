"""The words of the analysis: factors, levels, outcomes and the ranges of answers (paper 5.3)."""

from typing import Final

from game.tables.asked import Outcomes
from game.tables.session_tables import LIKERT_ITEMS as LIKERT_ITEMS
from game.tables.session_tables import MENTAL_STATES as MENTAL_STATES

KNOWLEDGE: Final = ("LOW", "MED", "HIGH")
COMPLEXITY: Final = ("C1", "C2", "C3")
ADAPTIVITY: Final = ("static", "adaptive")

OUTCOMES: Final = ("victims", *MENTAL_STATES, "preference")

ALIGNED: Final = (("LOW", "C1"), ("MED", "C2"), ("HIGH", "C3"))

ORDERS: Final = ("static_first", "adaptive_first")

#: What the paper asked after each mission.
PAPER: Final = Outcomes(
    MENTAL_STATES,
    {"preference": LIKERT_ITEMS},
    dict.fromkeys(MENTAL_STATES, (1, 100)) | dict.fromkeys(LIKERT_ITEMS, (1, 5)),
)

#: Least and greatest legal answer of each measured column; None where there is no upper end.
RANGES: Final[dict[str, tuple[int, int | None]]] = {
    "victims": (0, None),
    **dict.fromkeys(MENTAL_STATES, (1, 100)),
    **dict.fromkeys(LIKERT_ITEMS, (1, 5)),
}
