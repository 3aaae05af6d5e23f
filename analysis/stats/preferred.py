"""Which instructor was preferred: exact binomial tests, overall and by order, level and group."""

import pandas as pd
from scipy import stats

from analysis.sources.absent import Refusal, Row
from analysis.sources.factors import COMPLEXITY, KNOWLEDGE, ORDERS
from analysis.sources.frames import StudyData
from analysis.stats.corrections import adjusted
from analysis.stats.level import ALPHA

FAMILIES = {"order": ORDERS, "complexity": COMPLEXITY, "knowledge": KNOWLEDGE}


def preferred_rows(study: StudyData, alpha: float = ALPHA) -> Row:
    """Adaptive choices among those who chose, against one half; Holm inside each family.

    Raises Refusal where the source has no `preferred_instructor`.
    """
    if not study.has("preferred_instructor"):
        raise Refusal("the source has no preferred_instructor")
    answers = study.participants["preferred_instructor"]
    chosen = study.participants[answers.isin(("static", "adaptive"))]
    if chosen.empty:
        raise Refusal("nobody preferred one instructor")
    families: Row = {
        name: _family(chosen, name, levels, alpha)
        for name, levels in FAMILIES.items()
        if name in chosen.columns
    }
    return {
        "n_unanswered": int(answers.isna().sum()),
        "n_neither": int((answers == "neither").sum()),
        "all": _test(chosen, alpha)[0],
        **families,
    }


def _family(chosen: pd.DataFrame, factor: str, levels: tuple[str, ...], alpha: float) -> list[Row]:
    parts = [(level, chosen[chosen[factor] == level]) for level in levels]
    tests = [(level, *_test(part, alpha)) for level, part in parts if len(part)]
    corrected = adjusted([p for _, _, p in tests])
    return [
        {factor: level, **row, "p_holm": p_values["p_holm"]}
        for (level, row, _), p_values in zip(tests, corrected, strict=True)
    ]


def _test(chosen: pd.DataFrame, alpha: float) -> tuple[Row, float]:
    n = len(chosen)
    adaptive = int((chosen["preferred_instructor"] == "adaptive").sum())
    result = stats.binomtest(adaptive, n)
    interval = result.proportion_ci(1 - alpha, method="exact")
    row: Row = {
        "n": n,
        "adaptive": adaptive,
        "share": adaptive / n,
        "lower.CL": float(interval.low),
        "upper.CL": float(interval.high),
        "p": float(result.pvalue),
    }
    return row, float(result.pvalue)
