"""Cell means, marginal means and planned comparisons within knowledge groups (paper 5.4, 5.5).

A comparison inside one round (Fig. 7) uses that round's pooled cell error, one of difference
scores (Fig. 9) the error of adaptive - static. p-values are adjusted inside each family of three.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import combinations

import numpy as np

from analysis.sources.absent import Absent, Row
from analysis.sources.factors import ADAPTIVITY, KNOWLEDGE
from analysis.sources.frames import Floats, Paired
from analysis.stats.cellmodel import (
    CELLS,
    CellModel,
    Contrast,
    contrast_row,
    fit_cells,
    weights_of,
)
from analysis.stats.corrections import adjusted, tukey
from analysis.stats.level import ALPHA


@dataclass(frozen=True)
class RoundModels:
    """Saturated models of one outcome: each round, their mean and adaptive - static; `alpha` is
    what their intervals are made for."""

    static: CellModel
    adaptive: CellModel
    mean: CellModel
    difference: CellModel
    alpha: float = ALPHA

    @classmethod
    def of(cls, pair: Paired, alpha: float = ALPHA) -> "RoundModels":
        """Fit the four models to the listwise sample."""
        return cls(
            fit_cells(pair.static, pair.cell, pair.levels),
            fit_cells(pair.adaptive, pair.cell, pair.levels),
            fit_cells(pair.mean, pair.cell, pair.levels),
            fit_cells(pair.difference, pair.cell, pair.levels),
            alpha,
        )

    @property
    def levels(self) -> tuple[str, ...]:
        """The static levels of the design."""
        return self.mean.levels

    def by_round(self) -> Iterator[tuple[str, CellModel]]:
        """The rounds' models with their names."""
        yield from zip(ADAPTIVITY, (self.static, self.adaptive), strict=True)


def cell_rows(models: RoundModels) -> list[Row]:
    """n, mean and standard deviation of each knowledge x complexity x adaptivity cell."""
    rows: list[Row] = []
    deviations = {name: _deviations(model) for name, model in models.by_round()}
    for knowledge, level in models.mean.cells:
        index = CELLS.index((knowledge, level))
        for name, model in models.by_round():
            count = int(model.counts[index])
            rows.append(
                {
                    "knowledge": knowledge,
                    "complexity": level,
                    "adaptivity": name,
                    "n": count,
                    "mean": float(model.means[index]) if count else Absent("nobody in the cell"),
                    "sd": deviations[name][index],
                }
            )
    return rows


def _deviations(model: CellModel) -> list[float | Absent]:
    sums = np.bincount(model.cell, weights=model.residuals**2, minlength=len(CELLS))
    return [
        float(np.sqrt(total / (count - 1)))
        if count > 1
        else Absent("a standard deviation needs two people in the cell")
        for total, count in zip(sums, model.counts, strict=True)
    ]


def marginal_means(models: RoundModels) -> dict[str, list[Row]]:
    """Unweighted means by knowledge, complexity, adaptivity and cell, with intervals."""
    return {
        "knowledge": [
            {
                "knowledge": group,
                **_mean_row(models.mean.contrast(weights_of(_row_of(group, models))), models.alpha),
            }
            for group in KNOWLEDGE
        ],
        "complexity": [
            {
                "complexity": level,
                **_mean_row(models.mean.contrast(weights_of(_column_of(level))), models.alpha),
            }
            for level in models.levels
        ],
        "adaptivity": [
            {
                "adaptivity": name,
                **_mean_row(model.contrast(weights_of(models.mean.cells)), models.alpha),
            }
            for name, model in models.by_round()
        ],
        "knowledge_complexity_adaptivity": [
            {
                "knowledge": group,
                "complexity": level,
                "adaptivity": name,
                **_mean_row(model.contrast(weights_of([(group, level)])), models.alpha),
            }
            for name, model in models.by_round()
            for level in models.levels
            for group in KNOWLEDGE
        ],
    }


def _mean_row(mean: Contrast, alpha: float) -> Row:
    lower, upper = mean.interval(1 - alpha)
    return {
        "emmean": mean.estimate,
        "SE": mean.se,
        "df": mean.df,
        "lower.CL": lower,
        "upper.CL": upper,
    }


