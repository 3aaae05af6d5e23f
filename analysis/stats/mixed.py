"""A mixed model with a random intercept a participant, which keeps partial rows.

REML for y = X b + u + e with var(u) = tau^2 a participant and var(e) = sigma^2 a row, profiled
over the one ratio lambda = tau^2/sigma^2 (Bates et al., 2015); Type III F tests on sum-coded
factors with Satterthwaite degrees of freedom from the observed information (Fai & Cornelius,
1996; Kuznetsova et al., 2017), and beside them those of Kenward and Roger.
"""

from collections.abc import Hashable
from dataclasses import dataclass

import numpy as np
import pandas as pd
from scipy import optimize, stats

from analysis.sources.absent import Absent, Refusal, Row
from analysis.sources.factors import ADAPTIVITY, COMPLEXITY, KNOWLEDGE
from analysis.sources.frames import Floats, Ints, StudyData
from analysis.stats.kenward_roger import KenwardRoger

TERMS = (
    ("knowledge",),
    ("complexity",),
    ("adaptivity",),
    ("knowledge", "complexity"),
    ("knowledge", "adaptivity"),
    ("complexity", "adaptivity"),
    ("knowledge", "complexity", "adaptivity"),
)
#: Shares of the person variance, tau^2/(tau^2 + sigma^2), between which the optimum is bracketed.
SHARES = np.linspace(0.0, 0.999, 60)


@dataclass(frozen=True)
class Design:
    """Sum-coded columns of the saturated model, and which belong to which effect.

    `matrix` is rows x cells (18 in the paper's design); `person` numbers the participants from 0.
    """

    matrix: Floats
    columns: tuple[str, ...]
    effects: dict[str, list[int]]
    person: Ints


@dataclass(frozen=True)
class MixedFit:
    """The REML fit: fixed effects, their covariance, variances, and the information on these."""

    beta: Floats
    covariance: Floats
    var_participant: float
    var_resid: float
    loglik: float
    covariance_slopes: tuple[Floats, Floats]
    variance_covariance: Floats
    kenward_roger: KenwardRoger
    rows: int

    @property
    def singular(self) -> bool:
        """Whether the participants' variance is estimated as nil."""
        return self.var_participant == 0

    def satterthwaite(self, weights: Floats) -> float:
        """Degrees of freedom of one linear combination of fixed effects."""
        if self.singular:
            return float(self.rows - len(self.beta))
        variance = weights @ self.covariance @ weights
        slope = np.array([weights @ part @ weights for part in self.covariance_slopes])
        return float(2 * variance**2 / (slope @ self.variance_covariance @ slope))


def sum_coded(rows: pd.DataFrame, levels: tuple[str, ...] = COMPLEXITY) -> Design:
    """Sum-code the three factors of `rows` (columns participant and the factors); `levels` are the
    static levels of the design, and one alone has no effects."""
    factors = {"knowledge": KNOWLEDGE, "complexity": levels, "adaptivity": ADAPTIVITY}
    main = {name: sum_columns(rows[name], values) for name, values in factors.items()}
    columns = ["(Intercept)"]
    parts = [np.ones(len(rows))]
    effects: dict[str, list[int]] = {}
    for term in TERMS:
        if not all(main[factor] for factor in term):
            continue
        names, values = [""], [np.ones(len(rows))]
        for factor in term:
            # the first factor's columns vary fastest
            pairs = [
                (f"{name}:{factor}{k + 1}" if name else f"{factor}{k + 1}", value * column)
                for k, column in enumerate(main[factor])
                for name, value in zip(names, values, strict=True)
            ]
            names, values = [name for name, _ in pairs], [value for _, value in pairs]
        effects[":".join(term)] = list(range(len(columns), len(columns) + len(names)))
        columns += names
        parts += values
    person = pd.factorize(rows["participant"], sort=True)[0].astype(np.int64)
    return Design(np.column_stack(parts), tuple(columns), effects, person)


def sum_columns(values: pd.Series, levels: tuple[Hashable, ...]) -> list[Floats]:
    """One column for each level but the last, which is -1 in all of them."""
    last = (values == levels[-1]).to_numpy(dtype=float)
    return [(values == level).to_numpy(dtype=float) - last for level in levels[:-1]]


