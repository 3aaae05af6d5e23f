"""What people knew of the map: quiz scores, groups and their cuts (paper 5.3)."""

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from analysis.pages.sentences import time_words
from analysis.pages.style import (
    GROUP_COLOURS,
    INK,
    TWO_COLUMNS,
    Captioned,
    captioned,
    quiet_style,
)
from analysis.sources.absent import Absent
from analysis.sources.factors import COMPLEXITY, KNOWLEDGE
from analysis.sources.frames import StudyData
from analysis.stats.clustering import Clustering


def knowledge_figure(study: StudyData, clustering: Clustering | Absent) -> Captioned:
    """Quiz scores of the static round by memorise time, coloured by group, with the cuts.

    Raises Refusal where the study has no groups.
    """
    study.need_groups()
    people = study.participants.dropna(subset=["quiz_static"])
    with quiet_style():
        times = sorted(people["memorise_minutes"].dropna().unique())
        figure = Figure(figsize=(TWO_COLUMNS, 1.4 + 1.5 * max(1, len(times))))
        panels = np.ravel(figure.subplots(max(1, len(times)), 1, sharex=True, sharey=True))
        edges = np.arange(-0.025, 1.05, 0.05)
        for axes, minutes in zip(panels, times, strict=False):
            own = people[people["memorise_minutes"] == minutes]
            groups = [own.loc[own["knowledge"] == group, "quiz_static"] for group in KNOWLEDGE]
            axes.hist(
                [np.asarray(scores, dtype=float) for scores in groups],
                bins=edges.tolist(),
                stacked=True,
                color=[GROUP_COLOURS[group] for group in KNOWLEDGE],
                label=list(KNOWLEDGE),
                rwidth=0.85,
            )
            axes.set_title(f"{time_words(minutes)} to memorise (n = {len(own)})")
            axes.set_ylabel("people")
            if not isinstance(clustering, Absent):
                for cut in clustering.boundaries:
                    axes.axvline(cut, color=INK, linewidth=0.9, linestyle=":")
        panels[-1].set_xlabel("share of rooms labelled right before the static mission")
        figure.legend(*panels[0].get_legend_handles_labels(), loc="outside upper right", ncols=3)
        return captioned(
            "knowledge",
            figure,
            "Quiz scores and the knowledge groups that they form (dotted: the cuts): see whether "
            "a longer time moves people to the right, and whether all groups are there.",
            simulated=study.simulated,
        )


def group_table(study: StudyData) -> pd.DataFrame:
    """People in each knowledge group by static level, by the static round's building and by
    memorise time. Raises Refusal where the study has no groups."""
    study.need_groups()
    static = study.rounds[study.rounds["adaptivity"] == "static"].set_index("participant")
    people = study.participants.assign(building=static["building"])
    parts = {
        "static level": pd.crosstab(people["knowledge"], people["complexity"]).reindex(
            columns=list(COMPLEXITY), fill_value=0
        ),
        "building": pd.crosstab(people["knowledge"], people["building"]),
        "minutes": pd.crosstab(people["knowledge"], people["memorise_minutes"]),
    }
    return pd.concat(parts, axis=1).reindex(list(KNOWLEDGE)).fillna(0).astype(int)
