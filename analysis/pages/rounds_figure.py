"""Every round of a study in which an instructor has more than one."""

import numpy as np
from matplotlib.figure import Figure

from analysis.pages.style import (
    BLUE,
    TWO_COLUMNS,
    VERMILION,
    Captioned,
    captioned,
    quiet_style,
)
from analysis.sources.absent import Refusal, Row
from analysis.sources.factors import ADAPTIVITY
from analysis.sources.frames import StudyData
from analysis.stats.rounds import round_means


def every_round(study: StudyData) -> Captioned:
    """The mean of every outcome in every round with either instructor, where an instructor has more
    than one. Raises Refusal where none has."""
    rows = study.every_round
    if rows is None:
        raise Refusal("no instructor has more than one round")
    words = dict(zip(ADAPTIVITY, study.crossed.words, strict=True))
    with quiet_style():
        down = -(-len(study.outcomes) // 3)
        figure = Figure(figsize=(TWO_COLUMNS, 0.6 + 2.0 * down))
        panels = np.ravel(figure.subplots(down, 3, squeeze=False))
        for axes in panels[len(study.outcomes) :]:
            axes.set_visible(False)
        for axes, outcome in zip(panels, study.outcomes, strict=False):
            axes.set_title(outcome)
            means = round_means(rows.dropna(subset=[outcome]), outcome)
            for name, colour, marker, shift in zip(
                ADAPTIVITY, (VERMILION, BLUE), "so", (-0.06, 0.06), strict=True
            ):
                own = [row for row in means if row["adaptivity"] == name]
                axes.errorbar(
                    [at + shift for at in _numbers(own, "round")],
                    _numbers(own, "mean"),
                    yerr=[
                        sd / n**0.5
                        for sd, n in zip(_numbers(own, "sd"), _numbers(own, "n"), strict=True)
                    ],
                    fmt=f"{marker}-", color=colour, capsize=2.5, markersize=5, label=words[name],
                )  # fmt: skip
            axes.set_xticks(sorted(rows["round"].unique()))
            axes.set_xlabel("round")
        figure.legend(*panels[0].get_legend_handles_labels(), loc="outside upper right", ncols=2)
        return captioned(
            "rounds",
            figure,
            "Every round with either instructor: see whether both lines rise or fall, as by "
            "practice, and whether one stays above the other. Points are means over people, error "
            "bars one standard error.",
            simulated=study.simulated,
        )


def _numbers(rows: list[Row], column: str) -> list[float]:
    """A column of numbers; what is absent is NaN."""
    values = (row[column] for row in rows)
    return [float(value) if isinstance(value, int | float) else np.nan for value in values]
