"""What the adaptive coach concluded, when it acted, and how right it was."""

from collections.abc import Sequence

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from analysis.pages.mission_rows import with_groups
from analysis.pages.style import (
    BLUE,
    GROUP_COLOURS,
    GROUP_LINES,
    INK,
    LEVEL_COLOURS,
    LEVEL_MARKERS,
    SHADE,
    TWO_COLUMNS,
    Captioned,
    captioned,
    quiet_style,
)
from analysis.pages.what_if import JudgedMission, sweep
from analysis.sources.absent import Refusal, Row
from analysis.sources.factors import COMPLEXITY, KNOWLEDGE
from analysis.sources.frames import StudyData
from analysis.sources.recorded import Recorded
from analysis.stats.intervals import clustered_share
from analysis.stats.level import ALPHA, percent

BINS = np.linspace(0, 1, 11)
LOWER_VALUES = tuple(np.round(np.arange(0.05, 0.75, 0.05), 2))
RAISE_VALUES = tuple(np.round(np.arange(0.35, 1.0, 0.05), 2))
PRIOR_VALUES = tuple(np.round(np.arange(0.1, 0.95, 0.05), 2))
SWEPT: dict[str, tuple[str, Sequence[float]]] = {
    "lower_below": ("lower threshold", LOWER_VALUES),
    "raise_above": ("upper threshold", RAISE_VALUES),
    "prior_mass": ("prior mass of the goal's room", PRIOR_VALUES),
}
MISSION = ("participant", "round")
AHEAD_MS = 10_000
FOLLOWED = {
    "came_true": "next rescue in the goal's room",
    "no_misstep": f"no misstep for {AHEAD_MS // 1000} s",
}


def evaluations(recorded: Recorded, study: StudyData) -> pd.DataFrame:
    """The evaluations that carry evidence, with knowledge groups and what came of them.

    `came_true`: whether the next victim rescued was in the instructed one's room (or was it);
    missing where none followed. `no_misstep`: whether no misstep followed within `AHEAD_MS`.
    Raises Refusal where there are none.
    """
    table = with_groups(recorded.of_missions("posteriors"), study)
    table = table[table["verdict"] != "none"].sort_values("at_ms", ignore_index=True)
    if table.empty:
        raise Refusal("no evaluation of the coach carries evidence")
    victims = recorded.frame("victims")
    place = victims["room"].where(victims["room"].notna(), victims["victim"])
    victims = victims.assign(place=place)
    goal = victims[[*MISSION, "victim", "place"]].rename(columns={"victim": "goal"})
    saved = victims[victims["fate"] == "rescued"].assign(then_ms=victims["fate_ms"])
    told = recorded.frame("instructions")
    missteps = told[told["reason"] == "misstep"].assign(then_ms=told["at_ms"])
    table = table.merge(goal, on=[*MISSION, "goal"], how="left")
    rescue = _next(table, saved[[*MISSION, "then_ms", "place"]])
    wait_ms = _next(table, missteps[[*MISSION, "then_ms"]])["then_ms"] - table["at_ms"]
    came_true = (rescue["place"] == rescue["place_next"]).astype(float)
    return table.assign(
        came_true=came_true.where(rescue["place_next"].notna()),
        no_misstep=(~(wait_ms <= AHEAD_MS)).astype(float),
    ).sort_values([*MISSION, "at_ms"], ignore_index=True)


def _next(table: pd.DataFrame, events: pd.DataFrame) -> pd.DataFrame:
    """Each row of `table` with the first event after it in its mission; same order of rows."""
    events = events.assign(at_ms=events["then_ms"].astype(float)).sort_values("at_ms")
    return pd.merge_asof(
        table.assign(at_ms=table["at_ms"].astype(float)),
        events,
        on="at_ms",
        by=list(MISSION),
        direction="forward",
        allow_exact_matches=False,
        suffixes=("", "_next"),
    )


def calibration_rows(table: pd.DataFrame, outcome: str, alpha: float = ALPHA) -> list[Row]:
    """By tenths of P(g*): how many evaluations, their mean, and the share with the `outcome`
    (`came_true` or `no_misstep`), with an interval that draws whole people. `table` is that of
    `evaluations`."""
    known = table[table[outcome].notna()]
    numbers, names = pd.factorize(known["participant"])
    tenth = np.clip(np.digitize(known["comprehension"], BINS) - 1, 0, len(BINS) - 2)
    truth = known[outcome].to_numpy(dtype=float)
    rows: list[Row] = []
    for at in range(len(BINS) - 1):
        inside = tenth == at
        if inside.any():
            interval = clustered_share(numbers[inside], len(names), truth[inside], alpha)
            rows.append(
                {
                    "from": float(BINS[at]),
                    "to": float(BINS[at + 1]),
                    "evaluations": int(inside.sum()),
                    "people": len(np.unique(numbers[inside])),
                    "mean": float(known["comprehension"].to_numpy()[inside].mean()),
                    "share": interval.estimate,
                    "lower": interval.lower,
                    "upper": interval.upper,
                }
            )
    return rows


def verdict_rows(table: pd.DataFrame) -> list[Row]:
    """What the evaluations asked for, as shares by knowledge group."""
    rows: list[Row] = []
    for group in KNOWLEDGE:
        own = table[table["knowledge"] == group]
        if len(own):
            said = own["verdict"].value_counts(normalize=True)
            rows.append(
                {
                    "knowledge": group,
                    "evaluations": len(own),
                    "mean P(g*)": float(own["comprehension"].mean()),
                    **{name: float(said.get(name, 0.0)) for name in ("lower", "keep", "raise")},
                }
            )
    return rows


