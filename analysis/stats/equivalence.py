"""Is there no effect? Paired t, two one-sided tests, and a Bayes factor (paper 5.4, Fig. 8)."""

import math

import numpy as np
import pandas as pd
from scipy import stats

from analysis.sources.absent import Absent, Refusal, Row

#: The JZS prior's scale on the standardised effect, "medium" (Rouder et al., 2009).
PRIOR_SCALE = 2**0.5 / 2
#: Equivalence bound in standard deviations of the static round.
BOUND_SDS = 0.5


def paired_row(rounds: pd.DataFrame) -> Row:
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
    return {
        "mean_diff": float(difference.mean()),
        "sd_diff": sd,
        "t": t,
        "df": n - 1,
        "p": float(test.pvalue),
        "dz": t / n**0.5,
        "bf10_jzs_r0707": bayes
        if np.isfinite(bayes)
        else Absent("the Bayes factor is too large for a number"),
        **_equivalence(rounds, BOUND_SDS * float(rounds["static"].std())),
    }


def _equivalence(rounds: pd.DataFrame, bound: float) -> Row:
    if bound == 0:
        none = Absent("the static round does not vary, so there is no bound")
        return {"tost_bound": none, "tost_p": none}
    import pingouin

    test = pingouin.tost(rounds["adaptive"], rounds["static"], bound, paired=True)
    return {"tost_bound": bound, "tost_p": float(test["pval"].iloc[0])}


def jzs_bayes_factor(t: float, n: int) -> float:
    """BF10 of a paired t of n people, default JZS prior; infinite beyond the largest float."""
    import pingouin

    try:
        return float(pingouin.bayesfactor_ttest(t, n, paired=True, r=PRIOR_SCALE))
    except (ZeroDivisionError, OverflowError):
        return math.inf
