"""The paper's Figs. 7, 8 and 9 from tidy tables, and the estimates behind its ANOVA."""

from collections.abc import Iterator
from pathlib import Path
from textwrap import fill

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from numpy.typing import NDArray

from analysis.pages.rounds_figure import every_round
from analysis.pages.style import (
    BLUE,
    INK,
    LEVEL_COLOURS,
    LEVEL_MARKERS,
    ONE_COLUMN,
    SHADE,
    TWO_COLUMNS,
    VERMILION,
    Captioned,
    bracket,
    captioned,
    quiet_style,
    save_figures,
)
from analysis.sources.absent import Absent, Refusal, Row, attempt
from analysis.sources.factors import (
    ADAPTIVITY,
    ALIGNED,
    COMPLEXITY,
    KNOWLEDGE,
)
from analysis.sources.frames import Floats, Paired, StudyData, paired
from analysis.stats.adaptivity import overall
from analysis.stats.apa import bounded, p_words
from analysis.stats.cellmodel import CELLS, cell_words, weights_of
from analysis.stats.equivalence import BOUND_SDS
from analysis.stats.level import ALPHA, percent
from analysis.stats.posthoc import (
    RoundModels,
    complexity_within_knowledge_by_round,
    difference_knowledge_within_complexity,
)

OFFSETS = dict(zip(COMPLEXITY, (-0.24, 0.0, 0.24), strict=True))


