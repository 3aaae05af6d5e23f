"""Permutations, trimmed means, priors and the specification curve."""

from collections.abc import Callable

import numpy as np
import pandas as pd
import pytest
from scipy import stats

from analysis.pages.choices import other_tests, specification_figure, survival
from analysis.sources.absent import Absent, Refusal
from analysis.sources.frames import Floats, Ints, Paired, StudyData, both_rounds, paired
from analysis.stats.anova import HYPOTHESES, THREE_WAY, WITHIN, difference_model, mixed_anova
from analysis.stats.cellmodel import CELLS, fit_cells
from analysis.stats.equivalence import paired_row
from analysis.stats.latent import latent_row
from analysis.stats.robust import f_of_many, permutation_rows, prior_rows, trimmed_row
from analysis.stats.specifications import specification_rows
from game.tables.exclusions import read_rules
from tests.analysis.pages.drawn import faults

ReadTable = Callable[..., StudyData]
MakeTable = Callable[..., pd.DataFrame]


def test_many_samples_have_the_f_of_each(study: StudyData) -> None:
    pair = paired(study, "confusion")
    model = difference_model(pair)
    samples = np.random.default_rng(3).normal(size=(7, len(pair.cell)))
    for hypothesis in HYPOTHESES.values():
        ours = f_of_many(samples, model, pair.cell, hypothesis)
        each = [fit_cells(sample, pair.cell).test(hypothesis).F for sample in samples]
        assert ours == pytest.approx(each)


def test_permutations_agree_with_the_f_test_on_well_behaved_data(study: StudyData) -> None:
    for outcome in ("engagement", "victims"):
        pair = paired(study, outcome)
        theirs = {effect.effect: effect.test for effect in mixed_anova(pair)}
        for row in permutation_rows(pair):
            test = theirs[str(row["effect"])]
            assert row["F"] == pytest.approx(test.F)
            assert row["p_permutation"] == pytest.approx(test.p, abs=0.05)


def test_permutations_keep_their_level_and_are_repeatable() -> None:
    cell = np.repeat(np.arange(9), 4)
    rejected = []
    for seed in range(150):
        rng = np.random.default_rng(seed)
        gaps = rng.exponential(size=36) - 1  # skewed, no effect
        pair = make_pair(cell, gaps)
        rows = permutation_rows(pair, 99, effects=(THREE_WAY,))
        assert rows == permutation_rows(pair, 99, effects=(THREE_WAY,))
        rejected.append(float(str(rows[0]["p_permutation"])) <= 0.1)
    low, high = stats.binom.interval(0.999, 150, 0.1)
    assert low <= sum(rejected) <= high


