"""The comparison of coaches as a table in text, as JSON, and as a figure."""

import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from analysis.pages.style import (
    BLUE,
    GREEN,
    INK,
    LEVEL_COLOURS,
    ONE_COLUMN,
    ORANGE,
    TWO_COLUMNS,
    VERMILION,
    Captioned,
    captioned,
    quiet_style,
)
from analysis.sources.absent import Absent, Row, SourceError
from analysis.sources.factors import COMPLEXITY, KNOWLEDGE
from analysis.stats.comparison import (
    STATIC,
    TRUTH,
    Calibration,
    Cell,
    Comparison,
    PathAuc,
    Tenth,
    cell_row,
)
from analysis.stats.intervals import Interval

_COLOURS = (BLUE, ORANGE, GREEN, VERMILION, INK)
_MARKERS = ("o", "s", "^", "D", "v", "P", "X")
"""More than the colours by a number without a common divisor, so that no two coaches look alike."""
_AS_SHIPPED = "as shipped"
TOLD = (_AS_SHIPPED, "0", "16")
"""The points of the curve of switches that are named in it."""


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
    half = "" if interval is None else f"±{_half(interval):.2f}"
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
        figure = Figure(figsize=(TWO_COLUMNS, 0.9 + 1.5 * len(worlds)))
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
        figure.legend(handles, names, loc="outside upper right", ncols=min(4, len(shown)))
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


def read_comparison(path: Path) -> Comparison:
    """The comparison that `ana compare --json` wrote. Raises SourceError, naming the file."""
    try:
        tree = json.loads(path.read_text(encoding="utf-8"))
        return Comparison(
            tuple(_cell_of(row) for row in tree["cells"]),
            tuple(
                PathAuc(row["world"], row["coach"], Interval(*row["auc"]))
                for row in tree["path_auc"]
            ),
            {(row["world"], row["group"]): row["coach"] for row in tree["best_static"]},
            tuple(_calibration_of(row) for row in tree["calibration"]),
        )
    except OSError as error:
        raise SourceError(
            f"the comparison cannot be read ({error.strerror})",
            place=str(path),
            hint="`make coaches` makes it.",
        ) from error
    except (ValueError, KeyError, TypeError) as error:
        raise SourceError(
            f"this is not a comparison of coaches ({error!r})",
            place=str(path),
            hint="Give a file that `ana compare --json` wrote.",
        ) from error


def _cell_of(row: dict[str, Any]) -> Cell:
    def interval(name: str) -> Interval | None:
        return None if row[name] is None else Interval(*row[name])

    return Cell(
        world=row["world"],
        group=row["group"],
        coach=row["coach"],
        n=row["n"],
        people=row["people"],
        rescues=row["rescues"],
        rescues_interval=interval("rescues_interval"),
        minus_best_static=interval("minus_best_static"),
        minus_ana=interval("minus_ana"),
        minus_calibrated=interval("minus_calibrated"),
        minus_truth=interval("minus_truth"),
        switches=row["switches"],
        c1=row["share_c1"],
        c2=row["share_c2"],
        c3=row["share_c3"],
        lost=row["lost"],
        alignment=row["alignment"],
    )


def _calibration_of(row: dict[str, Any]) -> Calibration:
    room, person = (
        Absent("one of the two kinds did not occur") if row[name] is None else row[name]
        for name in ("room_auc", "person_auc")
    )
    tenths = tuple(Tenth(it["p"], it["known"], it["n"]) for it in row["reliability"])
    return Calibration(row["coach"], tenths, room, person)


def difference_rows(comparison: Comparison, of: Sequence[str]) -> list[Row]:
    """For each world and group, the coaches `of`: rescues, differences and switches, in words."""
    return [
        {
            "world": cell.world,
            "group": cell.group,
            "coach": cell.coach,
            "n": cell.n,
            "rescues": cell.rescues,
            "minus best static": _difference(cell.minus_best_static),
            "minus ana": _difference(cell.minus_ana),
            "minus calibrated": _difference(cell.minus_calibrated),
            "minus truth": _difference(cell.minus_truth),
            "switches": cell.switches,
        }
        for cell in comparison.cells
        if cell.coach in of
    ]


def level_shares_figure(comparison: Comparison, world: str, of: Sequence[str]) -> Captioned:
    """Shares of the mission at each level by group, one panel a coach (as in Fig. 10)."""
    with quiet_style():
        figure = Figure(figsize=(TWO_COLUMNS, 3.0))
        panels = np.ravel(figure.subplots(1, len(of), sharey=True, squeeze=False))
        for axes, coach in zip(panels, of, strict=True):
            axes.set_title(coach)
            axes.set_ylim(0, 1)
            bottom = np.zeros(len(KNOWLEDGE))
            for level in COMPLEXITY:
                heights = np.array(
                    [_level_share(comparison, world, g, coach, level) for g in KNOWLEDGE]
                )
                axes.bar(KNOWLEDGE, heights, 0.7, bottom, color=LEVEL_COLOURS[level], label=level)
                bottom = bottom + heights
        panels[0].set_ylabel("share of the mission")
        figure.legend(*panels[0].get_legend_handles_labels(), loc="outside upper right", ncols=3)
        return captioned(
            "coaches-levels",
            figure,
            f"Share of the missions at C1, C2 and C3 by group, world {world}: what Fig. 10 "
            "shows for one person of each group. See whether C3 grows and C1 shrinks from LOW to "
            "HIGH.",
            simulated=True,
        )


def _level_share(comparison: Comparison, world: str, group: str, coach: str, level: str) -> float:
    for cell in comparison.cells:
        if (cell.world, cell.group, cell.coach) == (world, group, coach):
            return {"C1": cell.c1, "C2": cell.c2, "C3": cell.c3}[level]
    return 0.0