class _Profile:
    """REML of one data set as a function of lambda, by whitening within participants."""

    def __init__(self, y: Floats, x: Floats, person: Ints) -> None:
        self.y, self.x, self.person = y, x, person
        self.counts = np.bincount(person).astype(float)

    def summed(self, values: Floats) -> Floats:
        """The sum over each row's participant (J applied)."""
        sums = np.zeros((len(self.counts), values.shape[1]))
        np.add.at(sums, self.person, values)
        return np.asarray(sums[self.person], dtype=float)

    def weighted(self, values: Floats, lam: float) -> Floats:
        """(I + lambda J)^-1 applied within each participant."""
        shrink = (lam / (1 + lam * self.counts))[self.person]
        return np.asarray(values - shrink[:, None] * self.summed(values), dtype=float)

    def whitened(self, values: Floats, lam: float) -> Floats:
        """(I + lambda J)^-1/2 applied within each participant."""
        shrink = (1 - 1 / np.sqrt(1 + lam * self.counts)) / self.counts
        return np.asarray(values - shrink[self.person][:, None] * self.summed(values), dtype=float)

    def solve(self, lam: float) -> tuple[Floats, Floats, float, float]:
        """beta, (X'W X)^-1, the residual variance and the REML log-likelihood at lambda."""
        x, y = self.whitened(self.x, lam), self.whitened(self.y[:, None], lam)[:, 0]
        inverse: Floats = np.linalg.inv(x.T @ x).astype(float)
        beta: Floats = inverse @ (x.T @ y)
        residual = y - x @ beta
        df = len(y) - x.shape[1]
        sigma2 = float(residual @ residual) / df
        log_v = float(np.log1p(lam * self.counts).sum())
        log_x = -float(np.linalg.slogdet(inverse)[1])
        loglik = -0.5 * (log_v + log_x + df * float(1 + np.log(2 * np.pi * sigma2)))
        return beta, inverse, sigma2, loglik

    def criterion(self, share: float) -> float:
        """-2 REML log-likelihood at a share tau^2/(tau^2 + sigma^2)."""
        return -2 * self.solve(share / (1 - share))[3]

    def best_share(self) -> float:
        """The share that maximises REML; exactly 0 on the boundary."""
        values = [self.criterion(share) for share in SHARES]
        at = int(np.argmin(values))
        lower, upper = SHARES[max(at - 1, 0)], SHARES[min(at + 1, len(SHARES) - 1)]
        found = optimize.minimize_scalar(
            self.criterion, bounds=(lower, upper), method="bounded", options={"xatol": 1e-10}
        )
        return 0.0 if values[0] <= found.fun + 1e-10 else float(found.x)


def fit_random_intercept(y: Floats, x: Floats, person: Ints) -> MixedFit:
    """REML fit of a random intercept a person (y: rows; x: rows x p; person: numbers from 0).

    x has full rank. Raises Refusal where it leaves no residual degrees of freedom, where nobody has
    two rows, and where residuals are nil.
    """
    if len(y) <= x.shape[1]:
        raise Refusal(f"{len(y)} rows cannot carry {x.shape[1]} fixed effects")
    if np.bincount(person).max() < 2:
        raise Refusal("nobody has both rounds, so person and residual cannot be told apart")
    profile = _Profile(y, x, person)
    if profile.solve(0.0)[2] <= (1e-10 * float(np.abs(y).max())) ** 2:
        raise Refusal("nobody differs from their cell's mean, so there is no error variance")
    share = profile.best_share()
    if share >= SHARES[-2]:
        raise Refusal("the rounds of a person differ by their cell's means alone")
    lam = share / (1 - share)
    beta, inverse, sigma2, loglik = profile.solve(lam)
    slopes, information, expected = _variance_information(profile, lam, sigma2, inverse)
    if lam > 0 and bool((np.linalg.eigvalsh(information) <= 0).any()):
        raise Refusal("the likelihood is flat at its top, so the variances are not identified")
    return MixedFit(
        beta=beta,
        covariance=sigma2 * inverse,
        var_participant=lam * sigma2,
        var_resid=sigma2,
        loglik=loglik,
        covariance_slopes=slopes,
        variance_covariance=np.linalg.pinv(information).astype(float),
        kenward_roger=expected,
        rows=len(y),
    )


def _variance_information(
    profile: _Profile, lam: float, sigma2: float, inverse: Floats
) -> tuple[tuple[Floats, Floats], Floats, KenwardRoger]:
    """Slopes of the fixed effects' covariance, the observed REML information, and the adjustment
    of Kenward and Roger, which is made from the expected one.

    With W = V^-1, P = W - W X C X' W and V_1, V_2 = dV/d(tau^2, sigma^2), the information is
    y'P V_i P V_j P y - tr(P V_i P V_j)/2 and is expected to be tr(P V_i P V_j)/2, and
    dC = C X' W V_i W X C. V is made of a block a person, so nothing larger than rows x columns is
    ever held.
    """
    covariance = sigma2 * inverse
    wx = profile.weighted(profile.x, lam) / sigma2
    fitted = profile.weighted(profile.y[:, None], lam) / sigma2
    fitted = fitted - wx @ (covariance @ (wx.T @ profile.y[:, None]))
    parts = (profile.summed, lambda values: values)
    tilted = [part(fitted) for part in parts]
    bent = [part(wx) for part in parts]
    crossed = [wx.T @ part for part in bent]
    blocks = _block_traces(profile.counts, lam, sigma2)
    information, expected = np.empty((2, 2)), np.empty((2, 2))
    doubly = np.empty((2, 2, *covariance.shape))
    for i in range(2):
        for j in range(2):
            outer = profile.weighted(tilted[j], lam) / sigma2
            outer = outer - wx @ (covariance @ (wx.T @ tilted[j]))
            doubly[i, j] = bent[i].T @ (profile.weighted(bent[j], lam) / sigma2)
            trace = blocks[i][j] - 2 * np.sum(covariance * doubly[i, j])
            trace += np.sum((covariance @ crossed[i]) * (covariance @ crossed[j]).T)
            expected[i, j] = trace / 2
            information[i, j] = float(tilted[i][:, 0] @ outer[:, 0]) - trace / 2
    slopes = [covariance @ cross @ covariance for cross in crossed]
    adjustment = KenwardRoger.of(covariance, np.array(crossed), doubly, expected)
    return (slopes[0], slopes[1]), information, adjustment


