"""Comparisons, their corrections, reliability, assumptions and equivalence."""

import math
from itertools import combinations
from typing import Any

import numpy as np
import pandas as pd
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy import integrate, stats

from analysis.sources.absent import Absent, Refusal
from analysis.sources.factors import COMPLEXITY, KNOWLEDGE, LIKERT_ITEMS, OUTCOMES
from analysis.sources.frames import Paired, StudyData, both_rounds, paired
from analysis.stats.assumptions import hc3_rows
from analysis.stats.corrections import adjusted, corrected_by_name, tukey
from analysis.stats.equivalence import jzs_bayes_factor, paired_row
from analysis.stats.posthoc import (
    RoundModels,
    complexity_within_knowledge_by_round,
    difference_all_pairs,
    difference_knowledge_within_complexity,
)
from analysis.stats.reliability import alpha_rows, cronbach_alpha
from tests.analysis.peers import pingouin, smf

p_lists = st.lists(st.floats(0, 1), min_size=1, max_size=12)


@given(p_lists)
def test_corrections_by_their_definition(values: list[float]) -> None:
    m = len(values)
    rows = adjusted(values)
    assert [row["p_none"] for row in rows] == values
    assert [row["p_bonf"] for row in rows] == pytest.approx([min(1, m * p) for p in values])
    sidak = [1 - (1 - p) ** m for p in values]
    assert [row["p_sidak"] for row in rows] == pytest.approx(sidak, abs=1e-12)
    rank = sorted(range(m), key=values.__getitem__)
    for place, at in enumerate(rank):
        steps = [(m - k) * values[rank[k]] for k in range(place + 1)]
        assert rows[at]["p_holm"] == pytest.approx(min(1, max(steps)))


@given(p_lists)
def test_corrections_never_help(values: list[float]) -> None:
    for row in adjusted(values):
        plain, holmed, bonferronied = row["p_none"], row["p_holm"], row["p_bonf"]
        assert not isinstance(plain, Absent) and not isinstance(holmed, Absent)
        assert not isinstance(bonferronied, Absent)
        assert plain <= holmed <= bonferronied <= 1


@pytest.mark.parametrize(("means", "df"), [(9, 91), (9, 2), (3, 12), (2, 40)])
def test_tukey_equals_scipy(means: int, df: int) -> None:
    t = np.array([0.0, 0.3, 1.5, -2.7, 4.0, 11.0])
    theirs = stats.studentized_range.sf(np.abs(t) * math.sqrt(2), means, df)
    assert tukey(t, means, df) == pytest.approx(theirs, abs=1e-8)
    if means == 2:
        assert tukey(t, means, df) == pytest.approx(2 * stats.t.sf(np.abs(t), df), abs=1e-9)


def test_an_absent_p_stays_absent_and_does_not_count() -> None:
    gone = Absent("why")
    assert corrected_by_name({"a": 0.02, "b": gone, "c": 0.5}) == {"a": 0.04, "b": gone, "c": 0.5}


@pytest.mark.parametrize("outcome", OUTCOMES)
def test_a_rounds_comparisons_use_its_own_pooled_error(study: StudyData, outcome: str) -> None:
    pair = paired(study, outcome)
    rows = complexity_within_knowledge_by_round(RoundModels.of(pair))
    frame = pd.DataFrame({"cell": pair.cell.astype(str), "y": pair.static})
    fit = smf.ols("y ~ 0 + cell", frame).fit()
    names = list(fit.params.index)
    static = [row for row in rows if row["adaptivity"] == "static"]
    wanted = [(g, one, other) for g in KNOWLEDGE for one, other in combinations(COMPLEXITY, 2)]
    for row, (group, one, other) in zip(static, wanted, strict=True):
        at = [3 * KNOWLEDGE.index(group) + COMPLEXITY.index(level) for level in (one, other)]
        weights = np.zeros(9)
        weights[names.index(f"cell[{at[0]}]")] = 1
        weights[names.index(f"cell[{at[1]}]")] = -1
        theirs = fit.t_test(weights)
        assert (row["contrast"], row["knowledge"]) == (f"{one} - {other}", group)
        assert row["t.ratio"] == pytest.approx(theirs.tvalue.item(), rel=1e-9)
        assert row["p_none"] == pytest.approx(theirs.pvalue.item(), rel=1e-8)


def test_difference_scores_and_tukey(study: StudyData) -> None:
    pair = paired(study, "engagement")
    models = RoundModels.of(pair)
    pairs = {row["contrast"]: row for row in difference_all_pairs(models)}
    for row in difference_knowledge_within_complexity(models):
        one, other = str(row["contrast"]).split(" - ")
        same = pairs[f"{one} {row['complexity']} - {other} {row['complexity']}"]
        assert same["t.ratio"] == row["t.ratio"]
    for row in pairs.values():
        t, p, tukey = row["t.ratio"], row["p_none"], row["p_tukey"]
        assert isinstance(t, float) and isinstance(p, float) and isinstance(tukey, float)
        assert p <= tukey + 1e-9
        assert tukey == pytest.approx(
            stats.studentized_range.sf(abs(t) * math.sqrt(2), 9, models.difference.df), abs=1e-6
        )


