"""F tests of a mixed model after Kenward and Roger (1997), as pbkrtest computes them.

The covariance C of the fixed effects is widened for the uncertainty of the variances, and F is
scaled and given degrees of freedom so that its mean and variance are those of an F distribution
(Halekoh & Hojsgaard, 2014, gives the computations). Both need the expected REML information on the
variances, here tau^2 and sigma^2.
"""

from dataclasses import dataclass

import numpy as np
from scipy import stats

from analysis.sources.absent import Absent
from analysis.sources.frames import Floats


@dataclass(frozen=True)
class ScaledF:
    """A scaled F, the degrees of freedom below it, and p."""

    F: float
    df2: float
    p: float


@dataclass(frozen=True)
class KenwardRoger:
    """What the tests of one fit share.

    `covariance` is C, p x p; `adjusted` the same widened; `slopes` C X' W V_i W X C for each
    variance, 2 x p x p; `of_variances` the covariance of the variances, 2 x 2.
    """

    covariance: Floats
    adjusted: Floats
    slopes: Floats
    of_variances: Floats

    @classmethod
    def of(
        cls, covariance: Floats, crossed: Floats, doubly: Floats, expected: Floats
    ) -> "KenwardRoger":
        """From C, X' W V_i W X (2 x p x p), X' W V_i W V_j W X (2 x 2 x p x p), and the expected
        information (2 x 2)."""
        of_variances = np.linalg.pinv(expected).astype(float)
        bias = doubly - np.einsum("iab,bc,jcd->ijad", crossed, covariance, crossed)
        widening = 2 * covariance @ np.einsum("ij,ijab->ab", of_variances, bias) @ covariance
        slopes = np.array([covariance @ cross @ covariance for cross in crossed])
        return cls(covariance, covariance + widening, slopes, of_variances)

    def f_test(self, beta: Floats, columns: list[int]) -> ScaledF | Absent:
        """The test of the hypothesis that these columns are nil; absent where there are too few
        people for an F to have the moments that it is expected to have."""
        inside = np.ix_(columns, columns)
        q = len(columns)
        inverse = np.linalg.inv(self.covariance[inside])
        turned = [inverse @ slope[inside] for slope in self.slopes]
        traces = np.array([np.trace(part) for part in turned])
        a1 = float(traces @ self.of_variances @ traces)
        pairs = [[np.sum(one * other.T) for other in turned] for one in turned]
        a2 = float(np.sum(self.of_variances * pairs))
        scale, df2 = _moments(a1, a2, q)
        wald = beta[columns] @ np.linalg.solve(self.adjusted[inside], beta[columns])
        f = scale * float(wald) / q
        if not (np.isfinite(f) and f >= 0 and 0 < df2 < np.inf):
            return Absent("there are too few people for Kenward and Roger's degrees of freedom")
        return ScaledF(f, df2, float(stats.f.sf(f, q, df2)))


def _moments(a1: float, a2: float, q: int) -> tuple[float, float]:
    """The scale and the degrees of freedom at which F has the mean and the variance that it is
    expected to have (Kenward & Roger, 1997, section 3.2); exact for one stratum of error."""
    b = (a1 + 6 * a2) / (2 * q)
    g = ((q + 1) * a1 - (q + 4) * a2) / ((q + 2) * a2)
    below = 3 * q + 2 * (1 - g)
    c1, c2, c3 = g / below, (q - g) / below, (q + 2 - g) / below
    upper, first, second = 1 + c1 * b, 1 - c2 * b, 1 - c3 * b
    upper = 0.0 if abs(upper) < 1e-10 else upper
    rho = ((1 - a2 / q) / first) ** 2 * upper / second / q
    df2 = 4 + (q + 2) / (q * rho - 1)
    scale = 1.0 if abs(df2 - 2) < 1e-2 else df2 * (1 - a2 / q) / (df2 - 2)
    return scale, df2
