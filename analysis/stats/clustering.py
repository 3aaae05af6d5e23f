"""Knowledge groups: the exact optimum of one-dimensional k-means with three clusters (paper 5.3).

In one dimension an optimal cluster is an interval of the sorted scores, so a grouping is two cuts
between distinct scores. The within-cluster sum of squares of an interval comes from prefix sums,
and all pairs of cuts are compared: the optimum is exact and needs no start value.
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from analysis.sources.absent import Absent, Refusal, Row
from analysis.sources.factors import KNOWLEDGE
from analysis.sources.frames import Floats, Ints

#: Two sums of squares this close, relative to the total, are a tie.
TIE = 1e-12


@dataclass(frozen=True)
class Clustering:
    """Three groups of participants by score.

    `boundaries` lie midway between neighbouring distinct scores; `labels` maps participant to
    LOW, MED or HIGH; sums of squares are in squared units of the score. `tied` are the other cuts
    (greatest score of LOW, of MED) whose sum of squares is the same.
    """

    withinss: float
    second_best_withinss: float | None
    max_low: float
    max_med: float
    boundaries: tuple[float, float]
    centers: tuple[float, float, float]
    labels: dict[str, str]
    tied: tuple[tuple[float, float], ...] = ()

    @property
    def sizes(self) -> dict[str, int]:
        """Participants in each group."""
        members = list(self.labels.values())
        return {group: members.count(group) for group in KNOWLEDGE}

    def row(self) -> Row:
        """The clustering as written to the results."""
        second = self.second_best_withinss
        return {
            "withinss": self.withinss,
            "second_best_withinss": second
            if second is not None
            else Absent("three distinct scores can be grouped in one way only"),
            "max_low": _whole(self.max_low),
            "max_med": _whole(self.max_med),
            "boundaries": list(self.boundaries),
            "centers": list(self.centers),
            "sizes": dict(self.sizes),
            "labels": dict(self.labels),
        }

    def note(self) -> str | None:
        """What to tell of a tie, or None."""
        if not self.tied:
            return None
        cuts = " or ".join(f"{low:g} and {med:g}" for low, med in self.tied)
        ways = "another way" if len(self.tied) == 1 else f"{len(self.tied)} other ways"
        return (
            f"the quiz scores form three groups equally well in {ways}: LOW and MED end at "
            f"{self.max_low:g} and {self.max_med:g} (used: the lowest cuts), or at {cuts}; the "
            "ANOVAs of the other grouping stand under sensitivity, other_groupings"
        )


def knowledge_groups(scores: Mapping[str, float]) -> Clustering:
    """Group participants by score; ties between optima go to the lowest cuts.

    Raises Refusal for fewer than three distinct scores.
    """
    values = np.array(list(scores.values()), dtype=float)
    distinct, counts = np.unique(values, return_counts=True)
    if len(distinct) < len(KNOWLEDGE):
        raise Refusal(
            f"{len(distinct)} distinct quiz score{'s' if len(distinct) != 1 else ''} cannot form "
            "three knowledge groups; at least three are needed"
        )
    low, med, cost = _all_groupings(distinct, counts.astype(float))
    total = _interval_costs(distinct, counts.astype(float))[0, -1]
    best, *tied = np.flatnonzero(cost <= cost.min() + TIE * total).tolist()
    rest = np.delete(cost, best)
    max_low, max_med = float(distinct[low[best]]), float(distinct[med[best]])
    masks = (values <= max_low, (values > max_low) & (values <= max_med), values > max_med)
    centers = tuple(float(values[mask].mean()) for mask in masks)
    return Clustering(
        withinss=float(cost[best]),
        second_best_withinss=float(rest.min()) if len(rest) else None,
        max_low=max_low,
        max_med=max_med,
        boundaries=(
            float(distinct[low[best]] + distinct[low[best] + 1]) / 2,
            float(distinct[med[best]] + distinct[med[best] + 1]) / 2,
        ),
        centers=(centers[0], centers[1], centers[2]),
        labels=cut_at(scores, max_low, max_med),
        tied=tuple((float(distinct[low[one]]), float(distinct[med[one]])) for one in tied),
    )


def cut_at(scores: Mapping[str, float], max_low: float, max_med: float) -> dict[str, str]:
    """The group of each participant, where LOW ends at `max_low` and MED at `max_med`."""
    return {
        who: KNOWLEDGE[int(score > max_low) + int(score > max_med)] for who, score in scores.items()
    }


def _interval_costs(distinct: Floats, counts: Floats) -> Floats:
    """cost[i, j]: within sum of squares of the distinct scores i..j (0 below the diagonal)."""
    centred = distinct - np.average(distinct, weights=counts)
    number = np.concatenate([[0.0], np.cumsum(counts)])
    first = np.concatenate([[0.0], np.cumsum(counts * centred)])
    second = np.concatenate([[0.0], np.cumsum(counts * centred**2)])
    span = number[None, 1:] - number[:-1, None]
    linear = first[None, 1:] - first[:-1, None]
    square = second[None, 1:] - second[:-1, None]
    inside = np.triu(np.ones_like(span, dtype=bool))
    costs = square - linear**2 / np.where(inside, span, 1.0)
    return np.where(inside, np.maximum(costs, 0.0), 0.0)


def _all_groupings(distinct: Floats, counts: Floats) -> tuple[Ints, Ints, Floats]:
    """Last index of LOW, last index of MED and cost of each grouping, lowest cuts first."""
    costs = _interval_costs(distinct, counts)
    size = len(distinct)
    first, second = np.triu_indices(size - 1, k=1)
    low, med = first.astype(np.int64), second.astype(np.int64)
    return low, med, costs[0, low] + costs[low + 1, med] + costs[med + 1, size - 1]


def _whole(score: float) -> float | int:
    return int(score) if score == int(score) else score