def test_an_empty_cell_takes_its_own_comparisons_alone(study: StudyData) -> None:
    full = paired(study, "confidence")
    keep = full.cell != 4
    names = tuple(name for name, kept in zip(full.participants, keep, strict=True) if kept)
    pair = Paired(
        "confidence",
        names,
        full.knowledge[keep],
        full.complexity[keep],
        full.static[keep],
        full.adaptive[keep],
        0,
    )
    rows = complexity_within_knowledge_by_round(RoundModels.of(pair))
    absent = [row for row in rows if isinstance(row["p_none"], Absent)]
    assert {(row["knowledge"], row["contrast"]) for row in absent} == {
        ("MED", "C1 - C2"),
        ("MED", "C2 - C3"),
    }
    assert all(row["p_none"] == Absent("nobody in MED C2") for row in absent)
    alone = next(r for r in rows if (r["knowledge"], r["contrast"]) == ("MED", "C1 - C3"))
    assert alone["p_bonf"] == alone["p_none"]
    assert alone["df"] == len(names) - 8


def test_alpha_counts_the_rows_it_rests_on(study: StudyData) -> None:
    items = study.rounds[list(LIKERT_ITEMS)]
    holed = items.astype(float).copy()
    holed.iloc[::7, 2] = np.nan
    holed.iloc[3, :] = np.nan
    row: Any = alpha_rows(
        StudyData(
            study.participants, study.rounds.assign(**{c: holed[c] for c in LIKERT_ITEMS}), "x"
        )
    )["all"]
    assert row["rows_any"] == len(items) - 1
    assert row["rows_complete"] == len(holed.dropna())
    assert row["pairwise"] != row["listwise"]
    assert row["lower"] < row["listwise"] < row["upper"]


def test_alpha_of_one_answer_is_absent() -> None:
    assert isinstance(cronbach_alpha(pd.DataFrame([[1, 2, 3, 4]]))[0], Absent)
    assert isinstance(cronbach_alpha(pd.DataFrame([[3, 3, 3, 3]] * 5))[0], Absent)


def test_hc3_equals_statsmodels(study: StudyData) -> None:
    pair = paired(study, "engagement")
    frame = pd.DataFrame(
        {
            "k": pair.knowledge.astype(str),
            "level": pair.complexity.astype(str),
            "d": pair.difference,
        }
    )
    fit = smf.ols("d ~ C(k, Sum) * C(level, Sum)", frame).fit(cov_type="HC3", use_t=True)
    table = fit.wald_test_terms(scalar=True).table
    theirs = dict(zip(table.index, table["statistic"], strict=True))
    ours = [row["F"] for row in hc3_rows(pair)]
    assert ours == pytest.approx(list(theirs.values()), rel=1e-8)


def test_hc3_refuses_a_cell_of_one() -> None:
    cell = np.array([0, *range(1, 9), *range(1, 9)])
    values = np.random.default_rng(1).normal(size=(2, len(cell)))
    pair = Paired("x", ("p",) * len(cell), cell // 3, cell % 3, values[0], values[1], 0)
    with pytest.raises(Refusal, match="two people"):
        hc3_rows(pair)


@pytest.mark.parametrize("outcome", OUTCOMES)
def test_equivalence_equals_pingouin(study: StudyData, outcome: str) -> None:
    rounds = both_rounds(study, outcome)
    row = paired_row(rounds)
    t_test = stats.ttest_rel(rounds["adaptive"], rounds["static"])
    assert row["t"] == pytest.approx(t_test.statistic)
    assert row["p"] == pytest.approx(t_test.pvalue)
    bound = row["tost_bound"]
    assert bound == pytest.approx(rounds["static"].std() / 2)
    tost = pingouin.tost(rounds["adaptive"], rounds["static"], bound=bound, paired=True)
    assert row["tost_p"] == pytest.approx(
        float(tost.iloc[0]["pval"] if "pval" in tost else tost.iloc[0]["p_val"])
    )


def bayes_factor_by_integration(t: float, n: int, scale: float) -> float:
    """BF10 from the definition: the noncentral t averaged over a Cauchy prior."""
    prior = stats.cauchy(scale=scale)
    likelihood = integrate.quad(
        lambda delta: stats.nct.pdf(t, n - 1, delta * math.sqrt(n)) * prior.pdf(delta),
        -3,
        3,
        epsabs=1e-14,
        limit=400,
    )[0]
    return float(likelihood / stats.t.pdf(t, n - 1))


@pytest.mark.parametrize("t", [0.0, 0.8, -2.5, 4.0])
def test_bayes_factor_by_its_definition(t: float) -> None:
    theirs = bayes_factor_by_integration(t, 60, math.sqrt(2) / 2)
    assert jzs_bayes_factor(t, 60) == pytest.approx(theirs, rel=1e-5)


def test_the_papers_own_no_effect_on_performance() -> None:
    """F(1, 91) = 0.009 with 100 people: t = 0.095."""
    assert 1 / jzs_bayes_factor(math.sqrt(0.009), 100) == pytest.approx(9, abs=0.1)


def test_equal_differences_are_refused() -> None:
    with pytest.raises(Refusal, match="same difference"):
        paired_row(pd.DataFrame({"static": [1.0, 2.0, 3.0], "adaptive": [2.0, 3.0, 4.0]}))
    row = paired_row(pd.DataFrame({"static": [5.0, 5.0, 5.0], "adaptive": [2.0, 3.0, 9.0]}))
    assert isinstance(row["tost_p"], Absent)
    assert math.isinf(jzs_bayes_factor(300.0, 2000))
