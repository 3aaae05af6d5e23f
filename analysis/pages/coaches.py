"""The comparison of coaches as a table in text, as JSON, and as a figure."""

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from analysis.pages.style import (
    BLUE,
    GREEN,
    INK,
    ORANGE,
    VERMILION,
    Captioned,
    captioned,
    quiet_style,
)
from analysis.sources.absent import Absent, Row
from analysis.sources.factors import KNOWLEDGE
from analysis.stats.comparison import STATIC, TRUTH, Calibration, Cell, Comparison, cell_row
from analysis.stats.intervals import Interval

_COLOURS = (BLUE, ORANGE, GREEN, VERMILION, INK)
_MARKERS = ("o", "s", "^", "D", "v")


def comparison_text(comparison: Comparison, people: str) -> str:
    """The table that a terminal shows. `people` says who they are and which set they belong to."""
    lines = [people]
    for world in dict.fromkeys(cell.world for cell in comparison.cells):
        lines += ["", world, _HEADER]
        for group in KNOWLEDGE:
            cells = [it for it in comparison.cells if (it.world, it.group) == (world, group)]
            best = comparison.best_static.get((world, group))
            lines += [_line(cell, cell.coach == best) for cell in cells]
    for calibration in comparison.calibrations:
        lines += ["", *_calibration_lines(calibration)]
    if comparison.path_aucs:
        lines += ["", "mean P(g*|path): how often that of a HIGH person is above a LOW one's"]
        lines += [f"  {one.world}, {one.coach}: {one.auc}" for one in comparison.path_aucs]
    if comparison.best_static:
        lines += ["", "*: the static level with the most rescues in the group, chosen on these"]
        lines += ["   very people, which flatters it a little."]
    return "\n".join(lines)


_HEADER = (
    "group coach                n rescues        - best static      - ana              "
    "switches  C1  C2  C3  lost align"
)


def _line(cell: Cell, best: bool) -> str:
    interval = cell.rescues_interval
    half = "" if interval is None else f"±{interval.upper - interval.estimate:.2f}"
    shares = " ".join(_share(share) for share in (cell.c1, cell.c2, cell.c3, cell.lost))
    return (
        f"{cell.group:<5} {cell.coach + ('*' if best else ''):<18.18} {cell.n:>4} "
        f"{cell.rescues:5.2f} {half:<7} {_difference(cell.minus_best_static):<18}"
        f" {_difference(cell.minus_ana):<18} {cell.switches:>6.1f}   {shares}   "
        f"{_share(cell.alignment)}"
    )


def _share(share: float) -> str:
    return f"{share:.2f}".removeprefix("0")


def _difference(difference: Interval | None) -> str:
    if difference is None:
        return "-"
    if difference.estimate == difference.lower == difference.upper == 0:
        return "0"
    return f"{difference.estimate:+.2f} [{difference.lower:+.2f},{difference.upper:+.2f}]"


def _calibration_lines(calibration: Calibration) -> list[str]:
    def told(area: float | Absent) -> str:
        return area.reason if isinstance(area, Absent) else f"{area:.2f}"

    curve = "  ".join(
        f"{_share(tenth.p)}:{_share(tenth.known)} ({tenth.n})" for tenth in calibration.reliability
    )
    return [
        f"{calibration.coach}: P known : share truly known (choices), by tenths of P",
        f"  {curve}",
        f"  AUC of rooms {told(calibration.room_auc)}, "
        f"of people, HIGH over LOW {told(calibration.person_auc)}",
    ]


def comparison_rows(comparison: Comparison) -> dict[str, list[Row]]:
    """What is written to JSON: `cells`, `best_static`, `path_auc` and `calibration`."""
    return {
        "cells": [cell_row(cell) for cell in comparison.cells],
        "best_static": [
            {"world": world, "group": group, "coach": coach}
            for (world, group), coach in comparison.best_static.items()
        ],
        "path_auc": [
            {
                "world": one.world,
                "coach": one.coach,
                "auc": [one.auc.estimate, one.auc.lower, one.auc.upper],
            }
            for one in comparison.path_aucs
        ],
        "calibration": [
            {
                "coach": one.coach,
                "reliability": [
                    {"p": tenth.p, "known": tenth.known, "n": tenth.n} for tenth in one.reliability
                ],
                "room_auc": one.room_auc,
                "person_auc": one.person_auc,
            }
            for one in comparison.calibrations
        ],
    }


def comparison_figure(comparison: Comparison) -> Captioned:
    """Rescues minus those of the group's best static level, by world and group, with intervals."""
    worlds = list(dict.fromkeys(cell.world for cell in comparison.cells))
    shown = [
        coach
        for coach in dict.fromkeys(cell.coach for cell in comparison.cells)
        if not coach.startswith(STATIC) and coach != TRUTH
    ]
    with quiet_style():
        figure = Figure(figsize=(7.2, 0.9 + 1.5 * len(worlds)))
        panels = np.ravel(figure.subplots(len(worlds), 1, sharex=True, squeeze=False))
        for axes, world in zip(panels, worlds, strict=True):
            axes.set_title(world)
            axes.axvline(0, color=INK, linewidth=0.8)
            axes.set_yticks(range(len(KNOWLEDGE)), KNOWLEDGE)
            axes.set_ylim(len(KNOWLEDGE) - 0.5, -0.5)
            for number, coach in enumerate(shown):
                _points(axes, comparison.cells, world, coach, number, len(shown))
        panels[-1].set_xlabel("rescued victims, minus the group's best static level")
        handles, names = panels[0].get_legend_handles_labels()
        figure.legend(handles, names, loc="upper right", ncols=min(4, len(shown)))
        return captioned(
            "coaches",
            figure,
            "Rescued victims minus those with the static level that was best for the group, person "
            "by person, with 95% intervals. Groups by what people truly knew.",
            simulated=True,
        )


def _points(
    axes: Axes, cells: Sequence[Cell], world: str, coach: str, number: int, of: int
) -> None:
    apart = 0.7 * ((number + 0.5) / of - 0.5)
    found = {
        it.group: it.minus_best_static for it in cells if (it.world, it.coach) == (world, coach)
    }
    drawn = [
        (row + apart, difference)
        for row, group in enumerate(KNOWLEDGE)
        if (difference := found.get(group)) is not None
    ]
    axes.errorbar(
        [difference.estimate for _, difference in drawn],
        [row for row, _ in drawn],
        xerr=[
            [difference.estimate - difference.lower for _, difference in drawn],
            [difference.upper - difference.estimate for _, difference in drawn],
        ],
        fmt=_MARKERS[number % len(_MARKERS)],
        color=_COLOURS[number % len(_COLOURS)],
        markersize=4,
        linewidth=1,
        label=coach,
    )