def make_pair(cell: Ints, gaps: Floats) -> Paired:
    names = tuple(f"P{at}" for at in range(len(cell)))
    return Paired("x", names, cell // 3, cell % 3, np.zeros(len(cell)), gaps, 0)


def test_a_permutation_p_is_never_nil() -> None:
    cell = np.repeat(np.arange(9), 6)
    gaps = np.where(cell % 4 == 0, 50.0, 0.0) + np.random.default_rng(1).normal(size=54)
    rows = permutation_rows(make_pair(cell, gaps), 199)
    assert {row["effect"] for row in rows} == set(WITHIN)
    assert min(float(str(row["p_permutation"])) for row in rows) == pytest.approx(1 / 200)


def test_the_trimmed_t_equals_scipys_parts(study: StudyData) -> None:
    row = trimmed_row(study, "frustration")
    rounds = both_rounds(study, "frustration")
    gaps = (rounds["adaptive"] - rounds["static"]).to_numpy(dtype=float)
    assert row["estimate"] == pytest.approx(stats.trim_mean(gaps, 0.2))
    se = stats.mstats.trimmed_stde(gaps, limits=(0.2, 0.2), inclusive=(1, 1))
    assert row["SE"] == pytest.approx(float(se), rel=0.02)
    low, high = (float(str(row[name])) for name in ("lower.CL", "upper.CL"))
    assert (low > 0 or high < 0) == (float(str(row["p"])) < 0.05)


def test_the_default_prior_is_among_the_priors(study: StudyData) -> None:
    rows = prior_rows(study, "victims")
    main = paired_row(both_rounds(study, "victims"))["bf10_jzs_r0707"]
    factors = {round(float(str(row["prior_scale"])), 4): row["bf10"] for row in rows}
    assert factors[0.7071] == pytest.approx(main)


def test_flat_data_are_refused(read_table: ReadTable, make_table: MakeTable) -> None:
    study = read_table(make_table().drop(columns="disobeyed").assign(victims=20))
    for make in (trimmed_row, prior_rows):
        with pytest.raises(Refusal):
            make(study, "victims")
    with pytest.raises(Refusal):
        permutation_rows(paired(study, "victims"))


@pytest.fixture(scope="module")
def scored(make_table: MakeTable, tmp_path_factory: pytest.TempPathFactory) -> StudyData:
    from analysis.sources.longcsv import read_long_csv

    folder = tmp_path_factory.mktemp("scored")
    table = make_table(dict.fromkeys(CELLS, 8))
    table.to_csv(folder / "long.csv", index=False)
    people = table["participant"].unique()
    scores = pd.DataFrame({"participant": people, "quiz_static": np.arange(len(people)) * 7 % 20})
    scores.to_csv(folder / "quiz.csv", index=False)
    return read_long_csv(folder / "long.csv", folder / "quiz.csv")


def test_the_curve_has_every_combination_and_the_planned_one(scored: StudyData) -> None:
    rows = specification_rows(scored, read_rules())
    samples = {row["sample"] for row in rows}
    assert samples == {"everybody", "disobeyed"}
    assert {row["groups"] for row in rows} == {"stated", "k-means", "thirds", "score"}
    assert len(rows) == 2 * (3 * 4 + 1) * 3
    planned = next(
        row for row in rows
        if (row["sample"], row["groups"], row["model"], row["correction"])
        == ("everybody", "stated", "ANOVA", "none")
    )  # fmt: skip
    effect = next(e for e in mixed_anova(paired(scored, "engagement")) if e.effect == THREE_WAY)
    assert planned["p"] == pytest.approx(effect.test.p)
    for row in rows:
        assert isinstance(row["p"], Absent) or 0 <= float(str(row["p"])) <= 1
    drawn = specification_figure(rows, simulated=False)
    assert faults(drawn) == []
    table = survival(rows)
    counts = [int(str(row["specifications"])) for row in table if row["choice"] == "model"]
    assert sum(counts) == len(rows)
    assert len(other_tests(scored)) == 6 * 4


def test_a_curve_of_a_pilot_says_what_could_not_be_had(
    read_table: ReadTable, make_table: MakeTable
) -> None:
    table = make_table().query("participant in ['P001', 'P009', 'P020']")
    rows = specification_rows(read_table(table), read_rules())
    assert rows and all(isinstance(row["p"], Absent) for row in rows)
    drawn = specification_figure(rows, simulated=False)
    assert (
        f"{len(rows)} further specifications could not be computed" in drawn.caption
        and faults(drawn) == []
    )
    assert survival(rows) == []


def test_a_flat_or_empty_outcome_has_no_latent_model(
    read_table: ReadTable, make_table: MakeTable
) -> None:
    flat = read_table(make_table().drop(columns="disobeyed").assign(victims=20))
    with pytest.raises(Refusal, match="alike"):
        latent_row(flat, "victims")
    table = make_table().drop(columns="disobeyed")
    empty = read_table(table[~((table["knowledge"] == "LOW") & (table["complexity"] == "C1"))])
    with pytest.raises(Refusal, match="no rows"):
        latent_row(empty, "pref1")


def test_a_planted_effect_on_the_rescues_is_found(
    read_table: ReadTable, make_table: MakeTable
) -> None:
    table = make_table(dict.fromkeys(CELLS, 8)).drop(columns="disobeyed")
    aligned = (table["knowledge"].map(["LOW", "MED", "HIGH"].index)
               == table["complexity"].map(["C1", "C2", "C3"].index))  # fmt: skip
    noise = np.random.default_rng(9).binomial(20, 0.5, len(table))
    adaptive = table["adaptivity"] == "adaptive"
    table["victims"] = np.clip(noise + 6 * (aligned & adaptive), 0, 20)
    row = latent_row(read_table(table), "victims")
    assert float(str(row["p"])) < 0.001
    assert float(str(row["sd_participant"])) < 0.3
