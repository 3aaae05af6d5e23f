"""Least squares with columns added to a base: the incremental F test, and one added slope."""

import numpy as np
from scipy import special

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
    both, alone = _residuals(y, full), _residuals(y, base)
    if df2 < 1 or bool((np.abs(both) <= FLAT * np.abs(y).max()).all()):
        raise Refusal("no error variance is left to test against")
    error = float(both @ both)
    ss = max(0.0, float(alone @ alone) - error)
    f = ss / df1 / (error / df2)
    return FTest(df1, df2, ss, error, f, float(special.fdtrc(df1, df2, f)))


def added_slope(y: Floats, base: Floats, column: Floats) -> Contrast:
    """The slope of one column given `base`, with its standard error, t and p.

    It is that of y on what `base` leaves of the column (Frisch, Waugh & Lovell)."""
    test = added_columns(y, base, column[:, None])
    left = _residuals(column, base)
    weight = float(left @ left)
    estimate = float(left @ y) / weight
    se = float(np.sqrt(test.mse / weight))
    return Contrast(estimate, se, test.df2, estimate / se, test.p)


def _residuals(y: Floats, columns: Floats) -> Floats:
    left: Floats = y - columns @ np.linalg.lstsq(columns, y, rcond=None)[0]
    return left
