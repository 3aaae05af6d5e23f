"""Every number that R gives for the data sets of tests/reference, to a tolerance for each kind.

Closed forms agree to 1e-8; what R integrates or searches for (Tukey, Shapiro-Wilk, Bayes factor,
REML) to what that gives.
"""

import json
import math
from pathlib import Path
from typing import Any

import pytest

from analysis.battery import BatteryResult, analyse_source
from analysis.stats.latent import latent_row

REFERENCE = Path(__file__).resolve().parents[2] / "reference"

OUTCOMES = ("victims", "engagement", "confidence", "frustration", "confusion", "preference")
PARTS = (
    "n",
    "n_dropped",
    "anova",
    "cells",
    "emm",
    "posthoc_complexity_within_knowledge_by_round",
    "posthoc_complexity_within_knowledge_avg",
    "simple_adaptivity_within_cell",
    "posthoc_diff_knowledge_within_complexity",
    "posthoc_diff_all36",
    "adaptivity_marginal",
    "assumptions",
    "hc3_diff",
    "paired",
    "lmm",
)


def tolerance(path: str) -> tuple[float, float]:
    """The relative and the absolute tolerance of the number at this path."""
    if path.endswith((".lower", ".upper")):
        return 1e-7, 1e-7
    if "p_tukey" in path or "shapiro" in path:
        return 0.0, 1e-6
    if "bf10" in path:
        return 1e-6, 0.0
    if ".lmm." in path:
        if ".est" in path:
            return 0.0, 1e-3
        if path.endswith((".df2", ".df2_kr")):
            return 1e-5, 0.0  # a basis of other contrasts moves it by up to 3.5e-4
        return (5e-3, 0.0) if ".se" in path else (1e-3, 1e-6)
    if path.endswith(".p"):
        return 1e-6, 0.0  # the smallest of them is 1e-76
    return 1e-8, 1e-9


def differences(ours: Any, theirs: Any, path: str) -> list[str]:
    if isinstance(theirs, dict):
        if not isinstance(ours, dict) or set(ours) != set(theirs):
            return [f"{path}: other keys"]
        return [
            line for key in theirs for line in differences(ours[key], theirs[key], f"{path}.{key}")
        ]
    if isinstance(theirs, list):
        if not isinstance(ours, list) or len(ours) != len(theirs):
            return [f"{path}: another length"]
        pairs = zip(ours, theirs, strict=True)
        return [
            line for i, (a, b) in enumerate(pairs) for line in differences(a, b, f"{path}[{i}]")
        ]
    if isinstance(theirs, bool | str) or theirs is None:
        return [] if ours == theirs else [f"{path}: {ours!r} for {theirs!r}"]
    relative, absolute = tolerance(path)
    if isinstance(ours, int | float) and math.isclose(
        ours, theirs, rel_tol=relative, abs_tol=absolute
    ):
        return []
    return [f"{path}: {ours} for {theirs}"]


DATASETS = ("unbalanced", "partial", "ties", "small")


@pytest.fixture(scope="module", params=DATASETS)
def dataset(request: pytest.FixtureRequest) -> str:
    return str(request.param)


@pytest.fixture(scope="module")
def expected(dataset: str) -> Any:
    return json.loads((REFERENCE / f"{dataset}.json").read_text(encoding="utf-8"))


@pytest.fixture(scope="module")
def result(dataset: str) -> BatteryResult:
    return analyse_source(REFERENCE / f"{dataset}.csv", REFERENCE / f"{dataset}_quiz.csv")


@pytest.fixture(scope="module")
def ours(result: BatteryResult) -> Any:
    return json.loads(result.to_json())


@pytest.mark.parametrize("key", ["clustering", "alpha", "holm_across_mental_states"])
def test_one_key_of_the_whole_study(ours: Any, expected: Any, key: str) -> None:
    assert differences(ours[key], expected[key], key) == []


@pytest.mark.parametrize("part", PARTS)
@pytest.mark.parametrize("outcome", OUTCOMES)
def test_one_part_of_one_outcome(ours: Any, expected: Any, outcome: str, part: str) -> None:
    mine, theirs = ours["outcomes"][outcome][part], expected["outcomes"][outcome][part]
    assert differences(mine, theirs, f"{outcome}.{part}.") == []


@pytest.mark.parametrize("dataset", ["unbalanced", "partial"], indirect=True)
def test_ordered_answers_and_rescues_out_of_twenty(result: BatteryResult, expected: Any) -> None:
    for measure, theirs in expected["latent"].items():
        ours: Any = latent_row(result.study, measure)
        for name, value in theirs.items():
            assert ours[name] == pytest.approx(value, abs=2e-4, rel=2e-4), (measure, name)


def test_nothing_is_a_problem(result: BatteryResult) -> None:
    assert result.problems == ()
    assert result.exit_status == 0


#: The same under every type of sums of squares: the highest interaction of each error stratum.
SAME_ANYWAY = {"knowledge:complexity", "knowledge:complexity:adaptivity"}


@pytest.mark.parametrize("mistake", ["type2_F", "treatment_coded_type3_F"])
@pytest.mark.parametrize("outcome", OUTCOMES)
def test_other_sums_of_squares_would_be_noticed(
    ours: Any, expected: Any, outcome: str, mistake: str
) -> None:
    right = {row["effect"]: row["F"] for row in ours["outcomes"][outcome]["anova"]}
    wrong = expected["outcomes"][outcome]["wrong"][mistake]
    noticed = {effect for effect in wrong if differences(right[effect], wrong[effect], ".anova")}
    assert noticed == set(wrong) - SAME_ANYWAY


@pytest.mark.parametrize("outcome", OUTCOMES)
def test_a_paired_t_is_not_the_adaptivity_effect(ours: Any, expected: Any, outcome: str) -> None:
    wrong = expected["outcomes"][outcome]["wrong"]["adaptivity_paired_t_squared_F"]
    right = {row["effect"]: row["F"] for row in ours["outcomes"][outcome]["anova"]}["adaptivity"]
    assert differences(right, wrong, ".anova")
    assert ours["outcomes"][outcome]["paired"]["t"] ** 2 == pytest.approx(wrong, rel=1e-8)


@pytest.mark.parametrize("outcome", OUTCOMES)
def test_welch_pairs_are_not_the_pooled_ones(ours: Any, expected: Any, outcome: str) -> None:
    pooled = {
        (row["knowledge"], row["contrast"]): row
        for row in ours["outcomes"][outcome]["posthoc_complexity_within_knowledge_by_round"]
        if row["adaptivity"] == "static"
    }
    for wrong in expected["outcomes"][outcome]["wrong"]["welch_pairs_static"]:
        right = pooled[wrong["knowledge"], wrong["contrast"]]
        if right["t.ratio"] != 0:
            assert differences(right["t.ratio"], wrong["t"], ".posthoc")
            assert differences(right["p_none"], wrong["p"], ".posthoc")
