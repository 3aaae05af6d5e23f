"""The saturated model of one variable: means of knowledge x complexity, one error, exact tests.

With D = diag(1/n), a hypothesis L m = 0 on the unweighted cell means m has
SS = (L m)' (L D L')^-1 (L m) and F = (SS/q)/MSE with MSE = SSE/df, df = N - cells (9 in the
paper's design; Type III with no empty cell; Searle, Linear Models for Unbalanced Data, 1987).
"""

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from scipy import special

from analysis.sources.absent import Absent, Refusal, Row, attempt
from analysis.sources.factors import COMPLEXITY, KNOWLEDGE
from analysis.sources.frames import Floats, Ints
from analysis.stats.effect_sizes import t_noncentrality
from analysis.stats.level import ALPHA

CELLS = tuple((knowledge, level) for knowledge in KNOWLEDGE for level in COMPLEXITY)
_COUNTS = {3: "three", 6: "six", 9: "nine"}


def cell_words(levels: tuple[str, ...]) -> str:
    """ "nine cells": those of a design with these static levels."""
    return f"{_COUNTS[len(KNOWLEDGE) * len(levels)]} cells"


#: A spread within cells below this share of the largest value is rounding, not variation.
FLAT = 1e-12


@dataclass(frozen=True)
class FTest:
    """One F test: sums of squares, degrees of freedom, F and p."""

    df1: int
    df2: int
    ss: float
    ss_error: float
    F: float
    p: float

    @property
    def mse(self) -> float:
        """Mean square of the error."""
        return self.ss_error / self.df2

    @property
    def pes(self) -> float:
        """Partial eta squared."""
        return self.ss / (self.ss + self.ss_error)


@dataclass(frozen=True)
class Contrast:
    """One weighted sum of cell means with its standard error, t and two-sided p.

    A part that the data cannot give is an `Absent` with the reason. `leverage` is sum(w^2/n), which
    makes the standardised contrast d = t sqrt(leverage), the estimate over the pooled standard
    deviation; None where there is no such thing.
    """

    estimate: float | Absent
    se: float | Absent
    df: int
    t: float | Absent
    p: float | Absent
    leverage: float | None = None

    def standardised(self, level: float) -> Row:
        """d and its interval of this level, by the noncentral t; nothing without a leverage."""
        if self.leverage is None:
            return {}
        if isinstance(self.t, Absent):
            return dict.fromkeys(("d", "d.lower", "d.upper"), self.t)
        scale = self.leverage**0.5
        ends = attempt(t_noncentrality, self.t, self.df, level)
        low, high = (ends, ends) if isinstance(ends, Absent) else (x * scale for x in ends)
        return {"d": self.t * scale, "d.lower": low, "d.upper": high}

    def interval(self, level: float) -> tuple[float | Absent, float | Absent]:
        """The two-sided confidence interval of this level (0 to 1)."""
        reach = self.half_width(level)
        if isinstance(self.estimate, Absent) or isinstance(reach, Absent):
            gone = self.estimate if isinstance(self.estimate, Absent) else reach
            return gone, gone
        return self.estimate - reach, self.estimate + reach

    def half_width(self, level: float) -> float | Absent:
        """Half the length of that interval."""
        if isinstance(self.se, Absent):
            return self.se
        return float(special.stdtrit(self.df, (1 + level) / 2)) * self.se


