"""Cronbach's alpha of every composite that a study computes from its forms."""

from analysis.sources.absent import Absent, Row
from analysis.sources.factors import ADAPTIVITY
from analysis.sources.frames import StudyData
from analysis.stats.reliability import cronbach_alpha


def composite_rows(study: StudyData) -> dict[str, Row]:
    """For each composite its items, its mean in each round, and alpha over all rounds, in which
    items that are turned round count as the composite counts them."""
    rows: dict[str, Row] = {}
    for name, items in study.asked.composites.items():
        answers = study.rounds[list(items)].copy()
        for item in items:
            if item in study.asked.reversed_items:
                least, most = study.asked.ranges[item]
                answers[item] = least + most - answers[item]
        complete = answers.dropna()
        alpha, (lower, upper) = cronbach_alpha(complete)
        values = study.rounds[name].dropna()
        means = study.rounds.groupby("adaptivity")[name].mean().dropna().to_dict()
        rows[name] = {
            "items": list(items),
            "rows": len(complete),
            "alpha": alpha,
            "lower": lower,
            "upper": upper,
            "n": len(values),
            "mean": {
                one: float(means[one]) if one in means else Absent("nobody answered all of it")
                for one in ADAPTIVITY
            },
        }
    return rows
