"""Cronbach's alpha of the four Likert items (paper 5.3)."""

import pandas as pd

from analysis.sources.absent import Absent, Row
from analysis.sources.factors import ADAPTIVITY, LIKERT_ITEMS
from analysis.sources.frames import StudyData


def cronbach_alpha(items: pd.DataFrame) -> tuple[float | Absent, tuple[float | Absent, ...]]:
    """Cronbach's alpha (1951) and its 95% interval (Feldt, 1965), covariances over complete pairs.

    Listwise alpha is this of the complete rows.
    """
    if len(items) < 2:
        none = Absent("fewer than two answered rows")
        return none, (none, none)
    if not float(items.cov().to_numpy().sum()) > 0:
        none = Absent("items that do not vary, or that nobody answered together")
        return none, (none, none)
    import pingouin

    alpha, interval = pingouin.cronbach_alpha(items, nan_policy="pairwise")
    return float(alpha), tuple(interval.tolist())


def alpha_rows(study: StudyData) -> dict[str, Row]:
    """Alpha over all rounds and in each, listwise and pairwise, with the rows they rest on."""
    tables = {"all": study.rounds} | {
        name: study.rounds[study.rounds["adaptivity"] == name] for name in ADAPTIVITY
    }
    return {name: _alpha_row(table[list(LIKERT_ITEMS)]) for name, table in tables.items()}


def _alpha_row(items: pd.DataFrame) -> Row:
    answered = items.dropna(how="all")
    complete = items.dropna()
    listwise, interval = cronbach_alpha(complete)
    return {
        "rows_any": len(answered),
        "rows_complete": len(complete),
        "listwise": listwise,
        "pairwise": cronbach_alpha(answered)[0],
        "lower": interval[0],
        "upper": interval[1],
    }
