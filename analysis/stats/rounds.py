"""Every round of a study in which an instructor has more than one: means, and a mixed model.

The paper's tests compare two rounds a person, the first with each instructor. Here all of them
count: a random intercept a person, and beside the factors of the design the round and the
building, sum-coded (`analysis.stats.mixed` has the method).
"""

from dataclasses import replace

import numpy as np
import pandas as pd

from analysis.sources.absent import Absent, Refusal, Row
from analysis.sources.factors import ADAPTIVITY
from analysis.sources.frames import StudyData
from analysis.stats.mixed import Design, effect_tests, fit_random_intercept, sum_coded, sum_columns

NUISANCES = ("round", "building")


def rounds_rows(study: StudyData, outcome: str) -> Row:
    """Means by round and instructor of one outcome, and its mixed model over all rounds.

    Raises Refusal where nobody has an instructor twice.
    """
    every = study.every_round
    if every is None:
        raise Refusal("no instructor has more than one round; `lmm` has every round")
    rows = every.dropna(subset=[outcome])
    try:
        model: Row | Absent = _model(study, rows, outcome)
    except Refusal as error:
        model = Absent(str(error))
    return {"means": round_means(rows, outcome), "lmm": model}


def round_means(rows: pd.DataFrame, outcome: str) -> list[Row]:
    """n, mean and standard deviation of each round with each instructor (long rows)."""
    found: list[Row] = []
    for number, name in sorted(set(zip(rows["round"], rows["adaptivity"], strict=True))):
        part = rows[(rows["round"] == number) & (rows["adaptivity"] == name)]
        values = part[outcome].to_numpy(dtype=float)
        found.append(
            {
                "round": int(number),
                "adaptivity": name,
                "n": len(values),
                "mean": float(values.mean()),
                "sd": float(values.std(ddof=1))
                if len(values) > 1
                else Absent("a standard deviation needs two people"),
            }
        )
    return found


def _model(study: StudyData, rows: pd.DataFrame, outcome: str) -> Row:
    if study.has("knowledge"):
        people = study.participants[["knowledge", "complexity"]]
        rows = rows.join(people, on="participant").dropna(subset=["knowledge"])
        design = sum_coded(rows, study.crossed.levels)
    else:
        design = _instructors_alone(rows)
    left_out = []
    for name in NUISANCES:
        wider = _added(design, name, rows[name])
        if np.linalg.matrix_rank(wider.matrix) == wider.matrix.shape[1]:
            design = wider
        else:
            left_out.append(name)
    if np.linalg.matrix_rank(design.matrix) < design.matrix.shape[1]:
        raise Refusal("a cell of knowledge x complexity x adaptivity has no rows")
    fit = fit_random_intercept(rows[outcome].to_numpy(dtype=float), design.matrix, design.person)
    return {
        "n_rows": fit.rows,
        "n_participants": int(design.person.max()) + 1,
        "var_participant": fit.var_participant,
        "var_resid": fit.var_resid,
        "singular": fit.singular,
        "left_out": left_out,
        "anova": effect_tests(fit, design),
    }


def _instructors_alone(rows: pd.DataFrame) -> Design:
    person = pd.factorize(rows["participant"], sort=True)[0].astype(np.int64)
    columns = sum_columns(rows["adaptivity"], ADAPTIVITY)
    matrix = np.column_stack([np.ones(len(rows)), *columns])
    return Design(matrix, ("(Intercept)", "adaptivity1"), {"adaptivity": [1]}, person)


def _added(design: Design, name: str, values: pd.Series) -> Design:
    """The design with one more factor, sum-coded."""
    columns = sum_columns(values, tuple(sorted(values.unique())))
    width = design.matrix.shape[1]
    return replace(
        design,
        matrix=np.column_stack([design.matrix, *columns]),
        columns=(*design.columns, *(f"{name}{at + 1}" for at in range(len(columns)))),
        effects={**design.effects, name: list(range(width, width + len(columns)))},
    )
