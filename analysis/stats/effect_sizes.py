"""Intervals of effect sizes by the noncentral F and t distributions (Steiger, 2004).

The noncentrality of partial eta squared is df2 eta/(1 - eta), as in `analysis.stats.power`.
"""

from collections.abc import Callable

from scipy import optimize, special

from analysis.sources.absent import Refusal


def eta_interval(f: float, df1: int, df2: int, level: float) -> tuple[float, float]:
    """The two-sided interval of partial eta squared for an observed F.

    At a level of 1 - 2 alpha its lower end is above 0 exactly where p < alpha. Raises Refusal for
    an F beyond what the distribution can be computed for; so does `t_noncentrality`.
    """
    tail = (1 - level) / 2
    low, high = (_noncentral_f(f, df1, df2, below) for below in (1 - tail, tail))
    return low / (low + df2), high / (high + df2)


def _noncentral_f(f: float, df1: int, df2: int, below: float) -> float:
    """The noncentrality at which an F of at most `f` has this probability; 0 if there is none."""

    def gap(noncentrality: float) -> float:
        return float(special.ncfdtr(df1, df2, noncentrality, f)) - below

    if float(special.fdtr(df1, df2, f)) <= below:
        return 0.0
    top = max(1.0, f * df1)
    while gap(top) > 0:
        top *= 2
    return _root(gap, 0.0, top)


def t_noncentrality(t: float, df: float, level: float) -> tuple[float, float]:
    """The two-sided interval of the noncentrality of an observed t; times sqrt(sum w^2/n) it is
    that of a standardised contrast, over sqrt(n) that of d_z."""
    tail = (1 - level) / 2
    low, high = (_noncentral_t(t, df, below) for below in (1 - tail, tail))
    return low, high


def _noncentral_t(t: float, df: float, below: float) -> float:
    def gap(noncentrality: float) -> float:
        return float(special.nctdtr(df, noncentrality, t)) - below

    reach = 4.0 + 0.2 * abs(t)
    low, high = t - reach, t + reach
    while gap(low) < 0:
        low -= reach
    while gap(high) > 0:
        high += reach
    return _root(gap, low, high)


def _root(gap: Callable[[float], float], low: float, high: float) -> float:
    try:
        return float(optimize.brentq(gap, low, high, xtol=1e-9))
    except ValueError as error:
        raise Refusal("the effect is too large for an interval") from error
