"""Preference: the four statements, and which instructor was liked better (paper 5.3, 5.4)."""

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from analysis.pages.style import (
    BLUE,
    INK,
    ONE_COLUMN,
    ORANGE,
    SHADE,
    TWO_COLUMNS,
    Captioned,
    captioned,
    quiet_style,
)
from analysis.sources.absent import Absent, Refusal, Row
from analysis.sources.factors import ADAPTIVITY, LIKERT_ITEMS
from analysis.sources.frames import StudyData
from analysis.stats.level import ALPHA, percent

POINTS = (1, 2, 3, 4, 5)
STATEMENTS = dict(
    zip(LIKERT_ITEMS, ("easy to understand", "helpful", "right difficulty", "enjoyed"), strict=True)
)


def statements_figure(study: StudyData) -> Captioned:
    """How each statement was answered after either instructor. Raises Refusal where nobody was
    asked."""
    if not any(study.has(item) for item in LIKERT_ITEMS):
        raise Refusal("nobody answered the statements")
    first, second = study.crossed.words
    words = dict(zip(ADAPTIVITY, study.crossed.words, strict=True))
    with quiet_style():
        figure = Figure(figsize=(TWO_COLUMNS, 3.4))
        panels = np.ravel(figure.subplots(1, len(LIKERT_ITEMS), sharey=True))
        for axes, item in zip(panels, LIKERT_ITEMS, strict=True):
            axes.set_title(STATEMENTS[item])
            axes.set_xlabel("answer, 1 to 5")
            for name, colour, shift in zip(ADAPTIVITY, (ORANGE, BLUE), (-0.2, 0.2), strict=True):
                answers = study.rounds.loc[study.rounds["adaptivity"] == name, item].dropna()
                shares = [float((answers == point).mean()) if len(answers) else 0.0
                          for point in POINTS]  # fmt: skip
                axes.bar(np.array(POINTS) + shift, shares, 0.38, color=colour, label=words[name])
            axes.set_xticks(POINTS)
        panels[0].set_ylabel("share of answers")
        figure.legend(*panels[0].get_legend_handles_labels(), loc="outside upper right", ncols=2)
        return captioned(
            "preference_statements",
            figure,
            f"The four statements after the {first} (orange) and the {second} (blue) instructor: "
            "see whether one colour stands farther to the right.",
            simulated=study.simulated,
        )


def preferred_figure(
    rows: Row | Absent, second: str = "adaptive", *, simulated: bool, alpha: float = ALPHA
) -> Captioned:
    """The share who preferred the second instructor; `rows` are those of `preferred_rows`."""
    table = preferred_table(rows)
    with quiet_style():
        figure = Figure(figsize=(ONE_COLUMN, 1.0 + 0.24 * max(1, len(table))))
        axes = figure.subplots()
        axes.grid(axis="x")
        axes.grid(visible=False, axis="y")
        axes.axvline(0.5, color=INK, linewidth=0.8, linestyle=":")
        axes.axhspan(-0.5, 0.5, color=SHADE, zorder=0)
        for at, row in enumerate(table.to_dict("records")):
            axes.plot([row["lower.CL"], row["upper.CL"]], [at, at], color=BLUE, linewidth=1.6)
            axes.plot([row["share"]], [at], "o", color=BLUE, markeredgecolor="white")
        axes.set_yticks(
            range(len(table)), [f"{row['of']} (n = {row['n']})" for row in table.to_dict("records")]
        )
        axes.set_ylim(len(table) - 0.5, -0.5)
        axes.set_xlim(0, 1)
        axes.set_xlabel(
            f"share who preferred the {second}\ninstructor (exact {percent(1 - alpha)} CI)"
        )
        return captioned(
            "preferred",
            figure,
            f"Which instructor was preferred, with exact {percent(1 - alpha)} intervals: an "
            "interval "
            "that misses the "
            "dotted half is a preference.",
            simulated=simulated,
        )


def preferred_table(rows: Row | Absent) -> pd.DataFrame:
    """The tests of `preferred_rows` as one table, everybody first."""
    if isinstance(rows, Absent):
        return pd.DataFrame(columns=["of", "n", "adaptive", "share", "lower.CL", "upper.CL", "p"])
    found: list[dict[str, object]] = []
    for name, part in rows.items():
        if name == "all" and isinstance(part, dict):
            found.insert(0, {"of": "everybody", **part})
        elif isinstance(part, list):
            found += [{"of": row[name], **{k: v for k, v in row.items() if k != name}}
                      for row in part if isinstance(row, dict)]  # fmt: skip
    return pd.DataFrame(found)
