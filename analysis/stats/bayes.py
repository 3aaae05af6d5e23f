"""A Bayesian mixed model of an outcome: the optional extra `bayes`, by bambi and PyMC.

The model is that of `analysis.stats.mixed`: the sum-coded factors of the design, and a random
intercept a person. Priors are bambi's own weak ones, scaled to the data (Westfall, 2017). Nothing
of this is imported before it is asked for.
"""

from importlib.util import find_spec
from os import cpu_count

import numpy as np

from analysis.sources.absent import Absent, Refusal, Row
from analysis.sources.frames import Floats, StudyData
from analysis.stats.level import ALPHA
from analysis.stats.mixed import answered, sum_coded
from game.errors import AnaError

SEED = 20_240_504
CHAINS, DRAWS = 4, 1000
#: Above this the chains do not agree (Vehtari et al., 2021).
MOST_R_HAT = 1.01


class MissingExtraError(AnaError):
    """The packages of an extra are not installed."""


def need_bayes() -> None:
    """Raise MissingExtraError where bambi is not installed."""
    if find_spec("bambi") is None:
        raise MissingExtraError(
            "Bayesian models need packages that are not installed",
            place="--bayes",
            hint="Install the extra: pip install 'ana[bayes]'",
        )


def bayes_model(study: StudyData, outcome: str, alpha: float = ALPHA) -> Row:
    """Posterior mean, standard deviation and 1 - alpha interval of each fixed effect and of the two
    standard deviations, on every answered round, with the greatest R-hat of them.

    Raises Refusal where there are no groups or no answers, or where a cell has no rows.
    """
    import arviz
    import bambi

    rows = answered(study, outcome)
    design = sum_coded(rows, study.crossed.levels)
    if np.linalg.matrix_rank(design.matrix) < design.matrix.shape[1]:
        raise Refusal("a cell of knowledge x complexity x adaptivity has no rows")
    names = {f"x{at}": term for at, term in enumerate(design.columns) if at}
    table = rows[["participant"]].assign(
        y=rows[outcome].to_numpy(dtype=float),
        **{name: design.matrix[:, int(name[1:])] for name in names},
    )
    model = bambi.Model(f"y ~ {' + '.join(names)} + (1|participant)", table)
    drawn = model.fit(
        draws=DRAWS,
        tune=DRAWS,
        chains=CHAINS,
        cores=min(CHAINS, cpu_count() or 1),
        random_seed=SEED,
        progressbar=False,
    )
    kept = {"Intercept": "(Intercept)", **names}
    spreads = {"1|participant_sigma": "sd_participant", "sigma": "sd_resid"}
    r_hats = arviz.rhat(drawn, var_names=[*kept, *spreads])
    worst = max(float(r_hats[name]) for name in (*kept, *spreads))
    posterior = drawn.posterior

    def told(name: str) -> Row:
        values: Floats = np.asarray(posterior[name], dtype=float).ravel()
        lower, upper = np.quantile(values, (alpha / 2, 1 - alpha / 2))
        return {"mean": float(values.mean()), "sd": float(values.std(ddof=1)),
                "lower": float(lower), "upper": float(upper)}  # fmt: skip

    return {
        "n_rows": len(rows),
        "fixef": [{"term": term, **told(name)} for name, term in kept.items()],
        **{said: told(name) for name, said in spreads.items()},
        "r_hat": worst,
        "converged": worst <= MOST_R_HAT,
        "draws": CHAINS * DRAWS,
    }


def bayes_rows(study: StudyData, alpha: float = ALPHA) -> dict[str, Row | Absent]:
    """The model of each outcome, or the reason why there is none."""
    found: dict[str, Row | Absent] = {}
    for outcome in study.outcomes:
        try:
            found[outcome] = bayes_model(study, outcome, alpha)
        except Refusal as refusal:
            found[outcome] = Absent(str(refusal))
    return found