def complexity_within_knowledge_by_round(models: RoundModels) -> list[Row]:
    """C1 - C2, C1 - C3, C2 - C3 in each knowledge group and round (Fig. 7: the static round)."""
    return [
        row
        for name, model in models.by_round()
        for group in KNOWLEDGE
        for row in _levels_within(model, group, {"adaptivity": name}, models.alpha)
    ]


def complexity_within_knowledge_avg(models: RoundModels) -> list[Row]:
    """The same comparisons on the mean of the two rounds."""
    return [
        row for group in KNOWLEDGE for row in _levels_within(models.mean, group, {}, models.alpha)
    ]


def _levels_within(model: CellModel, group: str, more: Row, alpha: float) -> list[Row]:
    cells = {level: (group, level) for level in model.levels}
    return _family(model, cells, {"knowledge": group, **more}, alpha)


def difference_knowledge_within_complexity(models: RoundModels) -> list[Row]:
    """Difference scores compared between knowledge groups at each static level (Fig. 9)."""
    return [
        row
        for level in models.levels
        for row in _family(
            models.difference,
            {group: (group, level) for group in KNOWLEDGE},
            {"complexity": level},
            models.alpha,
        )
    ]


def _family(
    model: CellModel, cells: dict[str, tuple[str, str]], where: Row, alpha: float
) -> list[Row]:
    pairs = list(combinations(cells, 2))
    contrasts = [model.contrast(_gap(cells[one], cells[other])) for one, other in pairs]
    return [
        {"contrast": f"{one} - {other}", **where, **contrast_row(contrast, alpha), **p_values}
        for (one, other), contrast, p_values in zip(
            pairs, contrasts, adjusted([contrast.p for contrast in contrasts]), strict=True
        )
    ]


def difference_all_pairs(models: RoundModels) -> list[Row]:
    """All 36 pairs of cells on adaptive - static, with Tukey's adjustment too."""
    cells = [(group, level) for level in models.levels for group in KNOWLEDGE]
    pairs = list(combinations(cells, 2))
    model = models.difference
    contrasts = [model.contrast(_gap(one, other)) for one, other in pairs]
    known = np.array([c.t for c in contrasts if not isinstance(c.t, Absent)], dtype=float)
    means = int(np.count_nonzero(model.counts))
    tukey_values = iter(tukey(known, means, model.df).tolist() if len(known) else [])
    return [
        {
            "contrast": f"{' '.join(one)} - {' '.join(other)}",
            **contrast_row(contrast, models.alpha),
            **p_values,
            "p_tukey": contrast.t if isinstance(contrast.t, Absent) else next(tukey_values),
        }
        for (one, other), contrast, p_values in zip(
            pairs, contrasts, adjusted([contrast.p for contrast in contrasts]), strict=True
        )
    ]


def simple_adaptivity_within_cell(models: RoundModels) -> list[Row]:
    """adaptive - static in each analysis cell, unadjusted."""
    rows: list[Row] = []
    for level in models.levels:
        for group in KNOWLEDGE:
            contrast = models.difference.contrast(weights_of([(group, level)]))
            rows.append(
                {
                    "contrast": "adaptive - static",
                    "knowledge": group,
                    "complexity": level,
                    **contrast_row(contrast, models.alpha),
                    "p.value": contrast.p,
                }
            )
    return rows


def adaptivity_marginal(models: RoundModels) -> list[Row]:
    """adaptive - static over all cells, with the interval that equivalence is read from."""
    contrast = models.difference.contrast(weights_of(models.mean.cells))
    lower, upper = contrast.interval(1 - 2 * models.alpha)
    return [
        {
            "contrast": "adaptive - static",
            "estimate": contrast.estimate,
            "SE": contrast.se,
            "df": contrast.df,
            "lower.CL": lower,
            "upper.CL": upper,
        }
    ]


def _gap(one: tuple[str, str], other: tuple[str, str]) -> Floats:
    return weights_of([one]) - weights_of([other])


def _row_of(group: str, models: RoundModels) -> list[tuple[str, str]]:
    return [(group, level) for level in models.levels]


def _column_of(level: str) -> list[tuple[str, str]]:
    return [(group, level) for group in KNOWLEDGE]
