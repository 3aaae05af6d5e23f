"""The paper's Figs. 7, 8 and 9 from tidy tables, and the estimates behind its ANOVA."""

from pathlib import Path

import matplotlib as mpl
import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from scipy import stats

from analysis.pages.style import (
    BLUE,
    INK,
    LEVEL_COLOURS,
    LEVEL_MARKERS,
    SHADE,
    VERMILION,
    Captioned,
    bracket,
    captioned,
    quiet_style,
)
from analysis.sources.absent import Absent, Row
from analysis.sources.factors import (
    ADAPTIVITY,
    ALIGNED,
    COMPLEXITY,
    KNOWLEDGE,
    MENTAL_STATES,
    OUTCOMES,
)
from analysis.sources.frames import Floats, StudyData, both_rounds, paired
from analysis.stats.posthoc import (
    RoundModels,
    complexity_within_knowledge_by_round,
    difference_knowledge_within_complexity,
)

SIGNIFICANT = 0.05
OFFSETS = dict(zip(COMPLEXITY, (-0.24, 0.0, 0.24), strict=True))


def fig7_mental_states(study: StudyData) -> Captioned:
    """Mental states in the static round by knowledge group and static level (Fig. 7)."""
    with quiet_style():
        figure = Figure(figsize=(7.2, 6.2))
        panels = np.ravel(figure.subplots(2, 2, sharex=True, sharey=True))
        rounds = _rounds_with_groups(study)
        static = rounds[rounds["adaptivity"] == "static"]
        for axes, state in zip(panels, MENTAL_STATES, strict=True):
            axes.set_title(state)
            axes.set_ylim(0, 125)
            for group, level in ALIGNED:
                _shade(axes, KNOWLEDGE.index(group) + OFFSETS[level], 0.11)
            for level in COMPLEXITY:
                for at, group in enumerate(KNOWLEDGE):
                    values = _values(static, state, group, level)
                    _mean_and_se(
                        axes,
                        at + OFFSETS[level],
                        values,
                        LEVEL_COLOURS[level],
                        LEVEL_MARKERS[level],
                        level if at == 0 else None,
                    )
            _level_brackets(axes, complexity_within_knowledge_by_round(_models(study, state)))
            axes.set_xticks(range(len(KNOWLEDGE)), KNOWLEDGE)
            axes.set_yticks(range(0, 101, 25))
        for axes in panels[::2]:
            axes.set_ylabel("answer, 1 to 100")
        for axes in panels[2:]:
            axes.set_xlabel("knowledge group")
        figure.legend(
            *panels[0].get_legend_handles_labels(),
            title="static level",
            loc="outside upper right",
            ncols=3,
            fontsize=8,
        )
        return captioned(
            "fig7_mental_states",
            figure,
            "Mental states after the static round: look whether each knowledge group answers best "
            "at its own level (shaded); mean and standard error over every answer, brackets are "
            "Holm-adjusted p below .05 within a group.",
            simulated=study.simulated,
        )


def fig8_performance(study: StudyData) -> Captioned:
    """Victims rescued by knowledge group in each round (Fig. 8)."""
    with quiet_style():
        figure = Figure(figsize=(7.2, 3.9))
        panels = np.ravel(figure.subplots(1, 2, sharey=True))
        rounds = _rounds_with_groups(study)
        for axes, name in zip(panels, reversed(ADAPTIVITY), strict=True):
            axes.set_title(name)
            part = rounds[rounds["adaptivity"] == name]
            for at, group in enumerate(KNOWLEDGE):
                values = part.loc[part["knowledge"] == group, "victims"].dropna().to_numpy(float)
                _mean_and_se(axes, at, values, BLUE, "o", None)
            axes.set_xticks(range(len(KNOWLEDGE)), KNOWLEDGE)
            axes.set_xlabel("knowledge group")
            axes.set_ylim(bottom=0)
        panels[0].set_ylabel("victims rescued")
        return captioned(
            "fig8_performance",
            figure,
            "Victims rescued with either instructor: look whether rescues rise with knowledge, and "
            "whether the two panels differ; mean and standard error over every mission.",
            simulated=study.simulated,
        )