def posterior_figure(table: pd.DataFrame, *, simulated: bool) -> Captioned:
    """How P(g*) is distributed in each knowledge group, with the thresholds."""
    with quiet_style():
        figure = Figure(figsize=(TWO_COLUMNS, 3.6))
        axes = figure.subplots()
        low, high = (float(table[name].iloc[0]) for name in ("lower_below", "raise_above"))
        axes.axvspan(low, high, color=SHADE, zorder=0)
        for group in KNOWLEDGE:
            own = table[table["knowledge"] == group]
            values = np.sort(own["comprehension"])
            if len(values):
                height = np.arange(1, len(values) + 1) / len(values)
                axes.step(
                    values,
                    height,
                    where="post",
                    color=GROUP_COLOURS[group],
                    linestyle=GROUP_LINES[group],
                    label=f"{group} (n = {own['participant'].nunique()})",
                )
        axes.text(low, 1.04, "one level down", ha="right", fontsize=8, color=INK)
        axes.text((low + high) / 2, 1.04, "keep", ha="center", fontsize=8, color=INK)
        axes.text(high, 1.04, "one level up", ha="left", fontsize=8, color=INK)
        axes.set_xlim(0, 1)
        axes.set_ylim(0, 1.12)
        axes.set_yticks(np.linspace(0, 1, 6))
        axes.set_xlabel("P(g*|path) at an evaluation")
        axes.set_ylabel("share of evaluations at or below")
        figure.legend(loc="outside upper right", ncols=3)
        return captioned(
            "coach_posterior",
            figure,
            "What the coach concluded, by knowledge group: see how far apart the curves are "
            "(the lower, the more certain), and how much of each falls left and right of the grey "
            "band, where the level changes.",
            simulated=simulated,
        )


def calibration_figure(table: pd.DataFrame, *, simulated: bool, alpha: float = ALPHA) -> Captioned:
    """P(g*) against what came of it; `table` is that of `evaluations`."""
    with quiet_style():
        figure = Figure(figsize=(TWO_COLUMNS, 3.9))
        panels = np.ravel(figure.subplots(1, 2, sharex=True, sharey=True))
        for axes, (outcome, title) in zip(panels, FOLLOWED.items(), strict=True):
            rows = pd.DataFrame(calibration_rows(table, outcome, alpha))
            axes.set_title(title)
            axes.plot([0, 1], [0, 1], color=INK, linewidth=0.8, linestyle=":")
            errors = np.abs(rows[["lower", "upper"]].to_numpy().T - rows["share"].to_numpy())
            axes.errorbar(
                rows["mean"],
                rows["share"],
                yerr=errors,
                fmt="o",
                color=BLUE,
                ecolor=INK,
                elinewidth=1.0,
                capsize=2.5,
            )
            axes.set_xlim(0, 1.03)
            axes.set_ylim(0, 1.03)
            axes.set_xlabel("P(g*|path) at an evaluation")
        panels[0].set_ylabel("share of evaluations")
        return captioned(
            "coach_calibration",
            figure,
            "How right the coach was: a point on the dotted line is a probability that comes true "
            "as often as it says, a flat row of points says nothing about what follows; "
            f"{percent(1 - alpha)} intervals draw whole people.",
            simulated=simulated,
        )


def what_if_figure(missions: Sequence[JudgedMission], *, simulated: bool) -> Captioned:
    """Mean shares of C1, C2 and C3 by group as thresholds and prior change."""
    own = {
        "lower_below": missions[0].rule.lower_below,
        "raise_above": missions[0].rule.raise_above,
        "prior_mass": missions[0].rule.prior_mass,
    }
    swept = {name: what for name, what in SWEPT.items() if own[name] is not None}
    with quiet_style():
        figure = Figure(figsize=(TWO_COLUMNS, 5.6))
        panels = figure.subplots(
            len(KNOWLEDGE), len(swept), sharex="col", sharey=True, squeeze=False
        )
        for column, (name, (label, values)) in enumerate(swept.items()):
            legal = [value for value in values if _legal(name, value, own)]
            table = sweep(missions, name, legal)
            for axes, group in zip(panels[:, column], KNOWLEDGE, strict=True):
                part = table[table["knowledge"] == group]
                for level in COMPLEXITY:
                    axes.plot(
                        part["value"],
                        part[level],
                        color=LEVEL_COLOURS[level],
                        marker=LEVEL_MARKERS[level],
                        markersize=3.5,
                        linewidth=1.2,
                        label=level,
                    )
                axes.axvline(own[name], color=INK, linewidth=0.8, linestyle=":")
                axes.set_ylim(0, 1)
                if column == 0:
                    axes.set_ylabel(f"{group}\nshare of time")
            panels[-1, column].set_xlabel(label)
        figure.legend(*panels[0, 0].get_legend_handles_labels(), loc="outside upper right", ncols=3)
        return captioned(
            "coach_what_if",
            figure,
            "The same behaviour judged by other thresholds (tau) and another prior; dotted: as it "
            "was. See whether any setting gives the three groups different levels; people would "
            "have acted differently under other words, so this is not a forecast.",
            simulated=simulated,
        )


def _legal(name: str, value: float, own: dict[str, float | None]) -> bool:
    low, high = own["lower_below"], own["raise_above"]
    if low is None or high is None:
        return False
    return {
        "lower_below": value < high,
        "raise_above": value > low,
        "prior_mass": True,
    }[name]
