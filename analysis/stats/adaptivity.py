"""Tests of adaptive - static over everybody: one question, asked with three sets of weights.

The ANOVA counts the analysis cells equally (the unweighted mean of their means), the paired t
test counts people equally, and HC3 counts cells equally but lets each have its own spread. They
differ where cells are of unequal size or spread.
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from scipy import stats

from analysis.sources.absent import Absent, Refusal, Row, attempt
from analysis.sources.designs import PAPER_DESIGN, Crossed
from analysis.sources.frames import Floats, Paired, StudyData, both_rounds, paired
from analysis.stats.apa import p_words
from analysis.stats.assumptions import hc3_rows
from analysis.stats.cellmodel import cell_words, weights_of
from analysis.stats.level import ALPHA
from analysis.stats.posthoc import RoundModels


@dataclass(frozen=True)
class Overall:
    """adaptive - static of one outcome over `n` people, in points, with its standard error.

    `unit` is the standard deviation of the static round. `equal_cells` says whether the analysis
    cells count equally, as in the ANOVA's test of adaptivity, or people do.
    """

    n: int
    difference: float
    se: float
    df: int
    unit: float
    equal_cells: bool

    @property
    def estimate(self) -> float:
        """The difference in standard deviations of the static round."""
        return self.difference / self.unit

    def interval(self, level: float) -> tuple[float, float]:
        """The t interval of `estimate` at this level (0 to 1)."""
        reach = float(stats.t.ppf((1 + level) / 2, self.df)) * self.se / self.unit
        return self.estimate - reach, self.estimate + reach


def overall(study: StudyData, outcome: str) -> Overall:
    """The overall effect with the weights of the ANOVA's test of adaptivity; where that cannot be
    had (no groups, an empty cell), over people.

    Raises Refusal where too few people have both rounds, or nobody's answers vary.
    """
    if study.has("knowledge"):
        pair = paired(study, outcome)
        model = RoundModels.of(pair).difference
        contrast = model.contrast(weights_of(model.cells))
        if isinstance(contrast.estimate, float) and isinstance(contrast.se, float):
            unit = _unit(pair.static)
            n = len(pair.participants)
            return Overall(n, contrast.estimate, contrast.se, contrast.df, unit, True)
    people = both_rounds(study, outcome)
    gaps = (people["adaptive"] - people["static"]).to_numpy(dtype=float)
    if len(gaps) < 2:
        raise Refusal("fewer than two people have both rounds")
    unit = _unit(people["static"].to_numpy(dtype=float))
    if np.ptp(gaps) == 0:
        raise Refusal("everybody has the same difference between the rounds")
    se = float(gaps.std(ddof=1)) / len(gaps) ** 0.5
    return Overall(len(gaps), float(gaps.mean()), se, len(gaps) - 1, unit, False)


def _unit(static: Floats) -> float:
    if len(static) < 2 or np.ptp(static) == 0:
        raise Refusal("the static round does not vary")
    return float(static.std(ddof=1))


def adaptivity_tests(pair: Paired) -> list[Row]:
    """The three tests beside each other, each with its weights and its error.

    Raises Refusal where a cell is empty.
    """
    model = RoundModels.of(pair).difference
    model.require_every_cell()
    equal = model.contrast(weights_of(model.cells))
    hc3 = attempt(hc3_rows, pair)
    robust = hc3 if isinstance(hc3, Absent) else hc3[0]["p"]
    if np.ptp(pair.difference) > 0:
        paired_p: float | Absent = float(stats.ttest_1samp(pair.difference, 0.0).pvalue)
    else:
        paired_p = Absent("everybody has the same difference between the rounds")
    cells = {"counts_equally": f"the {cell_words(pair.levels)}", "estimate": equal.estimate}
    return [
        {"test": "ANOVA", **cells, "error": "pooled over the cells", "p": equal.p},
        {"test": "HC3", **cells, "error": "each cell's own", "p": robust},
        {"test": "paired t", "counts_equally": "people",
         "estimate": float(pair.difference.mean()), "error": "over all people", "p": paired_p},
    ]  # fmt: skip


def why_they_differ(
    tests: Mapping[str, list[Row] | Absent],
    alpha: float = ALPHA,
    crossed: Crossed = PAPER_DESIGN,
) -> list[str]:
    """One note on the outcomes (keys) whose tests fall on both sides of alpha; none if there are
    none."""
    told = []
    for outcome, rows in tests.items():
        if isinstance(rows, Absent):
            continue
        p = {str(row["test"]): row["p"] for row in rows}
        known = [value for value in p.values() if isinstance(value, float)]
        if min(known, default=1.0) < alpha <= max(known, default=0.0):
            values = ", ".join(
                f"{name} {p_words(value)}" for name, value in p.items() if isinstance(value, float)
            )
            told.append(f"{outcome} ({values})")
    if not told:
        return []
    return [
        f"tests of {crossed.gap} disagree for {'; '.join(told)}: the ANOVA and HC3 count the "
        f"{cell_words(crossed.levels)} equally, the paired t test counts people equally, and HC3 "
        "lets each cell have a spread of its own; the ANOVA's is the planned test, and the figure "
        "of the estimates has its margin"
    ]
