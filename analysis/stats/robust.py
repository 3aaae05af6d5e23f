"""The main tests without a normal distribution: permutations, trimmed means, and other priors."""

import numpy as np
from scipy import stats

from analysis.sources.absent import Absent, Refusal, Row
from analysis.sources.frames import Floats, Ints, Paired, StudyData, both_rounds
from analysis.stats.anova import WITHIN, difference_model, within
from analysis.stats.cellmodel import CELLS, CellModel
from analysis.stats.equivalence import jzs_bayes_factor
from analysis.stats.level import ALPHA

SEED = 20_240_503
PERMUTATIONS = 1999
#: The share cut off at either end of a trimmed mean (Wilcox, 2012).
TRIM = 0.2
#: Scales of the Bayes factor's prior: from half to twice the default of sqrt(2)/2.
PRIOR_SCALES = (2**-1.5, 0.5, 2**-0.5, 1.0, 2**0.5)


def permutation_rows(
    pair: Paired,
    permutations: int = PERMUTATIONS,
    seed: int = SEED,
    effects: tuple[str, ...] = WITHIN,
) -> list[Row]:
    """Each of these within-person effects by permutation of the residuals of the model without it
    (Freedman & Lane, 1983); for adaptivity itself their signs are flipped, which assumes symmetry
    alone.

    p counts the observed F among the others, so that it is never 0. Raises Refusal where a cell is
    empty or nothing varies.
    """
    model = difference_model(pair)
    model.require_every_cell()
    if (reason := model.why_no_error()) is not None:
        raise Refusal(reason)
    d = pair.difference / np.sqrt(2)
    rows: list[Row] = []
    for effect, hypothesis in within(pair.levels).items():
        if effect not in effects:
            continue
        rng = np.random.default_rng([seed, WITHIN.index(effect)])
        reduced = _reduced_fit(model, hypothesis)[pair.cell]
        residuals = d - reduced
        if effect == "adaptivity":
            drawn = residuals * rng.choice([-1.0, 1.0], (permutations, len(d)))
        else:
            drawn = rng.permuted(np.broadcast_to(residuals, (permutations, len(d))), axis=1)
        observed = model.test(hypothesis).F
        others = f_of_many(drawn + reduced, model, pair.cell, hypothesis)
        greater = int((others >= observed * (1 - 1e-12)).sum())
        rows.append(
            {
                "effect": effect,
                "F": observed,
                "p_permutation": (greater + 1) / (permutations + 1),
                "permutations": permutations,
            }
        )
    return rows


def _reduced_fit(model: CellModel, hypothesis: Floats) -> Floats:
    """The cell means that fit best among those without the effect: shape (9,)."""
    away = np.linalg.solve(model.spread(hypothesis), model.gaps(hypothesis))
    return np.asarray(model.means - hypothesis.T @ away / np.maximum(model.counts, 1), dtype=float)


def f_of_many(values: Floats, model: CellModel, cell: Ints, hypothesis: Floats) -> Floats:
    """F of one hypothesis for many samples (samples x people) in the same cells."""
    indicators = np.eye(len(CELLS))[cell]
    means = values @ indicators / np.maximum(model.counts, 1)
    sse = (values**2).sum(axis=1) - (means**2) @ model.counts
    gaps = means @ hypothesis.T
    spread = np.linalg.inv(model.spread(hypothesis))
    ss = np.einsum("rq,qp,rp->r", gaps, spread, gaps)
    return np.asarray(ss / len(hypothesis) / (sse / model.df), dtype=float)


def trimmed_row(study: StudyData, outcome: str, alpha: float = ALPHA) -> Row:
    """adaptive - static over people by the 20% trimmed mean, with the t of Tukey & McLaughlin
    (1963). Raises Refusal for too few people, or where the middle of the differences is flat."""
    rounds = both_rounds(study, outcome)
    gaps = np.sort((rounds["adaptive"] - rounds["static"]).to_numpy(dtype=float))
    cut = int(TRIM * len(gaps))
    if len(gaps) - 2 * cut < 2:
        raise Refusal("too few people for a trimmed mean")
    winsorised = np.clip(gaps, gaps[cut], gaps[len(gaps) - 1 - cut])
    se = float(winsorised.std(ddof=1)) / ((1 - 2 * TRIM) * len(gaps) ** 0.5)
    if se == 0:
        raise Refusal("the middle of the differences does not vary")
    mean = float(stats.trim_mean(gaps, TRIM))
    df = len(gaps) - 2 * cut - 1
    half = float(stats.t.ppf(1 - alpha / 2, df)) * se
    t = mean / se
    return {
        "trim": TRIM,
        "n": len(gaps),
        "estimate": mean,
        "SE": se,
        "df": df,
        "lower.CL": mean - half,
        "upper.CL": mean + half,
        "t": t,
        "p": float(2 * stats.t.sf(abs(t), df)),
    }


def prior_rows(study: StudyData, outcome: str) -> list[Row]:
    """The Bayes factor of adaptive - static under narrower and wider priors.

    Raises Refusal where the differences do not vary.
    """
    rounds = both_rounds(study, outcome)
    gaps = (rounds["adaptive"] - rounds["static"]).to_numpy(dtype=float)
    if len(gaps) < 2 or np.ptp(gaps) == 0:
        raise Refusal("fewer than two different differences between the rounds")
    t = float(stats.ttest_1samp(gaps, 0.0).statistic)
    rows: list[Row] = []
    for scale in PRIOR_SCALES:
        found = jzs_bayes_factor(t, len(gaps), scale)
        rows.append(
            {
                "prior_scale": scale,
                "bf10": found
                if np.isfinite(found)
                else Absent("the Bayes factor is too large for a number"),
            }
        )
    return rows
