"""The mixed ANOVA against identities, invariances, and models fitted another way."""

from collections.abc import Callable
from dataclasses import replace
from random import Random

import numpy as np
import pandas as pd
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy import stats

from analysis.sources.absent import Refusal
from analysis.sources.factors import COMPLEXITY, OUTCOMES
from analysis.sources.frames import Paired, StudyData, paired
from analysis.stats.anova import BETWEEN, EFFECTS, WITHIN, Effect, mixed_anova
from tests.analysis.peers import pingouin, sm_anova, smf

ReadTable = Callable[..., StudyData]
MakeTable = Callable[..., pd.DataFrame]


@st.composite
def pairs(draw: st.DrawFn) -> Paired:
    sizes = draw(st.lists(st.integers(1, 5), min_size=9, max_size=9).filter(lambda s: sum(s) > 12))
    cell = np.repeat(np.arange(9), sizes)
    rng = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    means = rng.normal(0, 1, (2, 9))
    static, adaptive = means[:, cell] + rng.normal(0, 1, (2, len(cell)))
    names = tuple(f"P{at}" for at in range(len(cell)))
    return Paired("made_up", names, cell // 3, cell % 3, static, adaptive, 0)


def rearranged(pair: Paired, order: np.ndarray) -> Paired:
    return Paired(
        pair.outcome,
        tuple(pair.participants[at] for at in order),
        pair.knowledge[order],
        pair.complexity[order],
        pair.static[order],
        pair.adaptive[order],
        0,
    )


def statistics(effects: list[Effect]) -> dict[str, tuple[float, ...]]:
    return {e.effect: (e.test.F, e.test.p, e.test.ss, e.ges, e.ges_obs_knowledge) for e in effects}


def assert_same(one: list[Effect], other: list[Effect]) -> None:
    for effect, values in statistics(one).items():
        assert statistics(other)[effect] == pytest.approx(values, rel=1e-7, abs=1e-10)


@given(pairs(), st.sampled_from([("C1", "C3"), ("C2",), ("C1", "C2", "C3")]))
def test_a_design_of_fewer_levels_is_tested_as_statsmodels_tests_it(
    pair: Paired, levels: tuple[str, ...]
) -> None:
    kept = np.isin(pair.complexity, [COMPLEXITY.index(level) for level in levels])
    fewer = replace(rearranged(pair, np.flatnonzero(kept)), levels=levels)
    if len(fewer.cell) <= 3 * len(levels):
        return
    people = pd.DataFrame(
        {"knowledge": fewer.knowledge, "complexity": fewer.complexity, "y": fewer.difference}
    )
    crossed = "C(knowledge, Sum)" + (" * C(complexity, Sum)" if len(levels) > 1 else "")
    theirs = sm_anova.anova_lm(smf.ols(f"y ~ {crossed}", people).fit(), typ=3)
    ours = {effect.effect: effect.test for effect in mixed_anova(fewer)}
    names = {
        "Intercept": "adaptivity",
        "C(knowledge, Sum)": "knowledge:adaptivity",
        "C(complexity, Sum)": "complexity:adaptivity",
        "C(knowledge, Sum):C(complexity, Sum)": "knowledge:complexity:adaptivity",
    }
    for name, row in theirs.drop(index="Residual").iterrows():
        test = ours.pop(names[str(name)])
        assert (test.df1, test.F) == pytest.approx((row["df"], row["F"]), rel=1e-6, abs=1e-9)
    assert len(ours) == (4 if len(levels) > 1 else 2)


@given(pairs(), st.randoms(use_true_random=False))
def test_order_of_people_says_nothing(pair: Paired, random: Random) -> None:
    order = np.array(random.sample(range(len(pair.cell)), len(pair.cell)))
    assert_same(mixed_anova(pair), mixed_anova(rearranged(pair, order)))


@given(pairs(), st.permutations(range(3)), st.permutations(range(3)))
def test_names_of_levels_say_nothing(pair: Paired, groups: list[int], levels: list[int]) -> None:
    renamed = Paired(
        pair.outcome,
        pair.participants,
        np.array(groups)[pair.knowledge],
        np.array(levels)[pair.complexity],
        pair.static,
        pair.adaptive,
        0,
    )
    assert_same(mixed_anova(pair), mixed_anova(renamed))


@given(pairs())
def test_exchanging_the_rounds_changes_no_test(pair: Paired) -> None:
    exchanged = Paired(
        pair.outcome,
        pair.participants,
        pair.knowledge,
        pair.complexity,
        pair.adaptive,
        pair.static,
        0,
    )
    assert_same(mixed_anova(pair), mixed_anova(exchanged))


@given(pairs(), st.floats(0.1, 50), st.floats(-50, 50))
def test_units_change_the_intercept_alone(pair: Paired, scale: float, shift: float) -> None:
    moved = Paired(
        pair.outcome,
        pair.participants,
        pair.knowledge,
        pair.complexity,
        scale * pair.static + shift,
        scale * pair.adaptive + shift,
        0,
    )
    before, after = statistics(mixed_anova(pair)), statistics(mixed_anova(moved))
    for effect in EFFECTS[1:]:
        assert after[effect][0] == pytest.approx(before[effect][0], rel=1e-6, abs=1e-8)
        assert after[effect][3] == pytest.approx(before[effect][3], rel=1e-6, abs=1e-8)


@given(pairs())
def test_wilks_follows_from_f(pair: Paired) -> None:
    for effect in mixed_anova(pair):
        test = effect.test
        if effect.effect in WITHIN:
            assert effect.wilks == pytest.approx(1 / (1 + test.df1 * test.F / test.df2))
        else:
            assert effect.effect in BETWEEN and effect.wilks is None
        assert 0 <= effect.ges_obs_knowledge <= test.pes + 1e-12
        assert effect.ges_obs_knowledge <= effect.ges + 1e-12
        assert test.p == pytest.approx(stats.f.sf(test.F, test.df1, test.df2))


def long_frame(pair: Paired) -> pd.DataFrame:
    return pd.DataFrame(
        {
            "knowledge": pair.knowledge.astype(str),
            "level": pair.complexity.astype(str),
            "d": pair.difference / np.sqrt(2),
            "b": pair.mean * np.sqrt(2),
        }
    )


@pytest.mark.parametrize("outcome", OUTCOMES)
def test_equals_sum_coded_regression(study: StudyData, outcome: str) -> None:
    pair = paired(study, outcome)
    ours = {effect.effect: effect.test for effect in mixed_anova(pair)}
    for variable, names in (("b", BETWEEN), ("d", WITHIN)):
        model = smf.ols(f"{variable} ~ C(knowledge, Sum) * C(level, Sum)", long_frame(pair)).fit()
        table = sm_anova.anova_lm(model, typ=3)
        assert len(table) == len(names) + 1
        for name, (_, line) in zip(names, table.iterrows(), strict=False):
            test = ours[name]
            assert pytest.approx(line["F"], rel=1e-8) == test.F
            assert test.ss == pytest.approx(line["sum_sq"], rel=1e-8)
            assert test.p == pytest.approx(line["PR(>F)"], rel=1e-7)


def test_equals_pingouin_when_balanced(make_table: MakeTable, read_table: ReadTable) -> None:
    sizes = {(group, level): 6 for group in ("LOW", "MED", "HIGH") for level in ("C1", "C2", "C3")}
    pair = paired(read_table(make_table(sizes).drop(columns="disobeyed")), "engagement")
    ours = {effect.effect: effect.test for effect in mixed_anova(pair)}
    for variable, suffix in (("b", ""), ("d", ":adaptivity")):
        table = pingouin.anova(
            data=long_frame(pair), dv=variable, between=["knowledge", "level"], ss_type=2
        ).set_index("Source")
        for theirs, name in (
            ("knowledge", "knowledge"),
            ("level", "complexity"),
            ("knowledge * level", "knowledge:complexity"),
        ):
            test = ours[name + suffix]
            assert pytest.approx(table.loc[theirs, "F"], rel=1e-8) == test.F
            assert test.pes == pytest.approx(table.loc[theirs, "np2"], rel=1e-8)


@given(pairs(), st.integers(0, 8))
def test_an_empty_cell_is_named(pair: Paired, gone: int) -> None:
    kept = np.flatnonzero(pair.cell != gone)
    name = f"{('LOW', 'MED', 'HIGH')[gone // 3]} C{gone % 3 + 1}"
    with pytest.raises(Refusal, match=f"empty analysis cell .*: {name}$"):
        mixed_anova(rearranged(pair, kept))


@given(pairs())
def test_no_error_variance_is_refused(pair: Paired) -> None:
    flat = Paired(
        pair.outcome,
        pair.participants,
        pair.knowledge,
        pair.complexity,
        np.full(len(pair.cell), 0.1) * (pair.cell + 1),
        np.full(len(pair.cell), 0.3) * (pair.cell + 1),
        0,
    )
    with pytest.raises(Refusal, match="no error variance"):
        mixed_anova(flat)