def fig7_mental_states(study: StudyData, alpha: float = ALPHA) -> Captioned:
    """Mental states in the static round by knowledge group and static level (Fig. 7).

    Points, means and comparisons are of the same people, those of the ANOVA. Raises Refusal where
    the study asks for none, has no groups, or has one static level.
    """
    study.need_groups()
    if not study.asked.mental_states:
        raise Refusal("the study asks for no mental states")
    if len(study.crossed.levels) < 2:
        raise Refusal("the study has one static level, so there is none to compare it with")
    with quiet_style():
        states, levels = study.asked.mental_states, study.crossed.levels
        down = -(-len(states) // 2)
        figure = Figure(figsize=(TWO_COLUMNS, 0.6 + 2.8 * down))
        panels = figure.subplots(down, 2, sharey=True, squeeze=False).ravel()
        for axes in panels[len(states) :]:
            axes.set_visible(False)
        for axes, state in zip(panels, states, strict=False):
            least, most = study.asked.ranges.get(state, (1, 100))
            unit = (most - least) / 99
            pair = paired(study, state)
            axes.set_title(state)
            axes.set_ylim(least - 4 * unit, most + 40 * unit)
            for group, level in ALIGNED:
                if level in levels:
                    _shade(axes, KNOWLEDGE.index(group) + OFFSETS[level], 0.11)
            for level in levels:
                for at, group in enumerate(KNOWLEDGE):
                    _mean_and_se(
                        axes,
                        at + OFFSETS[level],
                        pair.static[_inside(pair, group, level)],
                        LEVEL_COLOURS[level],
                        LEVEL_MARKERS[level],
                        0.1,
                    )
            _level_brackets(axes, alpha, complexity_within_knowledge_by_round(RoundModels.of(pair)))
            axes.set_xticks(range(len(KNOWLEDGE)), [_with_n(pair, group) for group in KNOWLEDGE])
            axes.set_xlim(-0.5, len(KNOWLEDGE) - 0.5)
            axes.set_yticks(range(0, 101, 25) if most == 100 else range(least, most + 1))
        for axes in panels[::2]:
            axes.set_ylabel("answer (mean \u00b1 SE)")
        for axes in panels[-2:]:
            axes.set_xlabel(f"knowledge group; n at {', '.join(levels)}")
        figure.legend(
            handles=[
                Line2D([], [], color=LEVEL_COLOURS[level], marker=LEVEL_MARKERS[level],
                       linestyle="none", label=level)
                for level in levels
            ],
            title="static level",
            loc="outside upper right",
            ncols=3,
            fontsize=8,
        )  # fmt: skip
        return captioned(
            "fig7_mental_states",
            figure,
            f"Mental states after the {study.crossed.words[0]} round: see whether each knowledge "
            "group answers best at its own level (shaded). Points are people with both rounds, the "
            f"people of the ANOVA; n is given for {_listed(levels)}. Large symbols are means, "
            "error bars one standard error (none for one person); brackets are comparisons within "
            f"a group with Holm-adjusted p below {bounded(alpha, 2)}.",
            simulated=study.simulated,
        )


def fig8_performance(study: StudyData) -> Captioned:
    """Victims rescued by knowledge group in each round (Fig. 8). Raises Refusal where people had
    no missions."""
    if not study.missions:
        raise Refusal("people had no missions")
    with quiet_style():
        figure = Figure(figsize=(TWO_COLUMNS, 3.4))
        panels = np.ravel(figure.subplots(1, 2, sharey=True))
        pair = paired(study, "victims")
        first, second = study.crossed.words
        rounds = {second: pair.adaptive, first: pair.static}
        for axes, (name, values) in zip(panels, rounds.items(), strict=True):
            axes.set_title(name)
            ticks = []
            for at, group in enumerate(KNOWLEDGE):
                inside = pair.knowledge == at
                _mean_and_se(axes, at, values[inside], BLUE, "o")
                ticks.append(f"{group}\nn = {np.count_nonzero(inside)}")
            axes.set_xticks(range(len(KNOWLEDGE)), ticks)
            axes.set_xlim(-0.5, len(KNOWLEDGE) - 0.5)
            axes.set_xlabel("knowledge group")
        panels[0].set_ylabel("victims rescued (mean \u00b1 SE)")
        panels[0].set_ylim(-0.5, max([1.0, *pair.static, *pair.adaptive]) * 1.05)
        return captioned(
            "fig8_performance",
            figure,
            "Victims rescued with either instructor: see whether rescues rise with knowledge, and "
            "whether the two panels differ. Points are people with both rounds, the people of the "
            "ANOVA; large symbols are means, error bars one standard error.",
            simulated=study.simulated,
        )


def fig9_adaptivity(
    study: StudyData, outcome: str = "engagement", alpha: float = ALPHA
) -> Captioned:
    """adaptive - static of one outcome by static level and knowledge group (Fig. 9)."""
    with quiet_style():
        levels, gap = study.crossed.levels, study.crossed.gap
        figure = Figure(figsize=(TWO_COLUMNS, 3.6))
        panels = np.ravel(figure.subplots(1, len(levels), sharey=True, squeeze=False))
        pair = paired(study, outcome)
        comparisons = difference_knowledge_within_complexity(RoundModels.of(pair))
        for axes, level in zip(panels, levels, strict=True):
            axes.set_title(f"static {level}" if len(levels) > 1 else "")
            axes.axhline(0, color=INK, linewidth=0.8)
            aligned = next(group for group, own in ALIGNED if own == level)
            if len(levels) > 1:
                _shade(axes, KNOWLEDGE.index(aligned), 0.35)
            ticks = []
            for at, group in enumerate(KNOWLEDGE):
                values = pair.difference[_inside(pair, group, level)]
                above = len(values) > 0 and values.mean() >= 0
                _mean_and_se(axes, at, values, BLUE if above else VERMILION, "^" if above else "v")
                ticks.append(f"{group}\nn = {len(values)}")
            axes.set_xticks(range(len(KNOWLEDGE)), ticks)
            axes.set_xlim(-0.6, len(KNOWLEDGE) - 0.4)
        reach = max([1.0, *np.abs(pair.difference)])
        panels[0].set_ylim(-1.05 * reach, 1.05 * reach)
        _group_brackets(panels, levels, alpha, comparisons)
        panels[0].set_ylabel(f"{outcome}: {gap} (mean \u00b1 SE)")
        panels[len(levels) // 2].set_xlabel("knowledge group")
        see = (
            "people whose static level did not fit their knowledge gain (up, blue) and the aligned "
            "(shaded) lose (down, red)"
            if len(levels) > 1
            else "the groups gain (up, blue) or lose (down, red)"
        )
        return captioned(
            f"fig9_{outcome}",
            figure,
            f"Gain in {outcome} with the {study.crossed.words[1]} instructor: see whether {see}. "
            "Points are people, large symbols means, error bars one "
            "standard error; brackets are comparisons within a level with Holm-adjusted p below "
            f"{bounded(alpha, 2)}.",
            simulated=study.simulated,
        )


def adaptivity_estimates(study: StudyData, alpha: float = ALPHA) -> Captioned:
    """adaptive - static of every outcome in standard deviations of its static round.

    The analysis cells count equally, as in the ANOVA's test; without knowledge groups or with an
    empty cell people count equally, and the label says so. Raises Refusal where no outcome has an
    estimate.
    """
    estimates = {outcome: attempt(overall, study, outcome) for outcome in study.outcomes}
    lacking = [one.reason for one in estimates.values() if isinstance(one, Absent)]
    if len(lacking) == len(estimates):
        raise Refusal("; ".join(dict.fromkeys(lacking)))
    outer, inner = 1 - alpha, 1 - 2 * alpha
    thin, thick = percent(outer), percent(inner)
    with quiet_style():
        figure = Figure(figsize=(ONE_COLUMN, 3.6))
        axes = figure.subplots()
        axes.grid(axis="x")
        axes.grid(visible=False, axis="y")
        axes.axvspan(-BOUND_SDS, BOUND_SDS, color=SHADE, zorder=0)
        axes.axvline(0, color=INK, linewidth=0.8)
        labels = []
        reach = BOUND_SDS
        for at, (outcome, estimate) in enumerate(estimates.items()):
            if isinstance(estimate, Absent):
                labels.append(outcome)
                reason = fill(f"no estimate: {estimate.reason}", 30)
                axes.text(0, at, reason, va="center", ha="center", fontsize=7)
                continue
            weights = "" if estimate.equal_cells else "\npeople equal"
            labels.append(f"{outcome}\nn = {estimate.n}{weights}")
            for level, width in ((outer, 1.2), (inner, 3.2)):
                ends = estimate.interval(level)
                axes.plot(ends, [at, at], color=BLUE, linewidth=width, solid_capstyle="butt")
                reach = max(reach, *np.abs(ends))
            axes.plot([estimate.estimate], [at], "o", color=BLUE, markeredgecolor="white")
        axes.set_yticks(range(len(study.outcomes)), labels)
        axes.set_ylim(len(study.outcomes) - 0.5, -0.5)
        axes.set_xlim(-1.08 * reach, 1.08 * reach)
        first = study.crossed.words[0]
        axes.set_xlabel(f"{study.crossed.gap}, in SD of {first}\n(CI {thick} thick, {thin} thin)")
        return captioned(
            "adaptivity_estimates",
            figure,
            f"Overall effect of adaptivity with {thick} (thick) and {thin} (thin) confidence "
            "intervals: a thick interval inside the grey band is equivalent to none at half a "
            "standard deviation, a thin one that misses zero is a difference. The "
            f"{cell_words(study.crossed.levels)} of knowledge and level count equally, as in the "
            "ANOVA's test of adaptivity.",
            simulated=study.simulated,
        )


def cells_figure(study: StudyData, outcome: str, alpha: float = ALPHA) -> Captioned:
    """Everybody's answer in the analysis cells, in each round, with estimated means."""
    with quiet_style():
        figure = Figure(figsize=(TWO_COLUMNS, 4.4))
        panels = figure.subplots(2, len(KNOWLEDGE), sharey=True)
        levels = study.crossed.levels
        several = len(levels) > 1
        by = "knowledge group, static level" if several else "knowledge group"
        words = dict(zip(ADAPTIVITY, study.crossed.words, strict=True))
        shown: list[float] = []
        pair = paired(study, outcome)
        rounds = dict(zip(ADAPTIVITY, (pair.static, pair.adaptive), strict=True))
        for row, (name, model) in zip(panels, RoundModels.of(pair).by_round(), strict=True):
            for axes, group in zip(row, KNOWLEDGE, strict=True):
                axes.set_title(f"{group}, {words[name]}")
                ticks = []
                for at, level in enumerate(levels):
                    values = rounds[name][_inside(pair, group, level)]
                    half = model.contrast(weights_of([(group, level)])).half_width(1 - alpha)
                    bar = None if isinstance(half, Absent) else half
                    _mean_and_bar(
                        axes, at, values, LEVEL_COLOURS[level], LEVEL_MARKERS[level], bar, 0.3
                    )
                    shown += values.tolist()
                    if len(values) > 1 and bar is not None:
                        shown += [float(values.mean()) - bar, float(values.mean()) + bar]
                    ticks.append(f"{level}\nn = {len(values)}" if several else f"n = {len(values)}")
                axes.set_xticks(range(len(levels)), ticks)
                axes.set_xlim(-0.5, len(levels) - 0.5)
        low, high = min(shown, default=0.0), max(shown, default=1.0)
        margin = max(0.06 * (high - low), 0.5)
        panels[0, 0].set_ylim(low - margin, high + margin)
        for axes in panels[:, 0]:
            axes.set_ylabel(f"{outcome} (mean, {percent(1 - alpha)} CI)")
        for axes in panels[1]:
            axes.set_xlabel("static level" if several else "")
        return captioned(
            f"cells_{outcome}",
            figure,
            f"Every answer for {outcome} by {by} and round: see how far the people of a cell "
            "spread about its mean. Points are people with both rounds, large "
            f"symbols cell means, error bars {percent(1 - alpha)} confidence intervals from the "
            "round's pooled error.",
            simulated=study.simulated,
        )


def figures_of(study: StudyData, alpha: float = ALPHA) -> Iterator[Captioned]:
    """Every figure that the study can fill, in the paper's order, each drawn when it is asked for.

    Without knowledge groups these are the overall estimates alone.
    """
    if study.has("knowledge"):
        states = study.asked.mental_states
        if states and len(study.crossed.levels) > 1:
            yield fig7_mental_states(study, alpha)
        if study.missions:
            yield fig8_performance(study)
        if states:
            yield fig9_adaptivity(study, first_state(study), alpha)
    estimates = attempt(adaptivity_estimates, study, alpha)
    if not isinstance(estimates, Absent):
        yield estimates
    if study.has("knowledge"):
        for outcome in study.outcomes:
            yield cells_figure(study, outcome, alpha)
    if study.every_round is not None:
        yield every_round(study)


def first_state(study: StudyData) -> str:
    """Engagement, or the first mental state of a study that does not ask for it."""
    states = study.asked.mental_states
    return "engagement" if "engagement" in states or not states else states[0]


def write_figures(
    study: StudyData, folder: Path, alpha: float = ALPHA, origin: str = ""
) -> list[Path]:
    """Draw every figure that the study can fill into `folder`, and their captions.

    Raises OSError where the folder cannot be written.
    """
    folder.mkdir(parents=True, exist_ok=True)
    return save_figures(list(figures_of(study, alpha)), folder, origin)


def _inside(pair: Paired, group: str, level: str) -> NDArray[np.bool_]:
    return np.equal(pair.cell, CELLS.index((group, level)))


def _listed(words: tuple[str, ...]) -> str:
    """ "C1, C2 and C3"."""
    *first, last = words
    return f"{', '.join(first)} and {last}" if first else last


def _with_n(pair: Paired, group: str) -> str:
    counts = [np.count_nonzero(_inside(pair, group, level)) for level in pair.levels]
    return f"{group}\nn = {', '.join(map(str, counts))}"


def _shade(axes: Axes, at: float, reach: float) -> None:
    axes.axvspan(at - reach, at + reach, color=SHADE, zorder=0)


def _mean_and_se(
    axes: Axes, at: float, values: Floats, colour: str, marker: str, reach: float = 0.25
) -> None:
    se = float(values.std(ddof=1)) / len(values) ** 0.5 if len(values) > 1 else None
    _mean_and_bar(axes, at, values, colour, marker, se, reach)


def _mean_and_bar(
    axes: Axes,
    at: float,
    values: Floats,
    colour: str,
    marker: str,
    bar: float | None,
    reach: float,
) -> None:
    """Every value faintly, near ones side by side, and their mean with a bar of this half length;
    one value alone has no bar."""
    if len(values) == 0:
        return
    axes.plot(
        at + side_by_side(values, reach),
        values,
        linestyle="none",
        marker=".",
        markersize=4,
        color=colour,
        alpha=0.45,
        markeredgewidth=0,
    )
    axes.errorbar(
        at,
        values.mean(),
        yerr=bar if len(values) > 1 else None,
        fmt=marker,
        color=colour,
        ecolor=INK,
        elinewidth=1.0,
        capsize=2.5,
        markersize=5,
        markeredgecolor="white",
        markeredgewidth=0.6,
        zorder=3,
    )


def side_by_side(values: Floats, reach: float) -> Floats:
    """Where each value lies beside its place, -reach to reach: neighbours spread evenly about 0.

    Values within a twentieth of the range share a row, so the shape tells how many they are, and
    nothing leans to a side.
    """
    width = max(float(np.ptp(values)) / 20, 1e-9)
    rows = np.round((values - values.min()) / width).astype(int)
    counts = np.bincount(rows)
    step = 2 * reach / max(6, int(counts.max()))
    offsets = np.zeros(len(values))
    for row in np.unique(rows):
        members = np.flatnonzero(rows == row)
        offsets[members] = (np.arange(len(members)) - (len(members) - 1) / 2) * step
    return offsets


def _significant(row: Row, alpha: float) -> str | None:
    p = row["p_holm"]
    if isinstance(p, Absent) or not isinstance(p, float) or p >= alpha:
        return None
    return p_words(p)


def _level_brackets(axes: Axes, alpha: float, comparisons: list[Row]) -> None:
    low, high = axes.get_ylim()
    unit = (high - low) / 143
    heights = dict.fromkeys(KNOWLEDGE, high - 38 * unit)
    for row in comparisons:
        text = _significant(row, alpha)
        group = str(row["knowledge"])
        if row["adaptivity"] == "static" and text:
            one, other = str(row["contrast"]).split(" - ")
            at = KNOWLEDGE.index(group)
            bracket(axes, at + OFFSETS[one], at + OFFSETS[other], heights[group], text)
            heights[group] += 12 * unit


def _group_brackets(
    panels: "np.ndarray[tuple[int], np.dtype[np.object_]]",
    levels: tuple[str, ...],
    alpha: float,
    rows: list[Row],
) -> None:
    low, high = panels[0].get_ylim()
    step = 0.09 * (high - low)
    heights = dict.fromkeys(levels, high)
    for row in rows:
        text = _significant(row, alpha)
        level = str(row["complexity"])
        if text:
            one, other = (KNOWLEDGE.index(name) for name in str(row["contrast"]).split(" - "))
            bracket(panels[levels.index(level)], one, other, heights[level], text)
            heights[level] += step
    panels[0].set_ylim(low, max([high, *heights.values()]) + step)
