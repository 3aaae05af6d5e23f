"""Exact one-dimensional k-means against a search over every labelling's cuts."""

from itertools import combinations
from random import Random

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from analysis.sources.absent import Refusal
from analysis.sources.factors import KNOWLEDGE
from analysis.stats.clustering import cut_at, knowledge_groups

scores_lists = st.lists(st.integers(0, 20), min_size=3, max_size=40).filter(
    lambda scores: len(set(scores)) >= 3
)


def named(scores: list[float]) -> dict[str, float]:
    return {f"P{at:02d}": score for at, score in enumerate(scores)}


def by_search(scores: list[float]) -> list[tuple[float, tuple[float, float]]]:
    """Every (cost, greatest of LOW and of MED) in the order of the cuts."""
    distinct = sorted(set(scores))
    found = []
    for first, second in combinations(range(len(distinct) - 1), 2):
        cuts = (distinct[first], distinct[second])
        parts = (
            [s for s in scores if s <= cuts[0]],
            [s for s in scores if cuts[0] < s <= cuts[1]],
            [s for s in scores if s > cuts[1]],
        )
        found.append((sum(float(np.var(p)) * len(p) for p in parts), cuts))
    return found


@given(scores_lists)
def test_is_the_optimum_with_the_lowest_cuts(scores: list[float]) -> None:
    found = by_search(scores)
    least = min(cost for cost, _ in found)
    lowest = next(cuts for cost, cuts in found if cost <= least + 1e-9)
    result = knowledge_groups(named(scores))
    assert result.withinss == pytest.approx(least, abs=1e-9)
    assert (result.max_low, result.max_med) == lowest
    if len(found) > 1:
        rest = sorted(cost for cost, _ in found)[1]
        assert result.second_best_withinss == pytest.approx(rest, abs=1e-9)
    else:
        assert result.second_best_withinss is None


@given(scores_lists, st.randoms(use_true_random=False))
def test_order_of_people_says_nothing(scores: list[float], random: Random) -> None:
    people = list(named(scores).items())
    shuffled = random.sample(people, len(people))
    assert knowledge_groups(dict(people)).labels == knowledge_groups(dict(shuffled)).labels


@given(scores_lists)
def test_labels_follow_the_boundaries(scores: list[float]) -> None:
    result = knowledge_groups(named(scores))
    low, high = result.boundaries
    for who, score in named(scores).items():
        assert score not in (low, high)
        expected = "LOW" if score < low else "MED" if score < high else "HIGH"
        assert result.labels[who] == expected
    assert sum(result.sizes.values()) == len(scores)
    assert list(result.centers) == sorted(result.centers)


@given(scores_lists)
def test_share_of_rooms_and_number_of_rooms_agree(scores: list[float]) -> None:
    shares = [score / 20 for score in scores]
    assert knowledge_groups(named(shares)).labels == knowledge_groups(named(scores)).labels


def test_a_tie_goes_to_the_lowest_cuts() -> None:
    result = knowledge_groups(named([0, 1, 2, 3]))
    assert (result.max_low, result.max_med) == (0, 1)
    assert result.second_best_withinss == result.withinss


@pytest.mark.parametrize("scores", [[4, 4, 4, 4], [1, 2, 2, 1], []])
def test_fewer_than_three_distinct_scores(scores: list[float]) -> None:
    with pytest.raises(Refusal, match="three"):
        knowledge_groups(named(scores))


def test_a_tie_is_told_with_every_other_way() -> None:
    scores = {f"P{at}": float(at) for at in range(4)}
    found = knowledge_groups(scores)
    assert (found.max_low, found.max_med) == (0, 1)
    assert found.tied == ((0, 2), (1, 2))
    note = found.note()
    assert note is not None and "0 and 2 or 1 and 2" in note
    for low, med in found.tied:
        labels = cut_at(scores, low, med)
        assert within({who: scores[who] for who in labels}, labels) == pytest.approx(found.withinss)


def within(scores: dict[str, float], labels: dict[str, str]) -> float:
    groups = [[scores[who] for who in scores if labels[who] == group] for group in KNOWLEDGE]
    return sum(sum((x - sum(g) / len(g)) ** 2 for x in g) for g in groups)


def test_without_a_tie_nothing_is_told() -> None:
    found = knowledge_groups({"A": 0.0, "B": 1.0, "C": 5.0, "D": 20.0})
    assert found.tied == () and found.note() is None
