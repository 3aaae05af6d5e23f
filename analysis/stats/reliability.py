"""Cronbach's alpha of the four Likert items (paper 5.3)."""

import pandas as pd

from analysis.sources.absent import Absent, Row
from analysis.sources.factors import ADAPTIVITY, LIKERT_ITEMS
from analysis.sources.frames import Study


def cronbach_alpha(items: pd.DataFrame) -> float | Absent:
    """k/(k-1) (1 - sum of variances / sum of covariances), covariances over complete pairs.

    Listwise alpha is this of the complete rows (Cronbach, 1951).
    """
    if len(items) < 2:
        return Absent("fewer than two answered rows")
    covariance = items.cov().to_numpy()
    total = float(covariance.sum())
    if not total > 0:
        return Absent("items that do not vary, or that nobody answered together")
    k = covariance.shape[0]
    return float(k / (k - 1) * (1 - covariance.trace() / total))


def alpha_rows(study: Study) -> dict[str, Row]:
    """Alpha over all rounds and in each, listwise and pairwise, with the rows they rest on."""
    tables = {"all": study.rounds} | {
        name: study.rounds[study.rounds["adaptivity"] == name] for name in ADAPTIVITY
    }
    return {name: _alpha_row(table[list(LIKERT_ITEMS)]) for name, table in tables.items()}


def _alpha_row(items: pd.DataFrame) -> Row:
    answered = items.dropna(how="all")
    complete = items.dropna()
    return {
        "rows_any": len(answered),
        "rows_complete": len(complete),
        "listwise": cronbach_alpha(complete),
        "pairwise": cronbach_alpha(answered),
    }
