"""Cronbach's alpha of the four Likert items (paper 5.3)."""

from typing import TypeAlias

import numpy as np
import pandas as pd
from scipy import stats

from analysis.sources.absent import Absent, Row
from analysis.sources.factors import ADAPTIVITY, LIKERT_ITEMS
from analysis.sources.frames import StudyData
from analysis.stats.level import ALPHA

Estimate: TypeAlias = tuple[float | Absent, tuple[float | Absent, float | Absent]]


def cronbach_alpha(items: pd.DataFrame, level: float = 1 - ALPHA) -> Estimate:
    """Cronbach's alpha (1951) and its interval (Feldt, 1965), covariances over complete pairs.

    Listwise alpha is this of the complete rows.
    """
    if len(items) < 2:
        none = Absent("fewer than two answered rows")
        return none, (none, none)
    covariance = items.cov().to_numpy()
    if not float(covariance.sum()) > 0:
        none = Absent("items that do not vary, or that nobody answered together")
        return none, (none, none)
    rows, count = items.shape
    alpha = count / (count - 1) * (1 - float(np.trace(covariance)) / float(covariance.sum()))
    df1, df2 = rows - 1, (rows - 1) * (count - 1)
    low, high = (
        1 - (1 - alpha) * float(stats.f.ppf(share, df1, df2))
        for share in ((1 + level) / 2, (1 - level) / 2)
    )
    return alpha, (low, high)


def alpha_rows(study: StudyData, alpha: float = ALPHA) -> dict[str, Row]:
    """Alpha over all rounds and in each, listwise and pairwise, with the rows they rest on.

    The rounds of one person alone tell nothing of how people differ, so there is none of them.
    """
    tables = {"all": study.rounds} | {
        name: study.rounds[study.rounds["adaptivity"] == name] for name in ADAPTIVITY
    }
    return {
        name: _alpha_row(table.set_index("participant")[list(LIKERT_ITEMS)], 1 - alpha)
        for name, table in tables.items()
    }


def _alpha_row(items: pd.DataFrame, level: float) -> Row:
    answered = items.dropna(how="all")
    complete = items.dropna()
    listwise, interval = _of_people(complete, level)
    return {
        "rows_any": len(answered),
        "rows_complete": len(complete),
        "listwise": listwise,
        "pairwise": _of_people(answered, level)[0],
        "lower": interval[0],
        "upper": interval[1],
    }


def _of_people(items: pd.DataFrame, level: float) -> Estimate:
    if items.index.nunique() < 2:
        none = Absent("fewer than two people answered")
        return none, (none, none)
    return cronbach_alpha(items, level)