def _block_traces(counts: Floats, lam: float, sigma2: float) -> list[list[float]]:
    """tr(W V_i W V_j): sums over persons, whose blocks of W are (I - c J) / sigma^2."""
    left = 1 / (1 + lam * counts)
    both = float((counts**2 * left**2).sum())
    one = float((counts * left**2).sum())
    none = float((counts - 1 + left**2).sum())
    return [[both / sigma2**2, one / sigma2**2], [one / sigma2**2, none / sigma2**2]]


def _f_test(fit: MixedFit, columns: list[int]) -> tuple[float, int, float, float]:
    """F, its two degrees of freedom and p of the hypothesis that these columns are nil.

    The denominator combines the Satterthwaite df of the hypothesis's principal directions.
    """
    block = fit.covariance[np.ix_(columns, columns)]
    values, vectors = np.linalg.eigh(block)
    q = len(columns)
    t_squared = (vectors.T @ fit.beta[columns]) ** 2 / values
    f = float(t_squared.sum()) / q
    dfs = []
    for direction in vectors.T:
        weights = np.zeros(len(fit.beta))
        weights[columns] = direction
        dfs.append(fit.satterthwaite(weights))
    df2 = dfs[0] if q == 1 else _combined_df(np.array(dfs), q)
    return f, q, df2, float(stats.f.sf(f, q, df2))


def _combined_df(dfs: Floats, q: int) -> float:
    if np.ptp(dfs) < 1e-8 * dfs.mean():
        return float(dfs.mean())
    if bool((dfs <= 2).any()):
        return 2.0
    expected = float((dfs / (dfs - 2)).sum())
    return 2 * expected / (expected - q)


def answered(study: StudyData, outcome: str) -> pd.DataFrame:
    """The rounds with an answer of people with a group, with their group and static level.

    Raises Refusal where there are no knowledge groups or no answers.
    """
    study.need_groups()
    people = study.participants[["knowledge", "complexity"]]
    rows = study.rounds.join(people, on="participant").dropna(subset=[outcome, "knowledge"])
    if rows.empty:
        raise Refusal(f"nobody has an answer for {outcome}")
    return rows


def mixed_model(study: StudyData, outcome: str) -> Row:
    """Fixed effects, variances and Type III tests of one outcome, on every answered round.

    Where a cell of the three factors has no rows the effects have no estimate: the variances are
    then those of the model with one mean a filled cell. Raises Refusal where there are no knowledge
    groups or the model cannot be fitted.
    """
    rows = answered(study, outcome)
    design = sum_coded(rows, study.crossed.levels)
    filled, cell = np.unique(design.matrix, axis=0, return_inverse=True)
    complete = len(filled) == design.matrix.shape[1]
    matrix = design.matrix if complete else np.eye(len(filled))[cell.ravel()]
    fit = fit_random_intercept(rows[outcome].to_numpy(dtype=float), matrix, design.person)
    effects = (
        _effect_rows(fit, design)
        if complete
        else dict.fromkeys(
            ("reml_loglik", "fixef", "anova"),
            Absent("a cell of knowledge x complexity x adaptivity has no rows"),
        )
    )
    return {
        "n_rows": fit.rows,
        "n_participants": int(design.person.max()) + 1,
        "var_participant": fit.var_participant,
        "var_resid": fit.var_resid,
        "singular": fit.singular,
        **effects,
    }


def _effect_rows(fit: MixedFit, design: Design) -> Row:
    errors = np.sqrt(np.diag(fit.covariance))
    return {
        "reml_loglik": fit.loglik,
        "fixef": [
            {"term": term, "est": float(estimate), "se": float(error)}
            for term, estimate, error in zip(design.columns, fit.beta, errors, strict=True)
        ],
        "anova": effect_tests(fit, design),
    }


def effect_tests(fit: MixedFit, design: Design) -> list[Row]:
    """A Type III F test of each effect, by Satterthwaite and by Kenward and Roger (`_kr`)."""
    rows: list[Row] = []
    for effect, columns in design.effects.items():
        f, q, df2, p = _f_test(fit, columns)
        other = fit.kenward_roger.f_test(fit.beta, columns)
        row: Row = {"effect": effect, "F": f, "df1": q, "df2": df2, "p": p}
        if isinstance(other, Absent):
            row |= {"F_kr": other, "df2_kr": other, "p_kr": other}
        else:
            row |= {"F_kr": other.F, "df2_kr": other.df2, "p_kr": other.p}
        rows.append(row)
    return rows
