"""The Likert items taken as ordered answers: does the sum score's verdict hang on its scale?

Within people, the sign test of adaptive against static uses the order alone. Between people, a
proportional-odds model (McCullagh, 1980) of one item gives a likelihood-ratio test of
knowledge x complexity in each round.
"""

import numpy as np
import pandas as pd
from scipy import optimize, special, stats

from analysis.sources.absent import Absent, Refusal, Row, attempt
from analysis.sources.factors import ADAPTIVITY, KNOWLEDGE, LIKERT_ITEMS
from analysis.sources.frames import Floats, Ints, StudyData, both_rounds
from analysis.stats.cellmodel import CELLS

#: The likelihood counts as greatest where no slope of its logarithm is steeper than this.
GRADIENT = 1e-4


def ordinal_rows(study: StudyData) -> dict[str, Row]:
    """For each item: the sign test over people, and the odds model's interaction by round."""
    return {
        item: {
            "adaptivity": attempt(sign_test, both_rounds(study, item)),
            "knowledge:complexity": {
                name: attempt(_interaction, study, item, name) for name in ADAPTIVITY
            },
        }
        for item in LIKERT_ITEMS
    }


def sign_test(rounds: pd.DataFrame) -> Row:
    """Exact sign test, and the chance that adaptive is rated above static (ties count half)."""
    gaps = np.sign((rounds["adaptive"] - rounds["static"]).to_numpy(dtype=float))
    raised, lowered = int((gaps > 0).sum()), int((gaps < 0).sum())
    n = len(gaps)
    if n == 0:
        raise Refusal("nobody answered in both rounds")
    p: float | Absent = (
        float(stats.binomtest(raised, raised + lowered).pvalue)
        if raised + lowered
        else Absent("everybody gave the same answer in both rounds")
    )
    return {
        "n": n,
        "raised": raised,
        "lowered": lowered,
        "tied": n - raised - lowered,
        "superiority": (raised + (n - raised - lowered) / 2) / n,
        "p": p,
    }


def _interaction(study: StudyData, item: str, adaptivity: str) -> Row:
    if not study.has("knowledge"):
        raise Refusal("there are no knowledge groups")
    people = study.participants[["knowledge", "complexity"]]
    rounds = study.rounds[study.rounds["adaptivity"] == adaptivity]
    rows = rounds.join(people, on="participant").dropna(subset=[item, "knowledge"])
    filled = set(zip(rows["knowledge"], rows["complexity"], strict=True))
    levels = study.crossed.levels
    if len(levels) < 2:
        raise Refusal("one static level, so no interaction with it")
    vacant = [" ".join(cell) for cell in CELLS if cell[1] in levels and cell not in filled]
    if vacant:
        raise Refusal(f"empty analysis cells: {', '.join(vacant)}")
    _, answers = np.unique(rows[item].to_numpy(dtype=int), return_inverse=True)
    if answers.max() == 0:
        raise Refusal("everybody gave the same answer")
    group = _indicators(rows["knowledge"], KNOWLEDGE)
    level = _indicators(rows["complexity"], levels)
    products = np.column_stack([g * v for g in group.T for v in level.T])
    main = proportional_odds(answers, np.column_stack([group, level]))
    full = proportional_odds(answers, np.column_stack([group, level, products]))
    ratio = max(0.0, 2 * (full - main))
    df = products.shape[1]
    return {"n": len(rows), "chi2": ratio, "df": df, "p": float(stats.chi2.sf(ratio, df))}


def _indicators(values: pd.Series, levels: tuple[str, ...]) -> Floats:
    return np.column_stack([(values == level).to_numpy(dtype=float) for level in levels[1:]])


def proportional_odds(answers: Ints, columns: Floats) -> float:
    """Greatest log-likelihood of P(answer <= k) = expit(theta_k - x b).

    `answers` count from 0 without gaps; `columns` is people x predictors. An infinite slope, where
    a group gives one answer only, is a limit that the likelihood reaches. Raises Refusal where the
    search does not end.
    """
    kinds = int(answers.max()) + 1
    cuts = special.logit(np.cumsum(np.bincount(answers))[:-1] / len(answers))
    start: Floats = np.concatenate([cuts[:1], np.log(np.diff(cuts)), np.zeros(columns.shape[1])])

    def loss(parameters: Floats) -> tuple[float, Floats]:
        gaps = np.exp(parameters[1 : kinds - 1])
        theta = parameters[0] + np.concatenate([[0.0], np.cumsum(gaps)])
        ends = np.concatenate([[-np.inf], theta, [np.inf]])
        eta = columns @ parameters[kinds - 1 :]
        upper, lower = ends[answers + 1] - eta, ends[answers] - eta
        # expit(u) - expit(l), kept exact in both tails
        odds = special.expit(upper) * special.expit(-lower) * -np.expm1(lower - upper)
        odds = np.maximum(odds, np.finfo(float).tiny)
        rise, fall = _bell(upper) / odds, _bell(lower) / odds
        by_theta = np.bincount(answers, rise, kinds)[:-1] - np.bincount(answers, fall, kinds)[1:]
        tails = np.cumsum(by_theta[::-1])[::-1]
        slope = np.concatenate([tails[:1], gaps * tails[1:], -(rise - fall) @ columns])
        return -float(np.log(odds).sum()), -slope

    found = optimize.minimize(loss, start, (), "BFGS", jac=True, options={"gtol": GRADIENT / 10})
    if float(np.abs(found.jac).max()) > GRADIENT:
        raise Refusal("the proportional-odds model did not converge")
    return -float(found.fun)


def _bell(x: Floats) -> Floats:
    """The logistic density."""
    return np.asarray(special.expit(x) * special.expit(-x), dtype=float)
