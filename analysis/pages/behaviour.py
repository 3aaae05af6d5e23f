"""Does the coach behave as published? Levels, switches, what its posterior tells of knowledge, and
rescues, with bootstrap intervals, for one study or for several side by side (paper 5.4, Figs. 8
and 10)."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Literal

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure

from analysis.pages.mission_rows import SHARES
from analysis.pages.style import (
    BLUE,
    INK,
    LEVEL_COLOURS,
    LEVEL_MARKERS,
    SHADE,
    TWO_COLUMNS,
    VERMILION,
    Captioned,
    captioned,
    quiet_style,
)
from analysis.sources.absent import Absent, Row, attempt
from analysis.sources.factors import COMPLEXITY, KNOWLEDGE
from analysis.sources.frames import Floats
from analysis.stats.intervals import Interval, auc_interval, gap_interval, mean_interval
from analysis.stats.level import ALPHA, percent

#: Rescues differ by less than this, in standard deviations of the static missions: about equal.
EQUAL_SDS = 0.5

Verdict = Literal["holds", "open", "fails"]
VERDICTS: dict[int, Verdict] = {1: "holds", 0: "open", -1: "fails"}


def level_rows(missions: pd.DataFrame, alpha: float = ALPHA) -> list[Row]:
    """Shares of time at each level and switches a mission of the adaptive instructor, by group.

    `missions` has the columns of `analysis.pages.mission_rows`.
    """
    rows: list[Row] = []
    for group in KNOWLEDGE:
        own = _adaptive(missions, group)
        if len(own):
            parts = dict(zip(COMPLEXITY, SHARES, strict=True)) | {"switches": "switches"}
            found = {
                name: mean_interval(_values(own, column), alpha) for name, column in parts.items()
            }
            rows.append({"knowledge": group, "missions": len(own), **_told(found)})
    return rows


def rescue_rows(missions: pd.DataFrame, alpha: float = ALPHA) -> list[Row]:
    """Rescues with the adaptive instructor less those of the same people with each static level,
    and by knowledge group."""
    rows: list[Row] = []
    for column, values in (("complexity", COMPLEXITY), ("knowledge", KNOWLEDGE)):
        for value in values:
            gaps = _gaps(missions[missions[column] == value])
            if len(gaps):
                found = {"adaptive - static": mean_interval(gaps, alpha)}
                rows.append({"people": f"{column} {value}", "n": len(gaps), **_told(found)})
    return rows


def auc_rows(missions: pd.DataFrame, alpha: float = ALPHA) -> list[Row]:
    """How well the mean P(g*) of a mission tells two knowledge groups apart (.5: not at all)."""
    rows: list[Row] = []
    for one, other in (("HIGH", "LOW"), ("HIGH", "MED"), ("MED", "LOW")):
        found = attempt(_auc, missions, one, other, alpha)
        told = found if isinstance(found, Absent) else str(found)
        rows.append({"groups": f"{one} above {other}", "AUC": told})
    return rows


Measure = Callable[[pd.DataFrame, float], Interval]
"""From missions and alpha to a number with its interval."""


@dataclass(frozen=True)
class Conclusion:
    """A published statement as a number that is positive where it holds."""

    words: str
    place: str
    measure: Measure

    def verdict(self, missions: pd.DataFrame, alpha: float = ALPHA) -> Verdict | Absent:
        """Holds or fails where the whole interval says so, else open."""
        found = attempt(self.measure, missions, alpha)
        if isinstance(found, Absent):
            return found
        return VERDICTS[found.sign]


def _share_gap(share: str, one: str, other: str) -> Measure:
    def gap(missions: pd.DataFrame, alpha: float) -> Interval:
        ones, others = (_values(_adaptive(missions, group), share) for group in (one, other))
        return gap_interval(ones, others, alpha)

    return gap


def _mostly(share: str, group: str) -> Measure:
    def excess(missions: pd.DataFrame, alpha: float) -> Interval:
        own = _adaptive(missions, group)
        rest = own[[name for name in SHARES if name != share]].max(axis=1)
        return mean_interval(_values(own.assign(lead=own[share] - rest), "lead"), alpha)

    return excess


def _knowledge_saves(missions: pd.DataFrame, alpha: float) -> Interval:
    mean = missions.groupby(["participant", "knowledge"], as_index=False)["victims"].mean()
    ones, others = (_values(mean[mean["knowledge"] == group], "victims") for group in _ENDS)
    return gap_interval(ones, others, alpha)


def _about_equal(missions: pd.DataFrame, alpha: float) -> Interval:
    """What is left of the margin on the nearer side."""
    unit = float(missions.loc[missions["adaptivity"] == "static", "victims"].std())
    gap = mean_interval(_gaps(missions), alpha)
    margin = EQUAL_SDS * unit
    return Interval(
        margin - abs(gap.estimate),
        margin - max(abs(gap.lower), abs(gap.upper)),
        margin - (0.0 if gap.sign == 0 else min(abs(gap.lower), abs(gap.upper))),
    )


def _tells_apart(missions: pd.DataFrame, alpha: float) -> Interval:
    return _auc(missions, *_ENDS, alpha).minus(0.5)


_ENDS = ("HIGH", "LOW")

CONCLUSIONS = (
    Conclusion("LOW is mostly led at C1", "Fig. 10", _mostly("share_c1", "LOW")),
    Conclusion("MED is mostly led at C2", "Fig. 10", _mostly("share_c2", "MED")),
    Conclusion("HIGH is mostly led at C2", "Fig. 10", _mostly("share_c2", "HIGH")),
    Conclusion("HIGH gets more C3 than MED", "Fig. 10", _share_gap("share_c3", "HIGH", "MED")),
    Conclusion("HIGH gets less C1 than MED", "Fig. 10", _share_gap("share_c1", "MED", "HIGH")),
    Conclusion("LOW gets more C1 than HIGH", "Fig. 10", _share_gap("share_c1", "LOW", "HIGH")),
    Conclusion("P(g*) tells HIGH from LOW", "section 5.2", _tells_apart),
    Conclusion("knowledge saves more (HIGH over LOW)", "Fig. 8", _knowledge_saves),
    Conclusion("adaptive saves about as many as static", "Fig. 8", _about_equal),
)


def conclusion_table(missions: pd.DataFrame, by: list[str], alpha: float = ALPHA) -> pd.DataFrame:
    """The verdict on each published statement (a row each) in each group of studies (a column)."""
    columns: dict[str, list[str]] = {}
    for names, part in _studies(missions, by):
        found = [conclusion.verdict(part, alpha) for conclusion in CONCLUSIONS]
        columns[", ".join(names)] = [
            "open" if isinstance(verdict, Absent) else verdict for verdict in found
        ]
    index = pd.Index([f"{one.words} ({one.place})" for one in CONCLUSIONS], name="as published")
    return pd.DataFrame(columns, index=index)


def shares_figure(
    missions: pd.DataFrame, by: list[str], *, simulated: bool, alpha: float = ALPHA
) -> Captioned:
    """Shares of time at each level by group, a panel for each group of studies."""
    parts = _studies(missions, by)
    across = min(4, len(parts))
    down = -(-len(parts) // across)
    with quiet_style():
        figure = Figure(figsize=(TWO_COLUMNS, 1.2 + 1.9 * down))
        panels = figure.subplots(down, across, sharex=True, sharey=True, squeeze=False).ravel()
        for axes in panels[len(parts) :]:
            axes.set_visible(False)
        for axes, (names, part) in zip(panels, parts, strict=False):
            axes.set_title("\n".join(names), fontsize=8)
            for at, group in enumerate(KNOWLEDGE):
                own = _adaptive(part, group)
                for level, share in zip(COMPLEXITY, SHARES, strict=True):
                    found = attempt(mean_interval, _values(own, share), alpha)
                    if not isinstance(found, Absent):
                        _point(axes, at + 0.18 * (COMPLEXITY.index(level) - 1), found, level)
            axes.set_xticks(range(len(KNOWLEDGE)), KNOWLEDGE)
            axes.set_ylim(0, 1)
        for axes in panels[::across]:
            axes.set_ylabel("share of time")
        handles, labels = panels[0].get_legend_handles_labels()
        first = dict(zip(labels, handles, strict=True))
        figure.legend(first.values(), first.keys(), loc="outside upper right", ncols=3)
        return captioned(
            "behaviour_shares",
            figure,
            f"Share of the adaptive missions at each level, mean and {percent(1 - alpha)} "
            "interval: as in Fig. 10, C1 would lead for LOW, C2 for MED and HIGH, and C3 would "
            "rise from MED to HIGH.",
            simulated=simulated,
        )


def verdict_figure(table: pd.DataFrame, *, simulated: bool, alpha: float = ALPHA) -> Captioned:
    """Which conclusions survive; `table` is that of `conclusion_table`."""
    signs = {"holds": ("+", 2), "open": ("?", 1), "fails": ("\N{MINUS SIGN}", 0)}
    with quiet_style():
        figure = Figure(figsize=(TWO_COLUMNS, 2.6 + 0.3 * len(table)))
        axes = figure.subplots()
        axes.grid(visible=False)
        codes = table.map(lambda verdict: signs[verdict][1]).to_numpy()
        colours = ListedColormap([VERMILION, SHADE, BLUE])
        axes.imshow(codes, cmap=colours, vmin=0, vmax=2, aspect="auto")
        for (row, column), code in np.ndenumerate(codes):
            mark = next(sign for sign, value in signs.values() if value == code)
            axes.text(
                column, row, mark, ha="center", va="center", color=INK if code == 1 else "white"
            )
        axes.set_yticks(range(len(table)), table.index, fontsize=8)
        axes.set_xticks(
            range(len(table.columns)), table.columns, fontsize=8, rotation=50, ha="left"
        )
        axes.tick_params(length=0)
        axes.xaxis.tick_top()
        for spine in axes.spines.values():
            spine.set_visible(False)
        return captioned(
            "behaviour_conclusions",
            figure,
            "Published statements against simulated people: blue + holds, red \N{MINUS SIGN} fails "
            f"(the whole {percent(1 - alpha)} interval says so), grey ? is open; rows of one "
            "colour hang on neither preset nor kind of people.",
            simulated=simulated,
        )


def separation_figure(
    missions: pd.DataFrame, by: list[str], *, simulated: bool, alpha: float = ALPHA
) -> Captioned:
    """AUC of the mean P(g*), HIGH above LOW, for each group of studies."""
    parts = _studies(missions, by)
    with quiet_style():
        figure = Figure(figsize=(TWO_COLUMNS, 1.5 + 0.28 * len(parts)))
        axes = figure.subplots()
        axes.grid(axis="x")
        axes.grid(visible=False, axis="y")
        axes.axvline(0.5, color=INK, linewidth=0.8, linestyle=":")
        for at, (_, part) in enumerate(parts):
            found = attempt(_auc, part, *_ENDS, alpha)
            if isinstance(found, Absent):
                axes.text(0.5, at, found.reason, va="center", fontsize=7)
                continue
            axes.plot([found.lower, found.upper], [at, at], color=BLUE, linewidth=1.6)
            axes.plot([found.estimate], [at], "o", color=BLUE, markeredgecolor="white")
        axes.set_yticks(range(len(parts)), [", ".join(names) for names, _ in parts])
        axes.set_ylim(len(parts) - 0.5, -0.5)
        axes.set_xlim(0, 1)
        axes.set_xlabel("AUC of a mission's mean P(g*), HIGH above LOW knowledge")
        return captioned(
            "behaviour_auc",
            figure,
            "How well the coach's posterior knows what people know: .5 (dotted) is not at all, 1 "
            f"always; {percent(1 - alpha)} intervals.",
            simulated=simulated,
        )


def _studies(missions: pd.DataFrame, by: list[str]) -> list[tuple[tuple[str, ...], pd.DataFrame]]:
    """The missions of each group of studies, under its names, in the order of their rows."""
    grouped = missions.groupby(by, sort=False)
    return [(tuple(str(name) for name in key), part) for key, part in grouped]


def _adaptive(missions: pd.DataFrame, group: str) -> pd.DataFrame:
    return missions[(missions["adaptivity"] == "adaptive") & (missions["knowledge"] == group)]


def _values(table: pd.DataFrame, column: str) -> Floats:
    return table[column].dropna().to_numpy(dtype=float)


def _gaps(missions: pd.DataFrame) -> Floats:
    wide = missions.pivot_table(index="participant", columns="adaptivity", values="victims")
    wide = wide.reindex(columns=["static", "adaptive"]).dropna()
    return (wide["adaptive"] - wide["static"]).to_numpy(dtype=float)


def _auc(missions: pd.DataFrame, one: str, other: str, alpha: float) -> Interval:
    ones, others = (
        _values(_adaptive(missions, group), "mean_comprehension") for group in (one, other)
    )
    return auc_interval(ones, others, alpha)


def _told(found: Mapping[str, Interval]) -> Row:
    return {name: str(interval) for name, interval in found.items()}


def _point(axes: Axes, at: float, found: Interval, level: str) -> None:
    axes.plot([at, at], [found.lower, found.upper], color=LEVEL_COLOURS[level], linewidth=1.4)
    axes.plot(
        [at],
        [found.estimate],
        LEVEL_MARKERS[level],
        color=LEVEL_COLOURS[level],
        markeredgecolor="white",
        label=level,
    )
