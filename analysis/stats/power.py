"""How many people: power of the within-person effects, by simulation and by the noncentral F.

A simulated sample has difference scores of unit variance in the nine analysis cells, with cell
means along one pattern. A published eta_p^2 is SS/(SS + SSE) of a sample, so the noncentrality that
goes with it is (N - 9) f^2 with f^2 = eta_p^2/(1 - eta_p^2), where the cells are equal. Static
levels are dealt evenly; knowledge groups fall at random in the given shares, so cells are unequal,
and a sample with an empty cell counts as no detection.
"""

from bisect import bisect_left
from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from scipy import stats

from analysis.sources.absent import Row
from analysis.sources.frames import Floats
from analysis.stats.anova import HYPOTHESES, THREE_WAY, WITHIN
from analysis.stats.cellmodel import CELLS

EVEN = (1 / 3, 1 / 3, 1 / 3)
#: The seed of the shipped curves.
SEED = 20_240_501
#: eta_p^2 of the paper's three-way interaction on engagement: as printed, and bias-corrected.
PUBLISHED_PES = (0.164, 0.122)
SAMPLE_SIZES = (54, 72, 90, 108, 126, 144)


@dataclass(frozen=True)
class PowerPoint:
    """Detections among simulated samples of `n` people, with a 95% Wilson interval."""

    n: int
    power: float
    lower: float
    upper: float
    samples: int
    empty_cell: int
    analytic: float

    def row(self) -> Row:
        """The point as written to the results."""
        return {
            "n": self.n,
            "power": self.power,
            "lower.CL": self.lower,
            "upper.CL": self.upper,
            "samples": self.samples,
            "empty_cell": self.empty_cell,
            "analytic": self.analytic,
        }


def pattern_of(effect: str) -> Floats:
    """Nine cell means of mean square 1 that carry this within effect and no other.

    The three-way pattern is alignment: LOW-C1, MED-C2 and HIGH-C3 against the others.
    """
    hypothesis = HYPOTHESES[list(HYPOTHESES)[WITHIN.index(effect)]]
    aligned = np.eye(3).ravel() if effect == THREE_WAY else np.arange(1.0, 10.0)
    projector = hypothesis.T @ np.linalg.solve(hypothesis @ hypothesis.T, hypothesis)
    carried = projector @ aligned
    return np.asarray(carried / np.sqrt(np.mean(carried**2)), dtype=float)


def analytic_power(effect: str, pes: float, n: int, alpha: float = 0.05) -> float:
    """Power at equal cells from the noncentral F with noncentrality (N - 9) f^2."""
    q = len(HYPOTHESES[list(HYPOTHESES)[WITHIN.index(effect)]])
    df = n - len(CELLS)
    critical = stats.f.isf(alpha, q, df)
    return float(stats.ncf.sf(critical, q, df, df * pes / (1 - pes)))


def simulated_power(
    effect: str,
    pes: float,
    n: int,
    *,
    samples: int = 2000,
    seed: int = SEED,
    shares: Sequence[float] = EVEN,
    alpha: float = 0.05,
) -> PowerPoint:
    """Share of simulated samples of n people in which the effect is detected at alpha.

    `shares` are the knowledge groups' probabilities. The same arguments give the same point.
    """
    rng = np.random.default_rng([seed, n, WITHIN.index(effect), round(pes * 1e6)])
    hypothesis = HYPOTHESES[list(HYPOTHESES)[WITHIN.index(effect)]]
    means = pattern_of(effect) * np.sqrt(pes / (1 - pes) * (n - len(CELLS)) / n)
    probabilities = np.asarray(shares, dtype=float) / np.sum(shares)
    knowledge = rng.choice(3, size=(samples, n), p=probabilities)
    cell = 3 * knowledge + np.arange(n) % 3
    values = means[cell] + rng.standard_normal((samples, n))
    at = (cell + len(CELLS) * np.arange(samples)[:, None]).ravel()
    counts, sums, squares = (
        np.bincount(at, weights=weights, minlength=samples * len(CELLS)).reshape(samples, -1)
        for weights in (None, values.ravel(), values.ravel() ** 2)
    )
    full = (counts > 0).all(axis=1)
    counts, sums, squares = counts[full], sums[full], squares[full]
    observed = sums / counts
    mse = (squares.sum(axis=1) - (sums * observed).sum(axis=1)) / (n - len(CELLS))
    gaps = observed @ hypothesis.T
    spread = np.einsum("qc,rc,pc->rqp", hypothesis, 1 / counts, hypothesis)
    ss = np.einsum("rq,rq->r", gaps, np.linalg.solve(spread, gaps[:, :, None])[:, :, 0])
    p = stats.f.sf(ss / len(hypothesis) / mse, len(hypothesis), n - len(CELLS))
    detected = int((p < alpha).sum())
    interval = stats.binomtest(detected, samples).proportion_ci(method="wilson")
    return PowerPoint(
        n=n,
        power=detected / samples,
        lower=float(interval.low),
        upper=float(interval.high),
        samples=samples,
        empty_cell=samples - int(full.sum()),
        analytic=analytic_power(effect, pes, n, alpha),
    )


#: The same points, kept: they hang on the shares of the groups alone, which many sources share.
_kept_power = lru_cache(maxsize=64)(simulated_power)


@lru_cache(maxsize=64)
def sample_size(effect: str, pes: float, power: float, alpha: float = 0.05) -> int:
    """The least number of people with this analytic power at equal cells."""
    least, enough = len(CELLS) + 1, 2 * len(CELLS)
    while analytic_power(effect, pes, enough, alpha) < power:
        enough *= 2
    sizes = range(least, enough + 1)
    return sizes[bisect_left(sizes, power, key=lambda n: analytic_power(effect, pes, n, alpha))]


def power_rows(shares: Sequence[float] = EVEN, sizes: Sequence[int] = SAMPLE_SIZES) -> Row:
    """Curves for the paper's three-way effect, as printed and bias-corrected."""
    dealt = tuple(map(float, shares))
    return {
        "effect": THREE_WAY,
        "seed": SEED,
        "knowledge_shares": list(dealt),
        "curves": [
            {
                "pes": pes,
                "n_for_80": sample_size(THREE_WAY, pes, 0.8),
                "n_for_90": sample_size(THREE_WAY, pes, 0.9),
                "points": [_kept_power(THREE_WAY, pes, n, shares=dealt).row() for n in sizes],
            }
            for pes in PUBLISHED_PES
        ],
    }
