"""Intervals of effect sizes, corrections and Bayes factors against definitions and libraries."""

import gc

import numpy as np
import pandas as pd
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy import stats

from analysis.sources.absent import Refusal
from analysis.stats.corrections import adjusted
from analysis.stats.effect_sizes import eta_interval, t_noncentrality
from analysis.stats.equivalence import jzs_bayes_factor, paired_row
from analysis.stats.reliability import cronbach_alpha
from tests.analysis.peers import pingouin, sm_multitest


@given(
    st.floats(0.01, 60), st.integers(1, 8), st.integers(5, 200), st.sampled_from([0.9, 0.95, 0.98])
)
def test_the_interval_of_eta_inverts_the_noncentral_f(
    f: float, df1: int, df2: int, level: float
) -> None:
    low, high = eta_interval(f, df1, df2, level)
    tail = (1 - level) / 2
    assert 0 <= low <= high < 1
    assert (low > 0) == (stats.f.sf(f, df1, df2) < tail)
    for end, share in ((low, 1 - tail), (high, tail)):
        if end > 0:
            noncentrality = df2 * end / (1 - end)
            assert stats.ncf.cdf(f, df1, df2, noncentrality) == pytest.approx(share, abs=1e-5)


@given(st.floats(-12, 12), st.integers(3, 200))
def test_the_interval_of_d_inverts_the_noncentral_t(t: float, df: int) -> None:
    low, high = t_noncentrality(t, df, 0.95)
    assert low < high
    for end, share in ((low, 0.975), (high, 0.025)):
        assert stats.nct.cdf(t, df, end) == pytest.approx(share, abs=1e-6)


def test_an_effect_beyond_computing_is_refused() -> None:
    with pytest.raises(Refusal, match="too large"):
        t_noncentrality(1e12, 5, 0.95)


@given(st.lists(st.floats(0, 1), min_size=1, max_size=12))
def test_corrections_equal_statsmodels(family: list[float]) -> None:
    ours = adjusted(family)
    for name, method in (("p_bonf", "bonferroni"), ("p_sidak", "sidak"), ("p_holm", "holm")):
        with pytest.MonkeyPatch.context() as patch, np.errstate(divide="ignore"):
            patch.setattr(gc, "collect", lambda: 0)  # which it calls each time
            theirs = sm_multitest.multipletests(family, method=method)[1]
        assert [row[name] for row in ours] == pytest.approx(theirs.tolist(), abs=1e-12)


@given(st.floats(-15, 15), st.integers(3, 300), st.sampled_from([0.3, 0.5**0.5, 1.0, 1.4]))
def test_the_bayes_factor_equals_pingouins(t: float, n: int, scale: float) -> None:
    theirs = float(pingouin.bayesfactor_ttest(t, n, paired=True, r=scale))
    assert jzs_bayes_factor(t, n, scale) == pytest.approx(theirs, rel=1e-5)


def test_alpha_and_equivalence_equal_pingouins() -> None:
    rng = np.random.default_rng(6)
    items = pd.DataFrame(rng.normal(size=(40, 4)) + rng.normal(size=(40, 1)))
    alpha, (low, high) = cronbach_alpha(items)
    theirs, ends = pingouin.cronbach_alpha(items)
    assert alpha == pytest.approx(theirs)
    assert [low, high] == pytest.approx(ends.tolist(), abs=1e-3)
    rounds = pd.DataFrame(rng.normal(0.1, 1, (30, 2)), columns=["static", "adaptive"])
    row = paired_row(rounds)
    test = pingouin.tost(rounds["adaptive"], rounds["static"], row["tost_bound"], paired=True)
    assert row["tost_p"] == pytest.approx(float(test["pval"].iloc[0]))
