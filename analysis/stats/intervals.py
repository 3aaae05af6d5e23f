"""Bootstrap intervals: percentiles over people drawn again, seeded; their level is 1 - alpha."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy import stats

from analysis.sources.absent import Refusal
from analysis.sources.frames import Floats, Ints
from analysis.stats.level import ALPHA

SEED = 20_240_502
DRAWS = 2000


@dataclass(frozen=True)
class Interval:
    """An estimate and its interval."""

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


def mean_interval(values: Floats, alpha: float = ALPHA) -> Interval:
    """The mean. Raises Refusal for no values."""
    return _interval(_mean, values, alpha=alpha)


def gap_interval(ones: Floats, others: Floats, alpha: float = ALPHA) -> Interval:
    """Mean of `ones` less mean of `others`, two groups. Raises Refusal for an empty one."""

    def gap(a: Floats, b: Floats, axis: int = -1) -> Floats:
        return _mean(a, axis) - _mean(b, axis)

    return _interval(gap, ones, others, alpha=alpha)


def auc(ones: Floats, others: Floats) -> float:
    """How often one of `ones` is greater than one of `others`; a tie counts half."""
    return float(_auc(ones, others))


def auc_interval(ones: Floats, others: Floats, alpha: float = ALPHA) -> Interval:
    """The same with its interval. Raises Refusal for an empty group."""
    return _interval(_auc, ones, others, alpha=alpha)


def clustered_share(people: Ints, count: int, truth: Floats, alpha: float = ALPHA) -> Interval:
    """The mean of `truth` over rows that belong to people; the interval draws whole people.

    `people` numbers each row's person from 0 to `count` - 1. Raises Refusal for nobody.
    """
    rows = np.bincount(people, minlength=count).astype(float)
    sums = np.bincount(people, truth, minlength=count).astype(float)
    return _interval(_share, sums, rows, paired=True, alpha=alpha)


def _mean(values: Floats, axis: int = -1) -> Floats:
    return np.asarray(values.mean(axis))


def _share(sums: Floats, rows: Floats, axis: int = -1) -> Floats:
    with np.errstate(invalid="ignore"):
        return np.asarray(sums.sum(axis) / rows.sum(axis))


def _auc(ones: Floats, others: Floats, axis: int = -1) -> Floats:
    ranks = stats.rankdata(np.concatenate([ones, others], axis=axis), axis=axis)
    n, m = ones.shape[axis], others.shape[axis]
    rank_sum = np.take(ranks, np.arange(n), axis=axis).sum(axis)
    return np.asarray((rank_sum - n * (n + 1) / 2) / (n * m))


def _interval(
    statistic: Callable[..., Floats], *samples: Floats, paired: bool = False, alpha: float
) -> Interval:
    if any(len(sample) == 0 for sample in samples):
        raise Refusal("nobody is in one of the groups")
    drawn = stats.bootstrap(
        samples,
        statistic,
        paired=paired,
        n_resamples=DRAWS,
        method="percentile",
        rng=np.random.default_rng([SEED, *map(len, samples)]),
        vectorized=True,
    ).bootstrap_distribution
    lower, upper = np.nanpercentile(drawn, (50 * alpha, 100 - 50 * alpha))
    return Interval(float(statistic(*samples)), float(lower), float(upper))