def reliability_figure(comparison: Comparison) -> Captioned:
    """P(known) as the coaches held it, against the share of rooms truly known."""
    with quiet_style():
        figure = Figure(figsize=(ONE_COLUMN, 3.3))
        axes = figure.subplots()
        axes.plot([0, 1], [0, 1], color=INK, linewidth=0.8, linestyle=":")
        for number, one in enumerate(comparison.calibrations):
            axes.plot(
                [tenth.p for tenth in one.reliability],
                [tenth.known for tenth in one.reliability],
                color=_COLOURS[number % len(_COLOURS)],
                marker=_MARKERS[number % len(_MARKERS)],
                label=one.coach,
            )
        axes.set_xlim(0, 1)
        axes.set_ylim(0, 1)
        axes.set_xlabel("P known, when a goal's level was chosen")
        axes.set_ylabel("share truly known")
        axes.legend(loc="upper left")
        return captioned(
            "coaches-reliability",
            figure,
            "On the dotted line a coach would be right about what people know: above it, people "
            "know more than it thinks.",
            simulated=True,
        )


def switches_figure(comparison: Comparison, world: str) -> Captioned:
    """Rescues against switches of every adaptive coach, by group."""
    with quiet_style():
        figure, panels = _switch_panels(comparison, world)
        for axes, cells in panels:
            _mark(axes, cells, _MARKERS)
        _name_coaches(figure)
        return captioned(
            "coaches-switches",
            figure,
            f"Rescued victims against switches of level, world {world}: switching is worth "
            "something only where it saves somebody.",
            simulated=True,
        )


def switching_figure(comparison: Comparison, world: str) -> Captioned:
    """The curve of rescues against switches of `knowledge`, by what a switch must save, beside the
    other coaches."""
    varied = {c.coach: c.switches for c in comparison.cells if _must_save(c.coach)}
    values = [_must_save(coach) for coach in sorted(varied, key=varied.__getitem__)]
    with quiet_style():
        figure, panels = _switch_panels(comparison, world)
        for axes, cells in panels:
            curve = sorted((c for c in cells if _must_save(c.coach)), key=lambda c: c.switches)
            axes.errorbar(
                [cell.switches for cell in curve],
                [cell.rescues for cell in curve],
                [_half(cell.rescues_interval) for cell in curve],
                color=INK,
                marker=_MARKERS[0],
                label="knowledge",
            )
            for cell in (c for c in curve if _must_save(c.coach) in TOLD):
                axes.annotate(
                    _must_save(cell.coach),
                    (cell.switches, cell.rescues),
                    xytext=(cell.switches, 0.02),
                    textcoords=axes.get_xaxis_transform(),
                    arrowprops={"arrowstyle": "-", "linewidth": 0.5, "linestyle": ":"},
                    ha="center",
                    va="bottom",
                    fontsize=7,
                )
            _mark(axes, [c for c in cells if not _must_save(c.coach)], _MARKERS[1:])
        low, high = panels[0][0].get_ylim()
        panels[0][0].set_ylim(low - 0.12 * (high - low), high)  # for the labels, below all points
        _name_coaches(figure)
        return captioned(
            "coaches-switching",
            figure,
            f"Rescued victims against switches of level, world {world}, with 95% intervals. The "
            "points of `knowledge` differ in how many seconds it must expect to save by another "
            f"level before it changes: {', '.join(values)}, from left to right.",
            simulated=True,
        )


def _switch_panels(
    comparison: Comparison, world: str
) -> tuple[Figure, list[tuple[Axes, list[Cell]]]]:
    """A figure with a panel of rescues against switches for each group, and the group's coaches."""
    figure = Figure(figsize=(TWO_COLUMNS, 3.4), layout="constrained")
    panels = np.ravel(figure.subplots(1, len(KNOWLEDGE), sharey=True, squeeze=False))
    panels[0].set_ylabel("rescued victims")
    found = []
    for axes, group in zip(panels, KNOWLEDGE, strict=True):
        axes.set_title(group)
        axes.set_xlabel("switches a mission")
        cells = [c for c in comparison.cells if (c.world, c.group) == (world, group)]
        found.append((axes, cells))
    return figure, found


def _mark(axes: Axes, cells: Sequence[Cell], markers: Sequence[str]) -> None:
    for number, cell in enumerate(cells):
        axes.plot(
            cell.switches,
            cell.rescues,
            markers[number % len(markers)],
            color=_COLOURS[number % len(_COLOURS)],
            label=cell.coach,
        )


def _name_coaches(figure: Figure) -> None:
    handles, names = figure.axes[0].get_legend_handles_labels()
    figure.legend(handles, names, loc="outside lower right", ncols=5, fontsize=7)


def _must_save(coach: str) -> str:
    """How many seconds a switch of this coach must save; empty for those that do not ask."""
    if coach == "knowledge":
        return _AS_SHIPPED
    _, said, value = coach.partition("knowledge:switch_gain_ms=")
    return f"{float(value) / 1000:g}" if said else ""


def _half(interval: Interval | None) -> float:
    return 0.0 if interval is None else interval.upper - interval.estimate


def path_rows(comparison: Comparison, kind: str) -> list[Row]:
    """How well the mean P(g* | path) tells HIGH from LOW with the coaches of a kind."""
    return [
        {"world": one.world, "coach": one.coach, "HIGH over LOW": str(one.auc)}
        for one in comparison.path_aucs
        if one.coach.startswith(kind)
    ]


def calibration_rows(comparison: Comparison) -> list[Row]:
    """The areas under the ROC curve of P known."""
    return [
        {"coach": one.coach, "rooms": one.room_auc, "people, HIGH over LOW": one.person_auc}
        for one in comparison.calibrations
    ]
