"""The level of the adaptive instructor over a mission (Fig. 10)."""

import numpy as np
import pandas as pd
from matplotlib.collections import PolyCollection
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from analysis.pages.mission_rows import SHARES, missions, with_groups
from analysis.pages.style import (
    GROUP_COLOURS,
    INK,
    LEVEL_COLOURS,
    TWO_COLUMNS,
    Captioned,
    captioned,
    quiet_style,
)
from analysis.sources.factors import COMPLEXITY, KNOWLEDGE
from analysis.sources.frames import Floats, StudyData
from analysis.sources.recorded import Recorded

SECONDS = 1000.0


def adaptive_levels(recorded: Recorded, study: StudyData) -> pd.DataFrame:
    """Every stretch at one level of the adaptive missions, with knowledge groups."""
    levels = with_groups(recorded.of_missions("levels"), study)
    return levels[levels["adaptivity"] == "adaptive"].reset_index(drop=True)


def illustrative(recorded: Recorded, study: StudyData) -> dict[str, str]:
    """In each group, the participant whose shares of C1, C2 and C3 lie nearest the group's means.

    Nobody picks them, so they stand for their groups; a tie goes to the first name.
    """
    table = missions(recorded, study)
    table = table[table["adaptivity"] == "adaptive"].dropna(subset=list(SHARES))
    chosen = {}
    for group in KNOWLEDGE:
        people = table[table["knowledge"] == group].sort_values("participant")
        if len(people):
            shares = people[list(SHARES)].to_numpy(dtype=float)
            away = np.square(shares - shares.mean(axis=0)).sum(axis=1).round(9)
            chosen[group] = str(people["participant"].iloc[int(away.argmin())])
    return chosen


def fig10_traces(recorded: Recorded, study: StudyData) -> Captioned:
    """The level over time for one participant of each knowledge group (Fig. 10)."""
    levels = adaptive_levels(recorded, study)
    chosen = illustrative(recorded, study)
    with quiet_style():
        figure = Figure(figsize=(TWO_COLUMNS, 4.6))
        panels = np.ravel(figure.subplots(len(KNOWLEDGE), 1, sharex=True, sharey=True))
        for axes, group in zip(panels, KNOWLEDGE, strict=True):
            axes.set_title(group)
            axes.set_yticks(range(len(COMPLEXITY)), COMPLEXITY)
            axes.set_ylim(-0.5, len(COMPLEXITY) - 0.5)
            own = levels[levels["participant"] == chosen.get(group)]
            times = np.array([*own["from_ms"], *own["until_ms"].tail(1)], dtype=float) / SECONDS
            heights = [COMPLEXITY.index(str(level)) for level in own["level"]]
            heights += heights[-1:]
            colour = GROUP_COLOURS[group]
            axes.fill_between(
                times, -0.5, heights, step="post", color=colour, alpha=0.12, linewidth=0
            )
            axes.step(times, heights, where="post", color=colour, linewidth=1.8)
            axes.set_ylabel(chosen.get(group, "nobody"), fontsize=8)
        panels[-1].set_xlabel("time in the mission, s")
        return captioned(
            "fig10_traces",
            figure,
            "Level of the adaptive instructor for the person of each group whose shares of time "
            "are nearest the group's mean: see how long each line stays low (C1) or high (C3).",
            simulated=study.simulated,
        )


def all_traces(recorded: Recorded, study: StudyData) -> Captioned:
    """Every adaptive mission as a strip of coloured levels, by knowledge group."""
    levels = adaptive_levels(recorded, study)
    height = levels.assign(
        weighted=levels["level"].map(COMPLEXITY.index) * (levels["until_ms"] - levels["from_ms"])
    )
    mean_level = height.groupby("participant")["weighted"].sum()
    sizes = [max(1, levels.loc[levels["knowledge"] == group, "participant"].nunique())
             for group in KNOWLEDGE]  # fmt: skip
    with quiet_style():
        figure = Figure(figsize=(TWO_COLUMNS, 6.4))
        panels = np.ravel(figure.subplots(len(KNOWLEDGE), 1, sharex=True, height_ratios=sizes))
        for axes, group in zip(panels, KNOWLEDGE, strict=True):
            own = levels[levels["knowledge"] == group]
            people = sorted(own["participant"].unique(), key=lambda who: (mean_level[who], who))
            place = {who: at for at, who in enumerate(people)}
            for level in COMPLEXITY:
                part = own[own["level"] == level]
                rows = part["participant"].map(place)
                axes.add_collection(
                    PolyCollection(
                        list(_strips(rows, part["from_ms"] / SECONDS, part["until_ms"] / SECONDS)),
                        facecolors=LEVEL_COLOURS[level],
                        linewidths=0,
                    )
                )
            axes.autoscale_view()
            axes.grid(visible=False)
            axes.set_yticks([])
            axes.set_ylim(-0.5, max(1, len(people)) - 0.5)
            axes.set_ylabel(f"{group} (n = {len(people)})")
            axes.margins(x=0)
        panels[-1].set_xlabel("time in the mission, s")
        keys = [Patch(color=LEVEL_COLOURS[level], label=level) for level in COMPLEXITY]
        figure.legend(handles=keys, loc="outside upper right", ncols=3, fontsize=8)
        panels[-1].tick_params(colors=INK)
        return captioned(
            "all_traces",
            figure,
            "Every adaptive mission, a row a person, in each group from the lowest mean level at "
            "the bottom to the highest: see whether the colour of a group changes with knowledge, "
            "and how often a row changes.",
            simulated=study.simulated,
        )


def _strips(rows: pd.Series, begins: pd.Series, ends: pd.Series) -> Floats:
    """The corners of a strip in each of these rows from its begin to its end: n x 4 x 2."""
    at, low, high = (values.to_numpy(dtype=float) for values in (rows, begins, ends))
    x = np.column_stack([low, high, high, low])
    y = at[:, None] + np.array([-0.5, -0.5, 0.5, 0.5])
    return np.stack([x, y], axis=-1)
