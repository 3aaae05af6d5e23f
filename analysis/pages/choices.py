"""Do the results hang on choices? The specification curve, and a reviewer's checks as tables."""

from collections.abc import Sequence

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from analysis.pages.style import BLUE, INK, SHADE, TWO_COLUMNS, Captioned, captioned, quiet_style
from analysis.sources.absent import Absent, Row, attempt
from analysis.sources.frames import StudyData, paired
from analysis.stats.apa import bounded
from analysis.stats.assumptions import assumption_rows, hc3_rows
from analysis.stats.latent import latent_row
from analysis.stats.level import ALPHA
from analysis.stats.mixed import mixed_model
from analysis.stats.order_effects import order_rows
from analysis.stats.robust import permutation_rows, prior_rows, trimmed_row
from analysis.stats.sensitivity import continuous_rows
from analysis.stats.specifications import OUTCOME

#: What a specification is made of, in the order of the figure's rows.
CHOICES = ("sample", "groups", "model", "correction")
#: The least p that is drawn.
FLOOR = 1e-6


def specification_figure(
    rows: Sequence[Row], *, simulated: bool, alpha: float = ALPHA, outcome: str = OUTCOME
) -> Captioned:
    """p of the three-way effect under every specification; `rows` are those of
    `specification_rows`. Those without a p are counted in the caption."""
    table = pd.DataFrame([row for row in rows if not isinstance(row["p"], Absent)])
    missing = len(rows) - len(table)
    if len(table):
        table = table.sort_values("p", kind="stable", ignore_index=True)
    options = [
        (choice, str(option)) for choice in CHOICES for option in dict.fromkeys(
            row[choice] for row in rows)
    ]  # fmt: skip
    with quiet_style():
        figure = Figure(figsize=(TWO_COLUMNS, 2.2 + 0.19 * len(options)))
        top, below = figure.subplots(2, 1, sharex=True, height_ratios=(2, 0.19 * len(options)))
        at = np.arange(len(table))
        p = np.maximum(table["p"].to_numpy(dtype=float), FLOOR) if len(table) else np.array([])
        top.axhline(alpha, color=INK, linewidth=0.8, linestyle=":")
        top.plot(at, p, ".", color=BLUE, markersize=4)
        top.set_yscale("log")
        top.set_ylim(FLOOR / 2, 2)
        top.set_ylabel("p")
        top.set_title(f"{len(table)} specifications")
        below.grid(visible=False)
        for row, (choice, option) in enumerate(options):
            if row % 2 == 0:
                below.axhspan(row - 0.5, row + 0.5, color=SHADE, zorder=0)
            if len(table):
                chosen = at[(table[choice].astype(str) == option).to_numpy()]
                below.plot(chosen, np.full(len(chosen), row), "|", color=INK, markersize=5)
        below.set_yticks(range(len(options)), [f"{choice}: {option}" for choice, option in options])
        below.set_ylim(len(options) - 0.5, -0.5)
        below.set_xlim(-1, max(1, len(table)))
        below.set_xticks([])
        below.set_xlabel("specification, from the smallest p")
        more = "specification" if missing == 1 else "specifications"
        lost = f" {missing} further {more} could not be computed." if missing else ""
        return captioned(
            "specifications",
            figure,
            f"The effect of knowledge, static level and adaptivity on {outcome} under every "
            "combination of sample, grouping of knowledge, model and correction over the "
            f"mental states: see whether p stays on one side of {bounded(alpha, 2)} (dotted), and "
            f"which choice moves it. A p below .000001 is drawn at .000001.{lost}",
            simulated=simulated,
        )


def survival(rows: Sequence[Row], alpha: float = ALPHA) -> list[Row]:
    """For each option of each choice: specifications that could be had, and the share below
    alpha."""
    table = pd.DataFrame([row for row in rows if not isinstance(row["p"], Absent)])
    found: list[Row] = []
    for choice in CHOICES if len(table) else ():
        for option, part in table.groupby(choice, sort=False):
            p = part["p"].to_numpy(dtype=float)
            found.append(
                {
                    "choice": choice,
                    "option": str(option),
                    "specifications": len(part),
                    "below alpha": float((p < alpha).mean()),
                    "greatest p": float(p.max()),
                }
            )
    return found