def fig9_adaptivity(study: StudyData, outcome: str = "engagement") -> Captioned:
    """adaptive - static of one outcome by static level and knowledge group (Fig. 9)."""
    with quiet_style():
        figure = Figure(figsize=(7.2, 3.9))
        panels = np.ravel(figure.subplots(1, 3, sharey=True))
        pair = paired(study, outcome)
        comparisons = difference_knowledge_within_complexity(_models(study, outcome))
        for at_level, (axes, level) in enumerate(zip(panels, COMPLEXITY, strict=True)):
            axes.set_title(f"static {level}")
            axes.axhline(0, color=INK, linewidth=0.8)
            aligned = next(group for group, own in ALIGNED if own == level)
            _shade(axes, KNOWLEDGE.index(aligned), 0.35)
            for at, _ in enumerate(KNOWLEDGE):
                inside = (pair.knowledge == at) & (pair.complexity == at_level)
                values = pair.difference[inside]
                above = len(values) > 0 and values.mean() >= 0
                _mean_and_se(
                    axes, at, values, BLUE if above else VERMILION, "^" if above else "v", None
                )
            axes.set_xticks(range(len(KNOWLEDGE)), KNOWLEDGE)
            axes.set_xlim(-0.6, len(KNOWLEDGE) - 0.4)
        _group_brackets(panels, comparisons)
        panels[0].set_ylabel(f"{outcome}: adaptive - static")
        panels[1].set_xlabel("knowledge group")
        return captioned(
            f"fig9_{outcome}",
            figure,
            f"Gain in {outcome} with the adaptive instructor: look whether people whose static "
            "level did not fit their knowledge gain (up, blue) and the aligned (shaded) lose "
            "(down, red); mean and standard error, brackets are Holm-adjusted p below .05 within "
            "a level.",
            simulated=study.simulated,
        )


def adaptivity_estimates(study: StudyData) -> Captioned:
    """adaptive - static of every outcome in standard deviations of its static round."""
    with quiet_style():
        figure = Figure(figsize=(7.2, 3.4))
        axes = figure.subplots()
        axes.grid(axis="x")
        axes.grid(visible=False, axis="y")
        axes.axvspan(-0.5, 0.5, color=SHADE, zorder=0)
        axes.axvline(0, color=INK, linewidth=0.8)
        for at, outcome in enumerate(OUTCOMES):
            people = both_rounds(study, outcome)
            gaps = (people["adaptive"] - people["static"]).to_numpy(float)
            unit = float(people["static"].std())
            if len(gaps) < 2 or unit == 0:
                axes.text(0, at, "no estimate: too few people or no spread", va="center")
                continue
            se = gaps.std(ddof=1) / np.sqrt(len(gaps)) / unit
            centre = gaps.mean() / unit
            for level, width in ((0.95, 1.2), (0.90, 3.2)):
                reach = float(stats.t.ppf((1 + level) / 2, len(gaps) - 1)) * se
                axes.plot([centre - reach, centre + reach], [at, at], color=BLUE, linewidth=width)
            axes.plot([centre], [at], "o", color=BLUE, markeredgecolor="white")
        axes.set_yticks(range(len(OUTCOMES)), OUTCOMES)
        axes.set_ylim(len(OUTCOMES) - 0.5, -0.5)
        axes.set_xlabel("adaptive - static, in standard deviations of the static round")
        return captioned(
            "adaptivity_estimates",
            figure,
            "Overall effect of adaptivity: an interval inside the grey band is equivalent to none "
            "at half a standard deviation, one that misses zero is a difference; thick 90%, thin "
            "95%.",
            simulated=study.simulated,
        )


