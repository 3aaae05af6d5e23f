"""Effects of what was counterbalanced: round, order and building (paper 5.3).

With one code of +-1 a participant added to the saturated cells, its slope on adaptive - static is
the effect of the round or the building, and its slope on the mean is the effect of the order, or
of building by adaptivity.
"""

from collections.abc import Callable
from typing import TypeAlias

import numpy as np
import pandas as pd

from analysis.sources.absent import Absent, Refusal, Row, attempt
from analysis.sources.frames import Floats, Paired, StudyData, paired
from analysis.stats.cellmodel import CELLS, Contrast, contrast_row
from analysis.stats.level import ALPHA
from analysis.stats.linear import added_slope

#: A code of +-1 a participant (index: participant; NaN where unknown).
Code: TypeAlias = Callable[[StudyData], pd.Series]


def order_rows(study: StudyData, alpha: float = ALPHA) -> dict[str, list[Row] | Absent]:
    """Round, order and building effects of each outcome, as far as the source knows them."""
    return {outcome: attempt(_rows, study, outcome, alpha) for outcome in study.outcomes}


def _rows(study: StudyData, outcome: str, alpha: float) -> list[Row]:
    effects: list[tuple[str, str, Code, bool]] = []
    if study.has("order"):
        effects += [
            ("round", "second - first round", _order, True),
            ("order", "static first - adaptive first", _order, False),
        ]
    if study.has("building"):
        names = sorted(study.rounds["building"].dropna().unique())
        label = " - ".join(reversed(names))
        effects += [
            ("building", label, _building, True),
            (
                "building:adaptivity",
                f"static in {names[0]} - static in {names[-1]}",
                _building,
                False,
            ),
        ]
    if not effects:
        raise Refusal("the source tells neither order nor building")
    rows: list[Row] = []
    for effect, words, code, within in effects:
        slope = attempt(_slope, study, outcome, code, within)
        numbers: Row = (
            dict.fromkeys(("estimate", "SE", "df", "lower.CL", "upper.CL", "t.ratio", "p"), slope)
            if isinstance(slope, Absent)
            else {**contrast_row(slope, alpha), "p": slope.p}
        )
        rows.append({"effect": effect, "contrast": words, **numbers})
    return rows


def _slope(study: StudyData, outcome: str, code: Code, within: bool) -> Contrast:
    pair = paired(study, outcome)
    codes = code(study).reindex(pd.Index(pair.participants)).to_numpy(dtype=float)
    known = np.isfinite(codes)
    if not known.any():
        raise Refusal("nobody with both rounds has a known code")
    # the slope of a code of +-1 is half the gap between its two groups
    y = pair.difference if within else 2 * pair.mean
    return added_slope(y[known], cell_columns(pair)[known], codes[known])


def cell_columns(pair: Paired) -> Floats:
    """An indicator column for each analysis cell that has people in it (people x cells)."""
    indicators = np.eye(len(CELLS))[pair.cell]
    return indicators[:, indicators.any(axis=0)]


def _order(study: StudyData) -> pd.Series:
    return study.participants["order"].map({"static_first": 1.0, "adaptive_first": -1.0})


def _building(study: StudyData) -> pd.Series:
    """+1 for a static round in the first of two buildings, by name."""
    names = sorted(study.rounds["building"].dropna().unique())
    if len(names) != 2:
        raise Refusal(f"building effects need two buildings; the source has {len(names)}")
    static = study.rounds[study.rounds["adaptivity"] == "static"].set_index("participant")
    return static["building"].map({names[0]: 1.0, names[1]: -1.0})
