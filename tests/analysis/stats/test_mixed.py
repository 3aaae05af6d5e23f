"""The mixed model against closed forms where data are complete, and another fit where not."""

import warnings
from typing import Any

import numpy as np
import pandas as pd
import pytest
from scipy import optimize, stats

from analysis.sources.absent import Absent, Refusal
from analysis.sources.factors import OUTCOMES
from analysis.sources.frames import StudyData, paired
from analysis.stats.anova import difference_model, mixed_anova, sum_model
from analysis.stats.mixed import fit_random_intercept, mixed_model, sum_coded
from tests.analysis.peers import smf


def with_holes(study: StudyData, outcome: str, share: float = 0.15, seed: int = 2) -> StudyData:
    rng = np.random.default_rng(seed)
    rounds = study.rounds.copy()
    rounds[outcome] = rounds[outcome].where(rng.random(len(rounds)) > share)
    return StudyData(study.participants, rounds, study.label)


def by_name(rows: object, key: str) -> dict[str, dict[str, float]]:
    assert isinstance(rows, list)
    return {row[key]: row for row in rows}


@pytest.mark.parametrize("outcome", OUTCOMES)
def test_complete_data_have_a_closed_form(study: StudyData, outcome: str) -> None:
    pair = paired(study, outcome)
    b, d = sum_model(pair), difference_model(pair)
    between, within = b.sse / b.df, d.sse / d.df
    fitted = mixed_model(study, outcome)
    assert between > within, "the closed form needs a positive person variance"
    assert fitted["var_resid"] == pytest.approx(within, rel=1e-5)
    assert fitted["var_participant"] == pytest.approx((between - within) / 2, rel=1e-5)
    tests = by_name(fitted["anova"], "effect")
    for effect in mixed_anova(pair)[1:]:
        test = tests[_same_factors(effect.effect, tests)]
        assert test["F"] == pytest.approx(effect.test.F, rel=1e-4)
        assert test["df2"] == pytest.approx(effect.test.df2, rel=1e-4)
        assert test["p"] == pytest.approx(effect.test.p, rel=1e-3)
        assert test["F_kr"] == pytest.approx(effect.test.F, rel=1e-4)
        assert test["df2_kr"] == pytest.approx(effect.test.df2, rel=1e-6)


def _same_factors(name: str, names: dict[str, dict[str, float]]) -> str:
    return next(other for other in names if set(other.split(":")) == set(name.split(":")))


@pytest.mark.parametrize("outcome", ["engagement", "preference"])
def test_partial_rows_equal_statsmodels(study: StudyData, outcome: str) -> None:
    holed = with_holes(study, outcome)
    fitted: Any = mixed_model(holed, outcome)
    rows = holed.rounds.join(holed.participants[["knowledge", "complexity"]], on="participant")
    rows = rows.dropna(subset=[outcome])
    assert fitted["n_rows"] == len(rows)
    assert fitted["n_participants"] == rows["participant"].nunique()
    assert fitted["n_rows"] > 2 * len(paired(holed, outcome).participants)
    levels = {
        "knowledge": "['LOW', 'MED', 'HIGH']",
        "complexity": "['C1', 'C2', 'C3']",
        "adaptivity": "['static', 'adaptive']",
    }
    formula = " * ".join(f"C({name}, Sum, levels={names})" for name, names in levels.items())
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        theirs = smf.mixedlm(f"{outcome} ~ {formula}", rows, groups=rows["participant"]).fit(
            reml=True, method=["powell"]
        )
    assert fitted["var_resid"] == pytest.approx(theirs.scale, rel=1e-3)
    assert fitted["var_participant"] == pytest.approx(theirs.cov_re.iloc[0, 0], rel=2e-3)
    assert fitted["reml_loglik"] == pytest.approx(theirs.llf, abs=1e-3)
    ours = by_name(fitted["fixef"], "term")
    assert len(ours) == len(theirs.fe_params)
    for term, (name, estimate) in zip(ours, theirs.fe_params.items(), strict=True):
        assert term.count(":") == name.count(":")
        assert ours[term]["est"] == pytest.approx(estimate, abs=1e-3)


