"""What the ANOVA assumes: equal spread, normal residuals; and a test that needs neither."""

import numpy as np
from scipy import stats

from analysis.sources.absent import Absent, Refusal, Row
from analysis.sources.frames import Floats, Paired
from analysis.stats.anova import HYPOTHESES, WITHIN
from analysis.stats.cellmodel import CELLS, CellModel, fit_cells
from analysis.stats.posthoc import RoundModels

#: The fewest residuals that Shapiro and Wilk's W is defined for.
SHAPIRO_LEAST = 3


def assumption_rows(pair: Paired) -> Row:
    """Levene (mean), Brown-Forsythe (median) and Shapiro-Wilk of the cell residuals."""
    variables = {"static": pair.static, "adaptive": pair.adaptive, "diff": pair.difference}
    models = RoundModels.of(pair)
    return {
        "levene_mean": {
            name: equal_spread(values, fit_cells(values, pair.cell).means, pair)
            for name, values in variables.items()
        },
        "levene_median": {
            name: equal_spread(values, _medians(values, pair), pair)
            for name, values in variables.items()
        },
        "shapiro_resid": {
            "mean": _shapiro(models.mean.residuals),
            "diff": _shapiro(models.difference.residuals),
        },
    }


def _medians(values: Floats, pair: Paired) -> Floats:
    return np.array(
        [
            np.median(values[pair.cell == index]) if (pair.cell == index).any() else np.nan
            for index in range(len(CELLS))
        ]
    )


def equal_spread(values: Floats, centres: Floats, pair: Paired) -> Row | Absent:
    """One-way F of the distances from the cells' centres, over the cells with people in them."""
    model = fit_cells(np.abs(values - centres[pair.cell]), pair.cell)
    reason = model.why_no_error()
    if reason is not None:
        return Absent(f"distances from the cells' centres: {reason}")
    filled = model.counts > 0
    df1 = int(np.count_nonzero(filled)) - 1
    if df1 == 0:
        return Absent("one analysis cell alone has people in it")
    counts, means = model.counts[filled], model.means[filled]
    between = float(counts @ (means - np.average(means, weights=counts)) ** 2)
    f = between / df1 / (model.sse / model.df)
    return {"F": f, "df1": df1, "df2": model.df, "p": float(stats.f.sf(f, df1, model.df))}


def _shapiro(residuals: Floats) -> Row | Absent:
    if len(residuals) < SHAPIRO_LEAST:
        return Absent("fewer than three residuals")
    if not residuals.any():
        return Absent("all residuals are nil")
    result = stats.shapiro(residuals)
    return {"W": float(result.statistic), "p": float(result.pvalue)}


def hc3_rows(pair: Paired) -> list[Row]:
    """Within effects with the HC3 covariance, which assumes no equal spread (MacKinnon & White).

    In the saturated model the leverage of a person is 1/n of their cell. Raises Refusal for a cell
    with fewer than two people.
    """
    model = RoundModels.of(pair).difference
    variances = _hc3_variances(model)
    return [
        {"effect": effect, **_hc3_test(model, variances, hypothesis)}
        for effect, hypothesis in zip(WITHIN, HYPOTHESES.values(), strict=True)
    ]


def _hc3_test(model: CellModel, variances: Floats, hypothesis: Floats) -> Row:
    spread = (hypothesis * variances) @ hypothesis.T
    q = len(hypothesis)
    if np.linalg.matrix_rank(spread) < q:
        flat = Absent("too many analysis cells without variation")
        return {"F": flat, "p": flat}
    gap = hypothesis @ model.means
    f = float(gap @ np.linalg.solve(spread, gap)) / q
    return {"F": f, "p": float(stats.f.sf(f, q, model.df))}


def _hc3_variances(model: CellModel) -> Floats:
    model.require_every_cell()
    if bool((model.counts < 2).any()):
        raise Refusal("HC3 needs at least two people in every analysis cell")
    leverage = 1 / model.counts
    squares = (model.residuals / (1 - leverage[model.cell])) ** 2
    return np.bincount(model.cell, weights=squares, minlength=len(CELLS)) / model.counts**2