@dataclass(frozen=True)
class CellModel:
    """Counts, means and sums of squared residuals of the analysis cells.

    `counts` and `means` have shape (9,), in the order of `CELLS`; the mean of an empty cell is
    NaN. `cell` and `residuals` have one entry a person. `sse` is exactly 0 where nobody differs
    from their cell's mean beyond rounding. `levels` are the static levels of the design: no other
    cell is missed.
    """

    cell: Ints
    counts: Ints
    means: Floats
    residuals: Floats
    sse: float
    levels: tuple[str, ...] = COMPLEXITY

    @property
    def df(self) -> int:
        """Residual degrees of freedom: people less cells with somebody in them."""
        return int(self.counts.sum()) - int(np.count_nonzero(self.counts))

    @property
    def cells(self) -> tuple[tuple[str, str], ...]:
        """The cells of the design."""
        return tuple(cell for cell in CELLS if cell[1] in self.levels)

    @property
    def empty(self) -> tuple[str, ...]:
        """Names of the cells of the design that are empty."""
        return tuple(
            f"{knowledge} {level}"
            for (knowledge, level), count in zip(CELLS, self.counts, strict=True)
            if count == 0 and level in self.levels
        )

    def why_no_error(self) -> str | None:
        """The reason why the error variance is unknown or nil, or None."""
        if self.df == 0:
            return "nobody shares an analysis cell with another, so there is no error variance"
        if self.sse == 0:
            return "nobody differs from their cell's mean, so there is no error variance"
        return None

    def test(self, hypothesis: Floats) -> FTest:
        """Test hypothesis @ means = 0 (hypothesis: q x 9, full rank).

        Raises Refusal for an empty cell or an error variance that is unknown or nil.
        """
        self.require_every_cell()
        reason = self.why_no_error()
        if reason is not None:
            raise Refusal(reason)
        q = len(hypothesis)
        ss = self.sum_of_squares(hypothesis)
        f = ss / q / (self.sse / self.df)
        return FTest(q, self.df, ss, self.sse, f, float(special.fdtrc(q, self.df, f)))

    def sum_of_squares(self, hypothesis: Floats) -> float:
        """SS = (L m)' (L D L')^-1 (L m), for no empty cell."""
        gap = self.gaps(hypothesis)
        return float(gap @ np.linalg.solve(self.spread(hypothesis), gap))

    def gaps(self, hypothesis: Floats) -> Floats:
        """L m; a cell that is not of the design counts nothing."""
        filled = self.counts > 0
        return np.asarray(hypothesis[:, filled] @ self.means[filled], dtype=float)

    def spread(self, hypothesis: Floats) -> Floats:
        """L D L', the covariance of L m in units of the error variance."""
        filled = self.counts > 0
        used = hypothesis[:, filled]
        return np.asarray((used / self.counts[filled]) @ used.T, dtype=float)

    def require_every_cell(self) -> None:
        """Raises Refusal naming the empty cells, if any."""
        if self.empty:
            one = len(self.empty) == 1
            raise Refusal(
                f"empty analysis cell{'' if one else 's'} (knowledge x complexity): "
                f"{', '.join(self.empty)}"
            )

    def contrast(self, weights: Floats) -> Contrast:
        """The weighted sum of cell means; t = sum(w m) / sqrt(MSE sum(w^2/n))."""
        used = weights != 0
        vacant = [name for name in self.empty if used[_position(name)]]
        if vacant:
            gone = Absent(f"nobody in {', '.join(vacant)}")
            return Contrast(gone, gone, self.df, gone, gone, 0.0)
        estimate = float(weights[used] @ self.means[used])
        spread = float((weights[used] ** 2 / self.counts[used]).sum())
        reason = self.why_no_error()
        if reason is not None:
            none = Absent(reason)
            return Contrast(estimate, none, self.df, none, none, spread)
        se = float(np.sqrt(self.sse / self.df * spread))
        t = estimate / se
        p = 2 * float(special.stdtr(self.df, -abs(t)))
        return Contrast(estimate, se, self.df, t, p, spread)


def _position(name: str) -> int:
    knowledge, level = name.split()
    return CELLS.index((knowledge, level))


def fit_cells(values: Floats, cell: Ints, levels: tuple[str, ...] = COMPLEXITY) -> CellModel:
    """Fit one mean a cell (values and cell: shape (people,), cell from 0 to 8)."""
    counts = np.bincount(cell, minlength=len(CELLS))
    sums = np.bincount(cell, weights=values, minlength=len(CELLS))
    means = np.divide(sums, counts, out=np.full(len(CELLS), np.nan), where=counts > 0)
    residuals = values - means[cell]
    scale = float(np.abs(values).max(initial=0.0))
    if bool((np.abs(residuals) <= FLAT * scale).all()):
        residuals = np.zeros_like(residuals)
    return CellModel(cell, counts, means, residuals, float(residuals @ residuals), levels)


def weights_of(cells: Iterable[tuple[str, str]]) -> Floats:
    """Weights of the unweighted mean over these (knowledge, complexity) cells, shape (9,)."""
    chosen = [CELLS.index(cell) for cell in cells]
    weights = np.zeros(len(CELLS))
    weights[chosen] = 1 / len(chosen)
    return weights


def contrast_row(contrast: Contrast, alpha: float = ALPHA) -> Row:
    """estimate, SE, df, t.ratio, the unadjusted interval and d under their written names."""
    lower, upper = contrast.interval(1 - alpha)
    return {
        "estimate": contrast.estimate,
        "SE": contrast.se,
        "df": contrast.df,
        "lower.CL": lower,
        "upper.CL": upper,
        "t.ratio": contrast.t,
        **contrast.standardised(1 - alpha),
    }
