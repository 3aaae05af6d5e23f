"""Coaches compared on the same people: means, and differences taken person by person.

Groups are formed by what a person truly knew before the mission. All intervals are 95% t intervals
over people (over worlds where many were drawn at random): the missions of one person, in several
buildings, are averaged first, because they are not independent.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import pandas as pd
from scipy import stats

from analysis.sources.absent import Absent, Refusal, Row, attempt
from analysis.sources.factors import KNOWLEDGE
from analysis.sources.frames import Floats
from analysis.stats.intervals import Interval, auc, auc_interval

LOW_UP_TO, MED_UP_TO = 0.40, 0.65
"""The groups: LOW knows up to .40 of the rooms, MED up to .65, HIGH more."""
LEVEL = 0.95
STATIC = "static:"
ANA = "ana"
TRUTH = "truth"
BINS = 10


@dataclass(frozen=True)
class Cell:
    """One coach with one group of one world. `n` counts missions, `people` the units of the
    intervals. An interval is None for a single unit, and a difference also where its other side was
    not compared.
    """

    world: str
    group: str
    coach: str
    n: int
    people: int
    rescues: float
    rescues_interval: Interval | None
    minus_best_static: Interval | None
    minus_ana: Interval | None
    minus_calibrated: Interval | None
    minus_truth: Interval | None
    switches: float
    c1: float
    c2: float
    c3: float
    lost: float
    alignment: float


@dataclass(frozen=True)
class Tenth:
    """The choices with P(known) in one tenth: the mean P, the share truly known, and how many."""

    p: float
    known: float
    n: int


@dataclass(frozen=True)
class Calibration:
    """How well a coach's P(known) tells what people know: its reliability, and the areas under the
    ROC curve that tell known rooms from unknown ones, and HIGH people from LOW ones."""

    coach: str
    reliability: tuple[Tenth, ...]
    room_auc: float | Absent
    person_auc: float | Absent


@dataclass(frozen=True)
class PathAuc:
    """How often the mean P(g* | path) of a HIGH person's mission is above that of a LOW one's."""

    world: str
    coach: str
    auc: Interval


@dataclass(frozen=True)
class Comparison:
    """`best_static` is the static coach with the most rescues, by world and group."""

    cells: tuple[Cell, ...]
    path_aucs: tuple[PathAuc, ...]
    best_static: dict[tuple[str, str], str]
    calibrations: tuple[Calibration, ...]


def with_knowledge_groups(trials: pd.DataFrame) -> pd.DataFrame:
    """The trials with their knowledge group in the column `group`."""
    edges = [-np.inf, LOW_UP_TO, MED_UP_TO, np.inf]
    groups = pd.cut(trials["known"].round(9), edges, labels=list(KNOWLEDGE))
    return trials.assign(group=groups.astype(str))


def compared(trials: pd.DataFrame, unit: str = "person") -> Comparison:
    """Compare the coaches in `trials`: one row a trial, with the columns of
    `game.simulation.comparison.Trial`. `unit` names the column of the independent units: `person`,
    or `draw` where many worlds were drawn."""
    trials = with_knowledge_groups(trials)
    cells: list[Cell] = []
    best_static: dict[tuple[str, str], str] = {}
    coaches = list(dict.fromkeys(trials["coach"]))
    for world in dict.fromkeys(trials["world"]):
        for group in KNOWLEDGE:
            rows = trials[(trials["world"] == world) & (trials["group"] == group)]
            if rows.empty:
                continue
            means = _means(rows, "rescues", unit)
            best = _best_static(means, coaches)
            if best is not None:
                best_static[world, group] = best
            cells += [_cell(rows, means, unit, coach, best) for coach in coaches]
    paths = _path_aucs(trials, coaches)
    return Comparison(tuple(cells), paths, best_static, _calibrations(trials, coaches))


def t_interval(values: Floats) -> Interval | None:
    """The mean of independent values with its 95% t interval; None for fewer than two."""
    if len(values) < 2:
        return None
    mean = float(values.mean())
    half = float(stats.sem(values) * stats.t.ppf((1 + LEVEL) / 2, len(values) - 1))
    return Interval(mean, mean - half, mean + half)


def _means(rows: pd.DataFrame, column: str, unit: str) -> pd.DataFrame:
    """Mean of a column, one row a unit and one column a coach."""
    return rows.pivot_table(index=unit, columns="coach", values=column, aggfunc="mean")


def _best_static(means: pd.DataFrame, coaches: Sequence[str]) -> str | None:
    static = [coach for coach in coaches if coach.startswith(STATIC)]
    return max(static, key=lambda coach: float(means[coach].to_numpy().mean()), default=None)


def _cell(rows: pd.DataFrame, means: pd.DataFrame, unit: str, coach: str, best: str | None) -> Cell:
    own = rows[rows["coach"] == coach]

    def minus(other: str | None) -> Interval | None:
        if other is None or other not in means:
            return None
        return t_interval((means[coach] - means[other]).to_numpy(dtype=float))

    def mean(column: str) -> float:
        return float(_means(own, column, unit)[coach].mean())

    return Cell(
        world=str(own["world"].iloc[0]),
        group=str(own["group"].iloc[0]),
        coach=coach,
        n=len(own),
        people=len(means),
        rescues=mean("rescues"),
        rescues_interval=t_interval(means[coach].to_numpy(dtype=float)),
        minus_best_static=minus(best),
        minus_ana=minus(ANA),
        minus_calibrated=minus(f"{ANA}:calibrated"),
        minus_truth=minus(TRUTH),
        switches=mean("switches"),
        c1=mean("c1"),
        c2=mean("c2"),
        c3=mean("c3"),
        lost=mean("lost"),
        alignment=mean("alignment"),
    )


def _path_aucs(trials: pd.DataFrame, coaches: Sequence[str]) -> tuple[PathAuc, ...]:
    found = []
    for world in dict.fromkeys(trials["world"]):
        for coach in coaches:
            own = trials[(trials["world"] == world) & (trials["coach"] == coach)]
            own = own.dropna(subset=["comprehension"])
            high, low = (
                own[own["group"] == group]["comprehension"].to_numpy(dtype=float)
                for group in ("HIGH", "LOW")
            )
            if len(high) > 1 and len(low) > 1:
                found.append(PathAuc(str(world), coach, auc_interval(high, low)))
    return tuple(found)


def _calibrations(trials: pd.DataFrame, coaches: Sequence[str]) -> tuple[Calibration, ...]:
    found = []
    for coach in coaches:
        own = trials[trials["coach"] == coach]
        goals = [pair for pairs in own["goals"] for pair in pairs]
        if not goals or coach == TRUTH:
            continue
        rooms = [pair for pairs in own["rooms"] for pair in pairs]
        shares = {group: _shares(own, group) for group in ("HIGH", "LOW")}
        found.append(
            Calibration(
                coach,
                reliability(goals),
                attempt(_auc, [p for p, yes in rooms if yes], [p for p, yes in rooms if not yes]),
                attempt(_auc, shares["HIGH"], shares["LOW"]),
            )
        )
    return tuple(found)


def reliability(pairs: Sequence[tuple[float, bool]]) -> tuple[Tenth, ...]:
    """The tenths of P that occur, from the lowest on."""
    p, known = (np.asarray(side, dtype=float) for side in zip(*pairs, strict=True))
    tenths = np.minimum(BINS - 1, (p * BINS).astype(int))
    return tuple(
        Tenth(float(p[there].mean()), float(known[there].mean()), int(there.sum()))
        for tenth in range(BINS)
        if (there := tenths == tenth).any()
    )


def _shares(rows: pd.DataFrame, group: str) -> list[float]:
    return [float(share) for share in rows[rows["group"] == group]["share"].dropna()]


def _auc(ones: Sequence[float], others: Sequence[float]) -> float:
    if not ones or not others:
        raise Refusal("one of the two kinds did not occur")
    return auc(np.asarray(ones), np.asarray(others))


def cell_row(cell: Cell) -> Row:
    """A cell as it is written to JSON: differences as [mean, low, high]."""

    def triple(interval: Interval | None) -> list[float] | Absent:
        if interval is None:
            return Absent("one person alone, or nobody to compare with")
        return [interval.estimate, interval.lower, interval.upper]

    return {
        "world": cell.world,
        "group": cell.group,
        "coach": cell.coach,
        "n": cell.n,
        "people": cell.people,
        "rescues": cell.rescues,
        "rescues_interval": triple(cell.rescues_interval),
        "minus_best_static": triple(cell.minus_best_static),
        "minus_ana": triple(cell.minus_ana),
        "minus_calibrated": triple(cell.minus_calibrated),
        "minus_truth": triple(cell.minus_truth),
        "switches": cell.switches,
        "share_c1": cell.c1,
        "share_c2": cell.c2,
        "share_c3": cell.c3,
        "lost": cell.lost,
        "alignment": cell.alignment,
    }
