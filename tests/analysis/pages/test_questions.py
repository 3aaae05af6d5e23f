"""Order and building, the preferred instructor, ordinal items, power, rules, printed numbers."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
from scipy import stats

from analysis.pages.figures import fig7_mental_states, fig9_adaptivity
from analysis.pages.published import POSTHOC_FILE, STUDY_FILE, half_unit, printed, recomputed_anova
from analysis.sources.absent import Absent, Refusal, SourceError
from analysis.sources.frames import Paired, StudyData, paired
from analysis.stats.anova import THREE_WAY, WITHIN, mixed_anova
from analysis.stats.cellmodel import CELLS
from analysis.stats.linear import added_columns, added_slope
from analysis.stats.order_effects import order_rows
from analysis.stats.ordinal import ordinal_rows, proportional_odds, sign_test
from analysis.stats.power import (
    analytic_power,
    pattern_of,
    sample_size,
    simulated_power,
)
from analysis.stats.preferred import preferred_rows
from analysis.stats.sensitivity import continuous_rows
from game.errors import AnaError
from game.tables.exclusions import read_rules
from tests.analysis.peers import sm_ordinal, smf

ReadTable = Callable[..., StudyData]
MakeTable = Callable[..., pd.DataFrame]


def test_round_and_order_effects_equal_a_regression(study: StudyData) -> None:
    rows: Any = order_rows(study)["engagement"]
    ours = {row["effect"]: row for row in rows}
    pair = paired(study, "engagement")
    people = study.participants.loc[list(pair.participants)]
    frame = pd.DataFrame(
        {
            "gap": pair.difference,
            "mean": pair.mean,
            "cell": pair.cell.astype(str),
            "first": np.where(people["order"] == "static_first", 1.0, -1.0),
        }
    )
    within = smf.ols("gap ~ cell + first", frame).fit()
    between = smf.ols("mean ~ cell + first", frame).fit()
    assert ours["round"]["estimate"] == pytest.approx(within.params["first"])
    assert ours["round"]["p"] == pytest.approx(within.pvalues["first"])
    assert ours["order"]["estimate"] == pytest.approx(2 * between.params["first"])
    assert ours["order"]["t.ratio"] == pytest.approx(between.tvalues["first"])
    assert set(ours) == {"round", "order", "building", "building:adaptivity"}


def test_planted_round_and_building_effects_are_recovered(
    read_table: ReadTable, make_table: MakeTable
) -> None:
    table = make_table(dict.fromkeys(CELLS, 12)).drop(columns="disobeyed")
    second = (table["order"] == "static_first") == (table["adaptivity"] == "adaptive")
    table["engagement"] = 40 + 9 * second + 4 * (table["building"] == "south")
    noise = np.random.default_rng(8).integers(-2, 3, len(table))
    table["engagement"] += noise
    rows: Any = order_rows(read_table(table))["engagement"]
    ours = {row["effect"]: row for row in rows}
    assert ours["round"]["estimate"] == pytest.approx(9, abs=0.6)
    assert ours["building"]["contrast"] == "south - north"
    assert ours["building"]["estimate"] == pytest.approx(4, abs=0.6)
    assert abs(ours["order"]["estimate"]) < 0.8


def test_sources_without_order_say_so(read_table: ReadTable, make_table: MakeTable) -> None:
    table = make_table().drop(columns=["order", "building"])
    assert all(isinstance(row, Absent) for row in order_rows(read_table(table)).values())


def test_an_effect_inside_the_cells_is_refused() -> None:
    cells = np.eye(3)[np.arange(30) % 3]
    y = np.random.default_rng(0).normal(size=30)
    with pytest.raises(Refusal, match="told apart"):
        added_columns(y, cells, cells[:, [0]])
    slope = added_slope(y, cells, np.arange(30.0))
    assert slope.t == pytest.approx(
        np.sqrt(added_columns(y, cells, np.arange(30.0)[:, None]).F)
        * np.sign(slope.estimate if isinstance(slope.estimate, float) else 0)
    )


def test_preferred_instructor(study: StudyData) -> None:
    rows: Any = preferred_rows(study)
    answers = study.participants["preferred_instructor"]
    chosen = int((answers == "adaptive").sum())
    assert rows["all"]["adaptive"] == chosen
    assert rows["all"]["p"] == pytest.approx(stats.binomtest(chosen, len(answers)).pvalue)
    for family in ("order", "complexity", "knowledge"):
        assert sum(row["n"] for row in rows[family]) == len(answers)
        assert all(row["p_holm"] >= row["p"] for row in rows[family])
        smallest = min(row["p"] for row in rows[family])
        first = next(row for row in rows[family] if row["p"] == smallest)
        assert first["p_holm"] == pytest.approx(min(1, smallest * len(rows[family])))


def test_neither_counts_for_nobody(read_table: ReadTable, make_table: MakeTable) -> None:
    table = make_table().drop(columns="disobeyed")
    table.loc[table["participant"].isin(["P001", "P002"]), "preferred_instructor"] = "neither"
    table.loc[table["participant"] == "P003", "preferred_instructor"] = ""
    rows: Any = preferred_rows(read_table(table))
    n = table["participant"].nunique()
    assert (rows["n_neither"], rows["n_unanswered"], rows["all"]["n"]) == (2, 1, n - 3)


def test_sign_test_counts() -> None:
    rounds = pd.DataFrame({"static": [1, 2, 3, 4, 5, 2], "adaptive": [2, 3, 3, 5, 4, 5]})
    row = sign_test(rounds)
    assert (row["raised"], row["lowered"], row["tied"]) == (4, 1, 1)
    assert row["superiority"] == pytest.approx(4.5 / 6)
    assert row["p"] == pytest.approx(stats.binomtest(4, 5).pvalue)


def test_the_odds_model_sees_an_order_and_no_distances(
    read_table: ReadTable, make_table: MakeTable
) -> None:
    """With two answers the proportional-odds model is a logistic regression."""
    table = make_table(dict.fromkeys(CELLS, 12)).drop(columns="disobeyed")
    table["pref1"] = np.where(table["pref1"] > 3, 5, 1)
    rows: Any = ordinal_rows(read_table(table))
    ours = rows["pref1"]["knowledge:complexity"]["static"]
    static = table[table["adaptivity"] == "static"].assign(
        high=lambda t: (t["pref1"] == 5).astype(int)
    )
    main = smf.logit("high ~ knowledge + complexity", static).fit(disp=0)
    full = smf.logit("high ~ knowledge * complexity", static).fit(disp=0)
    assert ours["df"] == 4
    assert ours["chi2"] == pytest.approx(2 * (full.llf - main.llf), abs=1e-4)


@pytest.mark.parametrize("kinds", [2, 3, 5])
def test_the_odds_model_equals_statsmodels(kinds: int) -> None:
    rng = np.random.default_rng(kinds)
    x = rng.normal(size=(120, 3))
    latent = x @ [1.0, -0.5, 0.2] + rng.logistic(size=120)
    answers = np.digitize(latent, np.quantile(latent, np.arange(1, kinds) / kinds)).astype(np.int64)
    theirs = sm_ordinal.OrderedModel(answers, x, distr="logit").fit(
        method="bfgs", disp=False, maxiter=500
    )
    assert proportional_odds(answers, x) == pytest.approx(theirs.llf, abs=1e-5)


def test_the_odds_model_reaches_the_limit_of_a_perfect_split() -> None:
    answers = np.repeat(np.array([0, 1], dtype=np.int64), 10)
    split = (answers == 1).astype(float)[:, None]
    assert proportional_odds(answers, split) == pytest.approx(0, abs=1e-3)


def test_the_continuous_score_equals_a_regression(
    read_table: ReadTable, make_table: MakeTable
) -> None:
    table = make_table().drop(columns="disobeyed")
    people = list(table["participant"].unique())
    scores = {who: float(at * 7 % 21) for at, who in enumerate(people)}
    study = read_table(table, quiz=scores)
    ours = {row["effect"]: row for row in continuous_rows(study, "confusion")}
    pair = paired(study, "confusion")
    score = np.array([scores[who] for who in pair.participants])
    frame = pd.DataFrame(
        {"d": pair.difference, "level": pair.complexity.astype(str), "s": score - score.mean()}
    )
    fit = smf.ols("d ~ s * C(level, Sum)", frame).fit()
    terms = fit.wald_test_terms(scalar=True).table
    assert ours["score:adaptivity"]["F"] == pytest.approx(terms.loc["s", "statistic"])
    assert ours["score:complexity:adaptivity"]["F"] == pytest.approx(
        terms.loc["s:C(level, Sum)", "statistic"]
    )
    assert ours["adaptivity"]["F"] == pytest.approx(terms.loc["Intercept", "statistic"])


@pytest.mark.parametrize("effect", WITHIN)
def test_a_pattern_carries_its_effect_alone(effect: str) -> None:
    pattern = pattern_of(effect)
    assert np.mean(pattern**2) == pytest.approx(1)
    cell = np.repeat(np.arange(9), 4)
    noise = np.tile([1.0, -1.0, 1.0, -1.0], 9)
    gap = pattern[cell] + noise
    pair = Paired("x", ("p",) * 36, cell // 3, cell % 3, -gap / 2 + noise, gap / 2 + 2 * noise, 0)
    tests = {row.effect: row.test for row in mixed_anova(pair)}
    for name in WITHIN:
        assert (tests[name].ss > 1e-9) == (name == effect)


def test_power_of_the_published_effect() -> None:
    """80% near 74 and 90% near 92; bias-corrected near 100 and 124."""
    assert sample_size(THREE_WAY, 0.164, 0.8) == pytest.approx(74, abs=2)
    assert sample_size(THREE_WAY, 0.164, 0.9) == pytest.approx(92, abs=2)
    assert sample_size(THREE_WAY, 0.122, 0.8) == pytest.approx(100, abs=2)
    assert sample_size(THREE_WAY, 0.122, 0.9) == pytest.approx(124, abs=2)


@pytest.mark.parametrize("effect", WITHIN)
def test_simulated_power_is_the_analytic_one(effect: str) -> None:
    point = simulated_power(effect, 0.1, 180, samples=4000, seed=11)
    assert point.power == pytest.approx(analytic_power(effect, 0.1, 180), abs=0.04)
    assert point.lower <= point.power <= point.upper


def test_without_an_effect_power_is_alpha() -> None:
    point = simulated_power(THREE_WAY, 0.0, 108, samples=8000, seed=3)
    assert point.lower <= 0.05 <= point.upper


def test_a_seed_fixes_the_power() -> None:
    again = [simulated_power(THREE_WAY, 0.164, 54, samples=300, seed=5) for _ in range(2)]
    assert again[0] == again[1]
    assert simulated_power(THREE_WAY, 0.164, 54, samples=300, seed=6) != again[0]
    rare = simulated_power(THREE_WAY, 0.164, 54, samples=300, seed=5, shares=(0.9, 0.08, 0.02))
    assert rare.empty_cell > 100 and rare.power < again[0].power


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("primary = 1\nrule = []", "str"),
        ("primary = 'a'\nrule = []", "must name one of the rules"),
        ("primary = ", "Invalid value"),
        ("primary = 'a'\n[[rule]]\nname = 'a'", "words"),
    ],
)
def test_a_bad_rule_file_is_refused(tmp_path: Path, text: str, words: str) -> None:
    path = tmp_path / "exclusions.toml"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(AnaError, match=words):
        read_rules(path)


def test_the_shipped_rules_are_the_papers() -> None:
    rules = read_rules()
    assert (rules.main().column, rules.main().more_than) == ("disobeyed", 5)


def test_brackets_are_drawn_for_significant_pairs_alone(
    read_table: ReadTable, make_table: MakeTable
) -> None:
    table = make_table(dict.fromkeys(CELLS, 10)).drop(columns="disobeyed")
    noise = np.random.default_rng(2).integers(-3, 4, len(table))
    high = (table["knowledge"] == "LOW") & (table["complexity"] == "C1")
    table["engagement"] = np.where(high & (table["adaptivity"] == "static"), 80, 50) + noise
    study = read_table(table)
    axes = fig7_mental_states(study).figure.axes[0]
    shown = [text.get_text() for text in axes.texts]
    assert shown == ["p < .001", "p < .001"]
    panels = fig9_adaptivity(study).figure.axes
    assert len(panels[0].texts) == 2 and not panels[1].texts and not panels[2].texts


def test_printed_numbers_recompute(published: Path) -> None:
    table = recomputed_anova(published)
    assert table["agrees"].all()
    three_way = table[table["effect"] == THREE_WAY].iloc[0]
    assert three_way["lambda_printed"] == 836 and "point" in three_way["note"]
    assert three_way["lambda_recomputed"] == pytest.approx(0.836, abs=5e-4)
    assert three_way["eta_recomputed"] == pytest.approx(0.164, abs=5e-4)


def test_a_wrong_print_would_be_seen(published: Path, tmp_path: Path) -> None:
    text = (published / "anova.csv").read_text(encoding="utf-8")
    (tmp_path / "anova.csv").write_text(text.replace(".382", ".392"), encoding="utf-8")
    assert recomputed_anova(tmp_path)["agrees"].tolist() == [True, False, True, True]
    with pytest.raises(SourceError, match="no such table"):
        printed(tmp_path, "posthoc.csv")


def test_every_printed_number_is_cited(published: Path) -> None:
    for name in (POSTHOC_FILE, STUDY_FILE):
        assert printed(published, name)["place"].str.match(r"(section|caption) ?").all()
    posthoc = printed(published, POSTHOC_FILE)
    untested = posthoc[posthoc["p_printed"].isna()]
    assert len(untested) == 2 and untested["note"].notna().all()
    assert half_unit("0.164") == pytest.approx(5e-4) and half_unit("3") == 0.5
