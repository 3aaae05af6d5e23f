"""Bootstrap intervals and the conclusions drawn from them."""

import re

import numpy as np
import pandas as pd
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy import stats

from analysis.pages.behaviour import (
    CONCLUSIONS,
    auc_rows,
    conclusion_table,
    level_rows,
    rescue_rows,
)
from analysis.sources.absent import Refusal
from analysis.stats.intervals import auc, auc_interval, clustered_share, gap_interval, mean_interval

values = st.lists(st.integers(-5, 5), min_size=1, max_size=12)


@given(values, values)
def test_auc_of_swapped_groups_is_the_rest(ones: list[int], others: list[int]) -> None:
    one, other = np.array(ones, dtype=float), np.array(others, dtype=float)
    assert auc(one, other) == pytest.approx(1 - auc(other, one))
    assert auc(one, other) == pytest.approx(
        np.mean([(a > b) + (a == b) / 2 for a in ones for b in others])
    )


def test_groups_apart_and_alike() -> None:
    assert auc_interval(np.array([3.0, 4]), np.array([1.0, 2])).lower == 1
    alike = auc_interval(np.arange(20.0), np.arange(20.0))
    assert alike.lower < 0.5 < alike.upper


def test_an_interval_narrows_with_people_and_is_always_the_same() -> None:
    rng = np.random.default_rng(1)
    few, many = rng.normal(2, 1, 20), rng.normal(2, 1, 500)
    wide, narrow = mean_interval(few), mean_interval(many)
    assert narrow.upper - narrow.lower < (wide.upper - wide.lower) / 3
    assert narrow.sign == 1
    assert narrow.lower == pytest.approx(many.mean() - 1.96 * many.std() / 500**0.5, abs=0.02)
    assert wide == mean_interval(few)


@pytest.mark.parametrize("alpha", [0.01, 0.05, 0.2])
def test_an_interval_has_the_level_that_is_asked_for(alpha: float) -> None:
    many = np.random.default_rng(2).normal(2, 1, 500)
    half = stats.norm.isf(alpha / 2) * many.std() / 500**0.5
    found = mean_interval(many, alpha)
    assert [found.lower, found.upper] == pytest.approx(
        [many.mean() - half, many.mean() + half], abs=0.02
    )


def test_a_stricter_level_widens_every_interval_of_a_table() -> None:
    missions = published()
    missions = missions.assign(switches=missions["share_c2"] * 10, complexity="C2")
    for rows in (level_rows, rescue_rows, auc_rows):
        told = [str(table) for table in (rows(missions), rows(missions, 0.001))]
        ends = [re.findall(r"\[([-\d.]+), ([-\d.]+)\]", text) for text in told]
        widths = [[float(high) - float(low) for low, high in one] for one in ends]
        assert widths[0] and all(np.array(widths[1]) >= np.array(widths[0]))
        assert sum(widths[1]) > sum(widths[0])
    verdicts = [conclusion_table(missions.assign(all=""), ["all"], alpha) for alpha in (0.5, 1e-3)]
    opened = [(table == "open").to_numpy().sum() for table in verdicts]
    assert opened[0] <= opened[1]


def test_whole_people_are_drawn() -> None:
    truth = np.repeat([0.0, 1, 1, 0], 50)
    people = np.repeat([0, 1, 2, 3], 50)
    clustered = clustered_share(people, 4, truth)
    apart = mean_interval(truth)
    assert clustered.estimate == apart.estimate == 0.5
    assert clustered.upper - clustered.lower > 3 * (apart.upper - apart.lower)


def test_an_empty_group_is_refused() -> None:
    with pytest.raises(Refusal, match="nobody"):
        gap_interval(np.array([1.0]), np.array([]))


def published(seed: int = 1) -> pd.DataFrame:
    """Missions that go as the paper says."""
    rng = np.random.default_rng(seed)
    levels = {"LOW": (0.7, 0.2, 0.1), "MED": (0.3, 0.6, 0.1), "HIGH": (0.1, 0.6, 0.3)}
    rows = []
    for at, (group, (c1, c2, c3)) in enumerate(levels.items()):
        for who in range(15):
            drift = rng.normal(0, 0.02)
            person = {
                "participant": f"{group}{who}",
                "knowledge": group,
                "share_c1": c1 - drift,
                "share_c2": c2,
                "share_c3": c3 + drift,
                "mean_comprehension": 0.5 + 0.1 * at + rng.normal(0, 0.05),
                "preset": "calibrated",
                "people": "made up",
            }
            saved = 10 + 2 * at + rng.normal(0, 0.5) + rng.normal(0, 0.2, 2)
            rows += [
                {**person, "adaptivity": name, "victims": victims}
                for name, victims in zip(("static", "adaptive"), saved, strict=True)
            ]
    return pd.DataFrame(rows)


def test_every_statement_holds_where_missions_go_as_published() -> None:
    table = conclusion_table(published(), ["preset", "people"])
    assert len(table) == len(CONCLUSIONS)
    assert (table["calibrated, made up"] == "holds").all()


def test_statements_fail_where_knowledge_works_the_other_way() -> None:
    other_way = published().replace({"knowledge": {"LOW": "HIGH", "HIGH": "LOW"}})
    gain = 5.0 * (other_way["adaptivity"] == "adaptive")
    table = conclusion_table(other_way.assign(victims=other_way["victims"] + gain), ["preset"])
    verdicts = dict(zip([one.words for one in CONCLUSIONS], table["calibrated"], strict=True))
    assert verdicts.pop("MED is mostly led at C2") == "holds"
    assert verdicts.pop("HIGH gets less C1 than MED") == "fails"
    assert set(verdicts.values()) <= {"fails", "open"}
    assert list(verdicts.values()).count("fails") >= 5


def test_what_cannot_be_measured_is_open() -> None:
    table = conclusion_table(published().query("knowledge == 'MED'"), ["preset"])
    verdicts = dict(zip([one.words for one in CONCLUSIONS], table["calibrated"], strict=True))
    assert verdicts["LOW is mostly led at C1"] == "open"
    assert verdicts["MED is mostly led at C2"] == "holds"
