"""The knowledge x complexity x adaptivity mixed ANOVA of the paper (section 5.4), in closed form.

With d = (adaptive - static)/sqrt 2 and b = (adaptive + static)/sqrt 2 a participant, effects that
contain adaptivity are tests of the saturated model of d (adaptivity itself is its intercept) and
the others are tests of b. One within factor of two levels makes the multivariate and the
univariate test the same: Wilks' lambda = SSE/(SSE + SS).
"""

from dataclasses import dataclass

import numpy as np

from analysis.sources.absent import Absent, Refusal, Row, attempt
from analysis.sources.factors import COMPLEXITY, KNOWLEDGE
from analysis.sources.frames import Floats, Paired
from analysis.stats.cellmodel import CellModel, FTest, fit_cells
from analysis.stats.effect_sizes import eta_interval
from analysis.stats.level import ALPHA


def _mean(levels: tuple[str, ...], used: tuple[str, ...]) -> Floats:
    return np.array([[(level in used) / len(used) for level in levels]])


def _gaps(levels: tuple[str, ...], used: tuple[str, ...]) -> Floats:
    """The first level less each other one (shape: q x levels)."""
    eye = np.eye(len(levels))
    first, *others = (eye[levels.index(level)] for level in used)
    return np.array([first - other for other in others]).reshape(-1, len(levels))


def _product(knowledge: Floats, complexity: Floats) -> Floats:
    return np.asarray(np.kron(knowledge, complexity), dtype=float)


def hypotheses(levels: tuple[str, ...] = COMPLEXITY) -> dict[str, Floats]:
    """Between effects and their hypotheses on the nine cell means (q x 9), for these static
    levels; with one level there are no effects of complexity."""
    mean, means = _mean(KNOWLEDGE, KNOWLEDGE), _mean(COMPLEXITY, levels)
    gap, gaps = _gaps(KNOWLEDGE, KNOWLEDGE), _gaps(COMPLEXITY, levels)
    every = {
        "(Intercept)": _product(mean, means),
        "knowledge": _product(gap, means),
        "complexity": _product(mean, gaps),
        "knowledge:complexity": _product(gap, gaps),
    }
    return {name: rows for name, rows in every.items() if len(rows)}


#: Between effects and their hypotheses in the paper's design.
HYPOTHESES = hypotheses()
BETWEEN = tuple(HYPOTHESES)
WITHIN = ("adaptivity", *(f"{name}:adaptivity" for name in BETWEEN[1:]))
EFFECTS = (*BETWEEN, *WITHIN)
THREE_WAY = WITHIN[-1]


def within(levels: tuple[str, ...] = COMPLEXITY) -> dict[str, Floats]:
    """Within-person effects and their hypotheses on the cell means of the differences."""
    names = dict(zip(BETWEEN, WITHIN, strict=True))
    return {names[name]: rows for name, rows in hypotheses(levels).items()}


@dataclass(frozen=True)
class Effect:
    """One line of the mixed ANOVA.

    `ges` is generalised eta squared with every factor manipulated; `ges_obs_knowledge` takes
    knowledge as measured (Olejnik & Algina, 2003) and is the one to report. `wilks` is None for
    a between effect.
    """

    effect: str
    test: FTest
    ges: float
    ges_obs_knowledge: float

    @property
    def wilks(self) -> float | None:
        """Wilks' lambda of an effect that contains adaptivity, else None."""
        return 1 - self.test.pes if self.effect in WITHIN else None

    def pes_interval(self, alpha: float = ALPHA) -> tuple[float, float] | Absent:
        """The 1 - 2 alpha interval of partial eta squared, by the noncentral F."""
        return attempt(eta_interval, self.test.F, self.test.df1, self.test.df2, 1 - 2 * alpha)

    def row(self, alpha: float = ALPHA) -> Row:
        """The line as written to the results."""
        test = self.test
        ends = self.pes_interval(alpha)
        lower, upper = (ends, ends) if isinstance(ends, Absent) else ends
        return {
            "effect": self.effect,
            "df1": test.df1,
            "df2": test.df2,
            "ss": test.ss,
            "ss_error": test.ss_error,
            "mse": test.mse,
            "F": test.F,
            "p": test.p,
            "pes": test.pes,
            "pes.lower": lower,
            "pes.upper": upper,
            "ges": self.ges,
            "ges_obs_knowledge": self.ges_obs_knowledge,
            "wilks": Absent("Wilks' lambda belongs to within-person effects alone")
            if self.wilks is None
            else self.wilks,
        }


def difference_model(pair: Paired) -> CellModel:
    """The saturated model of d = (adaptive - static)/sqrt 2."""
    return fit_cells(pair.difference / np.sqrt(2), pair.cell, pair.levels)


def sum_model(pair: Paired) -> CellModel:
    """The saturated model of b = (adaptive + static)/sqrt 2."""
    return fit_cells(pair.mean * np.sqrt(2), pair.cell, pair.levels)


def mixed_anova(pair: Paired) -> list[Effect]:
    """All effects that the design has, in the order of `EFFECTS`.

    Raises Refusal, naming the cells, where an analysis cell is empty, and where there is no error
    variance to test against.
    """
    b, d = sum_model(pair), difference_model(pair)
    b.require_every_cell()
    for model, what in ((b, "the mean of the two rounds"), (d, "adaptive - static")):
        reason = model.why_no_error()
        if reason is not None:
            raise Refusal(f"{what}: {reason}")
    tests = {
        **{name: b.test(rows) for name, rows in hypotheses(pair.levels).items()},
        **{name: d.test(rows) for name, rows in within(pair.levels).items()},
    }
    error = b.sse + d.sse
    measured = sum(test.ss for name, test in tests.items() if "knowledge" in name)
    return [
        Effect(
            effect=name,
            test=test,
            ges=test.ss / (test.ss + error),
            ges_obs_knowledge=test.ss
            / (measured + error + (0.0 if "knowledge" in name else test.ss)),
        )
        for name, test in tests.items()
    ]
