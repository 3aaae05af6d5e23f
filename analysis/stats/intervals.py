"""Bootstrap intervals: percentiles over people drawn again, seeded."""

from dataclasses import dataclass

import numpy as np

from analysis.sources.absent import Refusal
from analysis.sources.frames import Floats, Ints

SEED = 20_240_502
DRAWS = 2000


@dataclass(frozen=True)
class Interval:
    """An estimate and its 95% interval."""

    estimate: float
    lower: float
    upper: float

    @property
    def sign(self) -> int:
        """1 where the whole interval is above zero, -1 where it is below, else 0."""
        return int(self.lower > 0) - int(self.upper < 0)

    def minus(self, reference: float) -> "Interval":
        """The same, counted from `reference`."""
        return Interval(self.estimate - reference, self.lower - reference, self.upper - reference)

    def __str__(self) -> str:
        return f"{self.estimate:.2f} [{self.lower:.2f}, {self.upper:.2f}]"


def mean_interval(values: Floats) -> Interval:
    """The mean. Raises Refusal for no values."""
    means = values[_draws(len(values))].mean(axis=1)
    return _interval(float(values.mean()), means)


def gap_interval(ones: Floats, others: Floats) -> Interval:
    """Mean of `ones` less mean of `others`, two groups. Raises Refusal for an empty one."""
    means = ones[_draws(len(ones))].mean(axis=1)
    other_means = others[_draws(len(others), 1)].mean(axis=1)
    return _interval(float(ones.mean() - others.mean()), means - other_means)


def auc(ones: Floats, others: Floats) -> float:
    """How often one of `ones` is greater than one of `others`; a tie counts half."""
    gaps = np.sign(ones[:, None] - others[None, :])
    return float((gaps.mean() + 1) / 2)


def auc_interval(ones: Floats, others: Floats) -> Interval:
    """The same with its interval. Raises Refusal for an empty group."""
    first, second = _draws(len(ones)), _draws(len(others), 1)
    gaps = (np.sign(ones[:, None] - others[None, :]) + 1) / 2
    drawn = np.array(
        [gaps[np.ix_(one, other)].mean() for one, other in zip(first, second, strict=True)]
    )
    return _interval(auc(ones, others), drawn)


def clustered_share(people: Ints, count: int, truth: Floats) -> Interval:
    """The mean of `truth` over rows that belong to people; the interval draws whole people.

    `people` numbers each row's person from 0 to `count` - 1. Raises Refusal for nobody.
    """
    rows = np.bincount(people, minlength=count).astype(float)
    sums = np.bincount(people, truth, minlength=count)
    draws = _draws(count)
    drawn = rows[draws].sum(axis=1)
    shares = np.divide(
        sums[draws].sum(axis=1), drawn, out=np.full(len(drawn), np.nan), where=drawn > 0
    )
    return _interval(float(truth.mean()), shares)


def _draws(size: int, purpose: int = 0) -> Ints:
    if size == 0:
        raise Refusal("nobody is in one of the groups")
    rng = np.random.default_rng([SEED, size, purpose])
    return rng.integers(0, size, (DRAWS, size))


def _interval(estimate: float, drawn: Floats) -> Interval:
    lower, upper = np.nanpercentile(drawn, (2.5, 97.5))
    return Interval(estimate, float(lower), float(upper))
