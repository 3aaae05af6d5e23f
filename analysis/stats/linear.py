"""Least squares with columns added to a base: the incremental F test, and one added slope."""

import numpy as np

from analysis.sources.absent import Refusal
from analysis.sources.frames import Floats
from analysis.stats.cellmodel import FLAT, Contrast, FTest


def added_columns(y: Floats, base: Floats, extra: Floats) -> FTest:
    """F test of `extra` (n x q) given `base` (n x p), against the error of both together.

    Raises Refusal where the extra columns say nothing that the base has not said, or where no
    error variance is left.
    """
    full = np.column_stack([base, extra])
    rank = int(np.linalg.matrix_rank(full))
    df1 = rank - int(np.linalg.matrix_rank(base))
    df2 = len(y) - rank
    if df1 < extra.shape[1]:
        raise Refusal("the effect cannot be told apart from the analysis cells")
    import statsmodels.api as sm

    both = sm.OLS(y, full).fit()
    if df2 < 1 or bool((np.abs(both.resid) <= FLAT * np.abs(y).max()).all()):
        raise Refusal("no error variance is left to test against")
    f, p, _ = both.compare_f_test(sm.OLS(y, base).fit())
    ss = max(0.0, float(f)) * df1 * float(both.mse_resid)
    return FTest(df1, df2, ss, float(both.ssr), max(0.0, float(f)), float(p))


def added_slope(y: Floats, base: Floats, column: Floats) -> Contrast:
    """The slope of one column given `base`, with its standard error, t and p."""
    import statsmodels.api as sm

    test = added_columns(y, base, column[:, None])
    fit = sm.OLS(y, np.column_stack([base, column])).fit()
    estimate, se = float(fit.params[-1]), float(fit.bse[-1])
    return Contrast(estimate, se, test.df2, estimate / se, test.p)