def assumption_table(study: StudyData) -> pd.DataFrame:
    """Levene's (median) and Shapiro and Wilk's tests, a row an outcome. Raises Refusal without
    groups."""
    rows = []
    for outcome in study.outcomes:
        found = assumption_rows(paired(study, outcome))
        rows.append(
            {
                "outcome": outcome,
                **{f"equal spread, {name}: p": _p(found, "levene_median", name)
                   for name in ("static", "adaptive", "diff")},
                **{f"normal residuals, {name}: p": _p(found, "shapiro_resid", name)
                   for name in ("mean", "diff")},
            }
        )  # fmt: skip
    return pd.DataFrame(rows).set_index("outcome")


def _p(found: Row, test: str, name: str) -> object:
    part = found[test]
    row = part[name] if isinstance(part, dict) else part
    return row["p"] if isinstance(row, dict) else row


def other_tests(study: StudyData) -> pd.DataFrame:
    """Each within-person effect by HC3 and by permutation, a row an outcome and effect. Raises
    Refusal without groups."""
    rows = []
    for outcome in study.outcomes:
        pair = paired(study, outcome)
        robust, permuted = attempt(hc3_rows, pair), attempt(permutation_rows, pair)
        if isinstance(robust, Absent) or isinstance(permuted, Absent):
            continue
        for one, other in zip(robust, permuted, strict=True):
            rows.append(
                {"outcome": outcome, "effect": one["effect"], "F": other["F"], "F (HC3)": one["F"],
                 "p (HC3)": one["p"], "p (permutation)": other["p_permutation"]}
            )  # fmt: skip
    columns = ["outcome", "effect", "F", "F (HC3)", "p (HC3)", "p (permutation)"]
    return pd.DataFrame(rows, columns=columns).set_index("outcome")


def trimmed_table(study: StudyData, alpha: float = ALPHA) -> list[Row]:
    """adaptive - static by 20% trimmed means, a row an outcome that allows it."""
    found = {outcome: attempt(trimmed_row, study, outcome, alpha) for outcome in study.outcomes}
    return [{"outcome": name, **row} for name, row in found.items() if not isinstance(row, Absent)]


def mixed_table(study: StudyData) -> list[Row]:
    """Every effect of every outcome by the mixed model on all answered rounds, with both kinds of
    degrees of freedom; outcomes whose model cannot be fitted are left out."""
    rows: list[Row] = []
    for outcome in study.outcomes:
        model = attempt(mixed_model, study, outcome)
        if isinstance(model, Absent) or not isinstance(model["anova"], list):
            continue
        rows += [{"outcome": outcome, **row} for row in model["anova"]]
    return rows


def latent_table(study: StudyData) -> list[Row]:
    """The three-way effect on the items as ordered answers, and on rescues out of twenty."""
    measures = [*(item for items in study.asked.composites.values() for item in items), "victims"]
    found = {name: attempt(latent_row, study, name) for name in measures}
    return [{"of": name, **row} for name, row in found.items() if not isinstance(row, Absent)]


def prior_table(study: StudyData) -> pd.DataFrame:
    """BF10 of adaptive - static: a row an outcome, a column a scale of the prior."""
    rows = {}
    for outcome in study.outcomes:
        found = attempt(prior_rows, study, outcome)
        if not isinstance(found, Absent):
            rows[outcome] = {f"r = {float(str(row['prior_scale'])):.3f}": row["bf10"]
                             for row in found}  # fmt: skip
    return pd.DataFrame.from_dict(rows, orient="index")


def order_table(study: StudyData) -> pd.DataFrame:
    """Round, order and building effects of every outcome that has them."""
    parts = [
        {"outcome": outcome, **row}
        for outcome, rows in order_rows(study).items()
        if not isinstance(rows, Absent)
        for row in rows
    ]
    return pd.DataFrame(parts).set_index("outcome") if parts else pd.DataFrame()


def score_table(study: StudyData) -> pd.DataFrame:
    """The tests with the quiz score itself in place of the groups, effects of adaptivity alone."""
    parts = []
    for outcome in study.outcomes:
        rows = attempt(continuous_rows, study, outcome)
        if not isinstance(rows, Absent):
            parts += [{"outcome": outcome, **row} for row in rows if "adapt" in str(row["effect"])]
    return pd.DataFrame(parts).set_index("outcome") if parts else pd.DataFrame()