def write_figures(study: StudyData, folder: Path) -> list[Path]:
    """Draw every figure that the study can fill into `folder` (PNG), and their captions.

    Without knowledge groups only the overall estimates are drawn.
    """
    drawn = [adaptivity_estimates(study)]
    if study.has("knowledge"):
        drawn += [fig7_mental_states(study), fig8_performance(study), fig9_adaptivity(study)]
    folder.mkdir(parents=True, exist_ok=True)
    paths = []
    for captioned_figure in drawn:
        path = folder / f"{captioned_figure.name}.png"
        with mpl.rc_context({"savefig.dpi": 200}):
            captioned_figure.figure.savefig(path, metadata={"Software": None})
        paths.append(path)
    captions = "".join(f"{item.name}.png\n{item.caption}\n\n" for item in drawn)
    (folder / "captions.txt").write_text(captions, encoding="utf-8")
    return paths


def _models(study: StudyData, outcome: str) -> RoundModels:
    return RoundModels.of(paired(study, outcome))


def _rounds_with_groups(study: StudyData) -> pd.DataFrame:
    study.need_groups()
    return study.rounds.join(study.participants[["knowledge", "complexity"]], on="participant")


def _values(rounds: pd.DataFrame, column: str, group: str, level: str) -> Floats:
    inside = (rounds["knowledge"] == group) & (rounds["complexity"] == level)
    return rounds.loc[inside, column].dropna().to_numpy(dtype=float)


def _shade(axes: Axes, at: float, reach: float) -> None:
    axes.axvspan(at - reach, at + reach, color=SHADE, zorder=0)


def _mean_and_se(
    axes: Axes, at: float, values: Floats, colour: str, marker: str, label: str | None
) -> None:
    """Every value faintly, spread by its rank, and the mean with its standard error."""
    if len(values) == 0:
        return
    spread = np.linspace(-0.07, 0.07, len(values)) if len(values) > 1 else np.zeros(1)
    axes.plot(
        at + spread,
        np.sort(values),
        linestyle="none",
        marker=".",
        markersize=4,
        color=colour,
        alpha=0.45,
        markeredgewidth=0,
    )
    error = values.std(ddof=1) / np.sqrt(len(values)) if len(values) > 1 else 0.0
    axes.errorbar(
        at,
        values.mean(),
        yerr=error,
        fmt=marker,
        color=colour,
        ecolor=INK,
        elinewidth=1.0,
        capsize=2.5,
        markersize=6,
        markeredgecolor="white",
        markeredgewidth=0.6,
        label=label,
        zorder=3,
    )


def _significant(row: Row) -> str | None:
    p = row["p_holm"]
    if isinstance(p, Absent) or not isinstance(p, float) or p >= SIGNIFICANT:
        return None
    return "p < .001" if p < 0.001 else f"p = {p:.3f}".replace("0.", ".")


def _level_brackets(axes: Axes, comparisons: list[Row]) -> None:
    heights = dict.fromkeys(KNOWLEDGE, 101.0)
    for row in comparisons:
        text = _significant(row)
        group = str(row["knowledge"])
        if row["adaptivity"] == "static" and text:
            one, other = str(row["contrast"]).split(" - ")
            at = KNOWLEDGE.index(group)
            bracket(axes, at + OFFSETS[one], at + OFFSETS[other], heights[group], text)
            heights[group] += 9.0


def _group_brackets(
    panels: "np.ndarray[tuple[int], np.dtype[np.object_]]", rows: list[Row]
) -> None:
    low, high = panels[0].get_ylim()
    step = 0.07 * (high - low)
    heights = dict.fromkeys(COMPLEXITY, high)
    for row in rows:
        text = _significant(row)
        level = str(row["complexity"])
        if text:
            one, other = (KNOWLEDGE.index(name) for name in str(row["contrast"]).split(" - "))
            bracket(panels[COMPLEXITY.index(level)], one, other, heights[level], text)
            heights[level] += step
    panels[0].set_ylim(low, max([high, *heights.values()]) + step / 2)
