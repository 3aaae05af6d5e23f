"""Is there no effect? Paired t, two one-sided tests, and a Bayes factor (paper 5.4, Fig. 8)."""

import math

import numpy as np
import pandas as pd
from scipy import integrate, stats

from analysis.sources.absent import Absent, Refusal, Row, attempt
from analysis.sources.frames import Floats
from analysis.stats.effect_sizes import t_noncentrality
from analysis.stats.level import ALPHA

#: The JZS prior's scale on the standardised effect, "medium" (Rouder et al., 2009).
PRIOR_SCALE = 2**0.5 / 2
#: Equivalence bound in standard deviations of the static round.
BOUND_SDS = 0.5


def paired_row(rounds: pd.DataFrame, alpha: float = ALPHA) -> Row:
    """adaptive - static over all people with both rounds (columns static, adaptive).

    TOST (Schuirmann, 1987) asks whether |mean difference| is below half a standard deviation of
    the static round; `bf10_jzs_r0707` is evidence for a difference over none. Raises Refusal
    where the differences do not vary.
    """
    difference = (rounds["adaptive"] - rounds["static"]).to_numpy(dtype=float)
    n = len(difference)
    if n < 2:
        raise Refusal("fewer than two people have both rounds")
    sd = float(difference.std(ddof=1))
    if sd == 0:
        raise Refusal("everybody has the same difference between the rounds")
    test = stats.ttest_1samp(difference, 0.0)
    t = float(test.statistic)
    bayes = jzs_bayes_factor(t, n)
    half = float(stats.t.ppf(1 - alpha / 2, n - 1)) * sd / n**0.5
    mean = float(difference.mean())
    ends = attempt(t_noncentrality, t, n - 1, 1 - alpha)
    low, high = (ends, ends) if isinstance(ends, Absent) else (x / n**0.5 for x in ends)
    return {
        "mean_diff": mean,
        "lower.CL": mean - half,
        "upper.CL": mean + half,
        "sd_diff": sd,
        "t": t,
        "df": n - 1,
        "p": float(test.pvalue),
        "dz": t / n**0.5,
        "dz.lower": low,
        "dz.upper": high,
        "bf10_jzs_r0707": bayes
        if np.isfinite(bayes)
        else Absent("the Bayes factor is too large for a number"),
        **_equivalence(difference, BOUND_SDS * float(rounds["static"].std())),
    }


def _equivalence(difference: Floats, bound: float) -> Row:
    if bound == 0:
        none = Absent("the static round does not vary, so there is no bound")
        return {"tost_bound": none, "tost_p": none}
    above = stats.ttest_1samp(difference, -bound, alternative="greater")
    below = stats.ttest_1samp(difference, bound, alternative="less")
    return {"tost_bound": bound, "tost_p": max(float(above.pvalue), float(below.pvalue))}


def jzs_bayes_factor(t: float, n: int, scale: float = PRIOR_SCALE) -> float:
    """BF10 of a paired t of n people, JZS prior (Rouder et al., 2009, equation 1); infinite beyond
    the largest float.

    The likelihood of t given the effect's variance g, integrated over g's prior, over that without
    an effect; with x = log g the integrand is smooth.
    """
    df = n - 1
    null = -(df + 1) / 2 * math.log1p(t**2 / df)

    def odds(x: float) -> float:
        g = math.exp(x)
        spread = 1 + n * g * scale**2
        likelihood = -0.5 * math.log(spread) - (df + 1) / 2 * math.log1p(t**2 / (spread * df))
        prior = -0.5 * math.log(2 * math.pi) - 0.5 * x - 0.5 / g
        return math.exp(min(likelihood + prior - null, 700.0))

    found = integrate.quad(odds, -12.0, 60.0, points=(-1.0, 2.0, 6.0), limit=500, epsrel=1e-11)
    return float(found[0]) if found[0] < 1e300 else math.inf