def dense_reml(theta: np.ndarray, y: np.ndarray, x: np.ndarray, person: np.ndarray) -> float:
    """-REML log-likelihood of (tau^2, sigma^2) from dense matrices, without its constant."""
    v = theta[0] * (person[:, None] == person[None, :]) + theta[1] * np.eye(len(y))
    w = np.linalg.inv(v)
    information = x.T @ w @ x
    beta = np.linalg.solve(information, x.T @ w @ y)
    residual = y - x @ beta
    logs = np.linalg.slogdet(v)[1] + np.linalg.slogdet(information)[1]
    return float(0.5 * (logs + residual @ w @ residual))


def test_optimum_and_information_by_brute_force(study: StudyData) -> None:
    holed = with_holes(study, "engagement")
    rows = holed.rounds.join(holed.participants[["knowledge", "complexity"]], on="participant")
    rows = rows.dropna(subset=["engagement"])
    design = sum_coded(rows)
    y = rows["engagement"].to_numpy(dtype=float)
    fit = fit_random_intercept(y, design.matrix, design.person)
    at = np.array([fit.var_participant, fit.var_resid])

    def f(theta: np.ndarray) -> float:
        return dense_reml(theta, y, design.matrix, design.person)

    assert optimize.approx_fprime(at, f, 1e-4) == pytest.approx([0, 0], abs=1e-4)
    step = 0.05
    e = np.eye(2) * step
    hessian = np.array(
        [
            [
                (
                    f(at + e[i] + e[j])
                    - f(at + e[i] - e[j])
                    - f(at - e[i] + e[j])
                    + f(at - e[i] - e[j])
                )
                / (4 * step**2)
                for j in range(2)
            ]
            for i in range(2)
        ]
    )
    assert np.linalg.inv(fit.variance_covariance) == pytest.approx(hessian, rel=1e-3)
    same = design.person[:, None] == design.person[None, :]
    weights = np.linalg.inv(at[0] * same + at[1] * np.eye(len(y)))
    covariance = np.linalg.inv(design.matrix.T @ weights @ design.matrix)
    assert fit.covariance == pytest.approx(covariance, rel=1e-8, abs=1e-10)
    for slope, part in zip(fit.covariance_slopes, (same, np.eye(len(y))), strict=True):
        shifted = np.linalg.inv(weights) + 1e-3 * part
        moved = np.linalg.inv(design.matrix.T @ np.linalg.inv(shifted) @ design.matrix)
        assert slope == pytest.approx((moved - covariance) / 1e-3, rel=1e-3, abs=1e-6)


def test_no_person_variance_is_singular() -> None:
    rng = np.random.default_rng(4)
    person = np.repeat(np.arange(30), 2)
    gap = rng.normal(0, 1, 30)
    y = np.ravel(np.column_stack([gap, -gap])) + rng.normal(0, 0.01, 60)
    fit = fit_random_intercept(y, np.ones((60, 1)), person)
    assert fit.singular and fit.var_participant == 0
    assert fit.var_resid == pytest.approx(y.var(ddof=1))
    assert fit.satterthwaite(np.ones(1)) == 59


def test_an_empty_cell_leaves_the_variances(study: StudyData) -> None:
    people = study.participants
    gone = people.index[(people["knowledge"] == "HIGH") & (people["complexity"] == "C2")]
    fitted = mixed_model(study.without(gone), "confidence")
    assert isinstance(fitted["anova"], Absent) and isinstance(fitted["fixef"], Absent)
    assert isinstance(fitted["var_resid"], float) and fitted["var_resid"] > 0


def test_nobody_with_both_rounds_is_refused(study: StudyData) -> None:
    static = study.rounds[study.rounds["adaptivity"] == "static"]
    rounds = pd.concat([static, static.assign(adaptivity="adaptive", engagement=np.nan)])
    with pytest.raises(Refusal, match="both rounds"):
        mixed_model(StudyData(study.participants, rounds, "x"), "engagement")


def test_p_follows_from_f(study: StudyData) -> None:
    for row in by_name(
        mixed_model(with_holes(study, "confusion"), "confusion")["anova"], "effect"
    ).values():
        assert row["p"] == pytest.approx(stats.f.sf(row["F"], row["df1"], row["df2"]))
        assert 20 < row["df2"] < len(study.rounds)
