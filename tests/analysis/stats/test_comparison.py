"""Coaches compared on the same people, against figures worked out by hand."""

import math

import numpy as np
import pandas as pd
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy import stats

from analysis.sources.absent import Absent
from analysis.stats.comparison import (
    Cell,
    cell_row,
    compared,
    reliability,
    t_interval,
    with_knowledge_groups,
)


def trial(coach: str, person: int, known: float, rescues: int, **more: object) -> dict[str, object]:
    return {
        "world": "made up",
        "building": "one",
        "person": person,
        "coach": coach,
        "known": known,
        "rescues": rescues,
        "switches": 0,
        **dict.fromkeys(("c1", "c2", "c3", "lost", "alignment"), 0.5),
        "comprehension": None,
        "share": None,
        "goals": (),
        "rooms": (),
        **more,
    }


MADE_UP = pd.DataFrame(
    [
        trial(coach, person, 0.2 if person < 3 else 0.9, rescues)
        for coach, per_person in {
            "static:1": (10, 12, 11, 9),
            "static:3": (8, 9, 10, 15),
            "ana": (11, 11, 11, 14),
        }.items()
        for person, rescues in enumerate(per_person)
    ]
)


def cell(group: str, coach: str) -> Cell:
    return next(it for it in compared(MADE_UP).cells if (it.group, it.coach) == (group, coach))


def test_the_best_static_level_is_that_of_the_group() -> None:
    assert compared(MADE_UP).best_static == {
        ("made up", "LOW"): "static:1",
        ("made up", "HIGH"): "static:3",
    }


def test_differences_are_taken_person_by_person() -> None:
    low = cell("LOW", "ana")
    differences = np.array([1, -1, 0])
    expected = stats.ttest_1samp(differences, 0).confidence_interval()
    assert low.minus_best_static is not None
    assert low.minus_best_static.estimate == pytest.approx(0)
    assert low.minus_best_static.lower == pytest.approx(expected.low)
    assert low.minus_best_static.upper == pytest.approx(expected.high)
    assert (low.n, low.people, low.rescues) == (3, 3, 11)


def test_one_person_has_no_interval_and_the_reason_is_given() -> None:
    high = cell("HIGH", "ana")
    assert high.rescues == 14
    assert high.rescues_interval is None
    assert isinstance(cell_row(high)["minus_best_static"], Absent)


def test_the_missions_of_one_person_count_once() -> None:
    twice = pd.concat([MADE_UP, MADE_UP.assign(building="two")])
    once, doubled = compared(MADE_UP).cells, compared(twice).cells
    for one, two in zip(once, doubled, strict=True):
        assert two.n == 2 * one.n
        assert two.people == one.people
        assert two.minus_best_static == one.minus_best_static


@given(st.floats(0, 1))
def test_everybody_is_in_one_group(known: float) -> None:
    group = with_knowledge_groups(pd.DataFrame({"known": [known]}))["group"][0]
    value = round(known, 9)
    assert group == ("LOW" if value <= 0.40 else "MED" if value <= 0.65 else "HIGH")


def test_a_calibration_counts_every_choice() -> None:
    pairs = [(0.05, False), (0.05, True), (0.95, True), (1.0, True)]
    tenths = reliability(pairs)
    assert [(tenth.known, tenth.n) for tenth in tenths] == [(0.5, 2), (1.0, 2)]
    assert tenths[1].p == pytest.approx(0.975)


@given(st.lists(st.floats(-20, 20), min_size=2, max_size=30))
def test_an_interval_holds_its_mean(values: list[float]) -> None:
    interval = t_interval(np.array(values))
    assert interval is not None
    assert interval.lower <= interval.estimate + 1e-9
    assert interval.upper >= interval.estimate - 1e-9
    assert math.isfinite(interval.upper)
