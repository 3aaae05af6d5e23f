"""What the ANOVA assumes: equal spread, normal residuals; and a test that needs neither."""

from typing import Literal

import numpy as np
from scipy import special, stats

from analysis.sources.absent import Absent, Refusal, Row
from analysis.sources.frames import Floats, Paired
from analysis.stats.anova import within
from analysis.stats.cellmodel import CELLS, FLAT, CellModel
from analysis.stats.posthoc import RoundModels

#: The fewest residuals that Shapiro and Wilk's W is defined for.
SHAPIRO_LEAST = 3


def assumption_rows(pair: Paired) -> Row:
    """Levene (mean), Brown-Forsythe (median) and Shapiro-Wilk of the cell residuals."""
    variables = {"static": pair.static, "adaptive": pair.adaptive, "diff": pair.difference}
    models = RoundModels.of(pair)
    return {
        "levene_mean": {name: equal_spread(v, pair, "mean") for name, v in variables.items()},
        "levene_median": {name: equal_spread(v, pair, "median") for name, v in variables.items()},
        "shapiro_resid": {
            "mean": _shapiro(models.mean.residuals),
            "diff": _shapiro(models.difference.residuals),
        },
    }


def equal_spread(values: Floats, pair: Paired, centre: Literal["mean", "median"]) -> Row | Absent:
    """Levene's test over the analysis cells with people in them."""
    groups = [values[pair.cell == cell] for cell in np.unique(pair.cell)]
    if len(groups) < 2:
        return Absent("one analysis cell alone has people in it")
    df1, df2 = len(groups) - 1, len(values) - len(groups)
    middle = np.mean if centre == "mean" else np.median
    distances = [np.abs(group - middle(group)) for group in groups]
    if df2 < 1 or all(np.ptp(d) <= FLAT * np.abs(values).max() for d in distances):
        return Absent("distances from the cells' centres: there is no error variance")
    test = stats.levene(*groups, center=centre)
    return {"F": float(test.statistic), "df1": df1, "df2": df2, "p": float(test.pvalue)}


def _shapiro(residuals: Floats) -> Row | Absent:
    if len(residuals) < SHAPIRO_LEAST:
        return Absent("fewer than three residuals")
    if not residuals.any():
        return Absent("all residuals are nil")
    result = stats.shapiro(residuals)
    return {"W": float(result.statistic), "p": float(result.pvalue)}


def hc3_rows(pair: Paired) -> list[Row]:
    """Within effects with the HC3 covariance, which assumes no equal spread (MacKinnon & White,
    1985). In the saturated model a person's leverage is 1/n of their cell, so that the variance of
    a cell's mean is the sum of (e/(1 - 1/n))^2 over n^2.

    Raises Refusal for a cell with fewer than two people.
    """
    model = RoundModels.of(pair).difference
    model.require_every_cell()
    if bool((model.counts[model.counts > 0] < 2).any()):
        raise Refusal("HC3 needs at least two people in every analysis cell")
    weighted = model.residuals / (1 - 1 / model.counts[model.cell])
    variances = np.bincount(model.cell, weighted**2, len(CELLS)) / np.maximum(model.counts, 1) ** 2
    return [
        {"effect": effect, **_hc3_test(model, variances, hypothesis)}
        for effect, hypothesis in within(pair.levels).items()
    ]


def _hc3_test(model: CellModel, variances: Floats, hypothesis: Floats) -> Row:
    spread = (hypothesis * variances) @ hypothesis.T
    if np.linalg.matrix_rank(spread) < len(hypothesis):
        flat = Absent("too many analysis cells without variation")
        return {"F": flat, "p": flat}
    gap = model.gaps(hypothesis)
    f = float(gap @ np.linalg.solve(spread, gap)) / len(hypothesis)
    return {"F": f, "p": float(special.fdtrc(len(hypothesis), model.df, f))}
