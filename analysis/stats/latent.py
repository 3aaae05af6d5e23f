"""Ordered answers and rescues out of a fixed number, with a random intercept a participant.

The likelihood of a participant's rounds is integrated over their intercept by Gauss-Hermite
quadrature and maximised with its own gradient: the cumulative logit model P(y <= k) =
expit(theta_k - x b - u) for an item (Agresti, 2010), and the binomial logit model for rescues,
which knows that no more than `ceiling` can be rescued. Effects are tested by likelihood ratio.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
from scipy import optimize, special, stats

from analysis.sources.absent import Refusal, Row
from analysis.sources.frames import Floats, Ints, StudyData
from analysis.stats.mixed import sum_coded

NODES = 41
#: As many victims as the missions have; more where somebody rescued more.
CEILING = 20
#: No slope of the log-likelihood may be steeper than this at its top.
GRADIENT = 1e-3
THREE_WAY = "knowledge:complexity:adaptivity"

#: Log-likelihood of each row at each node of its linear predictor (rows x nodes), its slope by the
#: predictor, and its slopes by the family's own parameters (parameters x rows x nodes).
Family: TypeAlias = Callable[[Floats, Floats], tuple[Floats, Floats, Floats]]


@dataclass(frozen=True)
class LatentFit:
    """The greatest log-likelihood, and the standard deviation of the participants' intercepts."""

    loglik: float
    sd: float


def fit_latent(columns: Floats, person: Ints, family: Family, start: Floats) -> LatentFit:
    """Maximise over the family's parameters (begun at `start`), the slopes of `columns` (rows x p)
    and the standard deviation of the intercepts. Raises Refusal where the search does not end."""
    z, weights = np.polynomial.hermite.hermgauss(NODES)
    z = np.sqrt(2) * z
    log_weights = np.log(weights / np.sqrt(np.pi))
    own, count = len(start), int(person.max()) + 1

    def loss(parameters: Floats) -> tuple[float, Floats]:
        slopes, sd = parameters[own:-1], float(np.exp(parameters[-1]))
        eta = (columns @ slopes)[:, None] + sd * z
        value, slope, own_slopes = family(eta, parameters[:own])
        joint = np.zeros((count, NODES))
        np.add.at(joint, person, value)
        joint += log_weights
        each = special.logsumexp(joint, axis=1)
        posterior = np.exp(joint - each[:, None])[person]
        weighted = posterior * slope
        gradient = np.concatenate(
            [
                np.einsum("prn,rn->p", own_slopes, posterior),
                columns.T @ weighted.sum(axis=1),
                [float((weighted * sd * z).sum())],
            ]
        )
        return -float(each.sum()), -gradient

    begin: Floats = np.concatenate([start, np.zeros(columns.shape[1]), [-0.5]])
    found = optimize.minimize(loss, begin, (), "BFGS", jac=True, options={"gtol": GRADIENT / 10})
    if float(np.abs(found.jac).max()) > GRADIENT:
        raise Refusal("the model did not converge")
    return LatentFit(-float(found.fun), float(np.exp(found.x[-1])))


def ordered(answers: Ints) -> tuple[Family, Floats]:
    """The cumulative logit family of answers that count from 0 without gaps, and its start."""
    kinds = int(answers.max()) + 1
    cuts = special.logit(np.cumsum(np.bincount(answers))[:-1] / len(answers))
    start: Floats = np.concatenate([cuts[:1], np.log(np.diff(cuts))])

    def family(eta: Floats, parameters: Floats) -> tuple[Floats, Floats, Floats]:
        gaps = np.exp(parameters[1:])
        theta = parameters[0] + np.concatenate([[0.0], np.cumsum(gaps)])
        ends = np.concatenate([[-np.inf], theta, [np.inf]])
        upper, lower = ends[answers + 1][:, None] - eta, ends[answers][:, None] - eta
        odds = special.expit(upper) * special.expit(-lower) * -np.expm1(lower - upper)
        odds = np.maximum(odds, np.finfo(float).tiny)
        rise, fall = _bell(upper) / odds, _bell(lower) / odds
        by_theta = np.array(
            [rise * (answers == k)[:, None] - fall * (answers == k + 1)[:, None]
             for k in range(kinds - 1)]
        )  # fmt: skip
        tails = np.cumsum(by_theta[::-1], axis=0)[::-1]
        own = np.concatenate([tails[:1], gaps[:, None, None] * tails[1:]])
        return np.log(odds), fall - rise, own

    return family, start


def out_of(successes: Floats, ceiling: int) -> tuple[Family, Floats]:
    """The binomial logit family of successes out of `ceiling`, and its start: an intercept."""
    chosen = special.gammaln(ceiling + 1) - special.gammaln(successes + 1)
    chosen = (chosen - special.gammaln(ceiling - successes + 1))[:, None]
    share = float(np.clip(successes.mean() / ceiling, 0.01, 0.99))

    def family(eta: Floats, parameters: Floats) -> tuple[Floats, Floats, Floats]:
        shifted = eta + parameters[0]
        value = chosen + successes[:, None] * shifted - ceiling * np.logaddexp(0.0, shifted)
        slope = successes[:, None] - ceiling * special.expit(shifted)
        return value, slope, slope[None]

    return family, np.array([special.logit(share)])


def _bell(x: Floats) -> Floats:
    return np.asarray(special.expit(x) * special.expit(-x), dtype=float)


def latent_row(study: StudyData, outcome: str, effect: str = THREE_WAY) -> Row:
    """The likelihood-ratio test of one effect on an item, or on victims, over every answered round.

    Raises Refusal without groups, with an empty cell, or where the model cannot be fitted.
    """
    study.need_groups()
    people = study.participants[["knowledge", "complexity"]]
    rows = study.rounds.join(people, on="participant").dropna(subset=[outcome, "knowledge"])
    if rows.empty or rows[outcome].nunique() < 2:
        raise Refusal("nobody answered, or everybody alike")
    design = sum_coded(rows)
    if len(np.unique(design.matrix, axis=0)) < design.matrix.shape[1]:
        raise Refusal("a cell of knowledge x complexity x adaptivity has no rows")
    values = rows[outcome].to_numpy(dtype=float)
    if outcome == "victims":
        ceiling = max(CEILING, int(values.max()))
        family, start = out_of(values, ceiling)
    else:
        _, answers = np.unique(values, return_inverse=True)
        family, start = ordered(answers.astype(np.int64))
    kept = [at for at in range(1, design.matrix.shape[1]) if at not in design.effects[effect]]
    full = fit_latent(design.matrix[:, 1:], design.person, family, start)
    less = fit_latent(design.matrix[:, kept], design.person, family, start)
    ratio = max(0.0, 2 * (full.loglik - less.loglik))
    df = len(design.effects[effect])
    return {
        "effect": effect,
        "n_rows": len(rows),
        "loglik": full.loglik,
        "sd_participant": full.sd,
        "chi2": ratio,
        "df": df,
        "p": float(stats.chi2.sf(ratio, df)),
    }
