"""What other thresholds and another prior would have made of the same behaviour."""

from collections import defaultdict
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd

from analysis.pages.mission_rows import with_groups
from analysis.sources.absent import Refusal
from analysis.sources.factors import COMPLEXITY, KNOWLEDGE
from analysis.sources.frames import Floats, StudyData
from analysis.sources.recorded import Recorded
from game.tables.rejudging import (
    Asked,
    Astray,
    GoalEnd,
    Happened,
    Judged,
    Lost,
    Rule,
    levels_under,
    rule_of,
    with_prior_mass,
)


@dataclass(frozen=True)
class JudgedMission:
    """One adaptive mission as Algorithm 1 saw it; times in ms."""

    participant: str
    knowledge: str
    rule: Rule
    happened: tuple[Happened, ...]
    until_ms: int


def judged_missions(recorded: Recorded, study: StudyData) -> list[JudgedMission]:
    """The adaptive missions of the people in `study`, in the order of their names.

    Raises Refusal without adaptive missions, or for a preset whose rule needs more than
    comprehension.
    """
    rounds = with_groups(recorded.of_missions("rounds"), study)
    played = rounds[rounds["preset"].notna()]
    if played.empty:
        raise Refusal("no adaptive mission was played")
    happened = _happened(recorded)
    lasted = recorded.frame("levels").groupby(["participant", "round"], as_index=False)
    until = {
        (who, round_): int(at_ms)
        for who, round_, at_ms in lasted["until_ms"].max().itertuples(index=False)
    }
    return [
        JudgedMission(
            participant=who,
            knowledge=group,
            rule=_rule(preset),
            happened=tuple(happened.get((who, round_), ())),
            until_ms=until[who, round_],
        )
        for who, round_, group, preset in zip(
            *(played[name] for name in ("participant", "round", "knowledge", "preset")), strict=True
        )
        if (who, round_) in until
    ]


def stretches(
    mission: JudgedMission,
    *,
    lower_below: float | None = None,
    raise_above: float | None = None,
    prior_mass: float | None = None,
) -> list[tuple[str, int, int]]:
    """(level, from, until) under the mission's own rule with other thresholds or another prior.

    Raises Refusal for another prior mass where the prior was uniform.
    """
    happened, own = mission.happened, mission.rule.prior_mass
    if prior_mass is not None:
        if own is None:
            raise Refusal(f"the prior of {mission.rule.name} is uniform, and has no mass")
        happened = tuple(
            what._replace(comprehension=with_prior_mass(what.comprehension, own, prior_mass))
            if isinstance(what, Judged)
            else what
            for what in happened
        )
    rule = rule_of(mission.rule.name, lower_below=lower_below, raise_above=raise_above)
    changes = list(levels_under(rule, happened))
    ends = [*(at_ms for at_ms, _ in changes[1:]), mission.until_ms]
    return [
        (level, from_ms, until_ms)
        for (from_ms, level), until_ms in zip(changes, ends, strict=True)
        if until_ms > from_ms
    ]


def shares(mission: JudgedMission, **changes: float | None) -> Floats:
    """Shares of the mission at C1, C2 and C3; `changes` as in `stretches`."""
    spent = np.zeros(len(COMPLEXITY))
    for level, from_ms, until_ms in stretches(mission, **changes):
        spent[COMPLEXITY.index(level)] += until_ms - from_ms
    return spent / mission.until_ms


def sweep(missions: Sequence[JudgedMission], change: str, values: Sequence[float]) -> pd.DataFrame:
    """Mean shares by knowledge group (columns `knowledge`, `value`, C1, C2, C3) as one thing
    changes: `lower_below`, `raise_above` or `prior_mass`."""
    rows = []
    for value in values:
        found = np.array([shares(mission, **{change: value}) for mission in missions])
        for group in KNOWLEDGE:
            inside = [mission.knowledge == group for mission in missions]
            if any(inside):
                mean = found[inside].mean(axis=0)
                rows.append(
                    {"knowledge": group, "value": value, **dict(zip(COMPLEXITY, mean, strict=True))}
                )
    return pd.DataFrame(rows)


def _rule(name: str) -> Rule:
    try:
        return rule_of(name)
    except ValueError as error:
        raise Refusal(str(error)) from error


def _happened(recorded: Recorded) -> dict[tuple[str, int], list[Happened]]:
    """What Algorithm 1 takes account of, by mission."""
    found: dict[tuple[str, int], list[Happened]] = defaultdict(list)
    told = recorded.frame("instructions")
    for key, at_ms, _ in _timed(told[told["reason"] == "lost"], "reason"):
        found[key].append(Lost(at_ms))
    clear = recorded.frame("posteriors")
    for key, at_ms, value in _timed(clear[clear["verdict"] != "none"], "comprehension"):
        found[key].append(Judged(at_ms, float(value)))
    for key, at_ms, want in _timed(recorded.frame("asked"), "want"):
        found[key].append(Asked(at_ms, want))
    rescued = set(_rescues(recorded.frame("victims")))
    goals = {(*key, at_ms) for key, at_ms, _ in _timed(told[told["reason"] == "goal"], "reason")}
    missteps = told[told["missteps_under"] > 0].assign(at_ms=told["until_ms"])
    astray = {(*key, at_ms) for key, at_ms, _ in _timed(missteps, "reason")}
    for who, round_, at_ms in astray:
        given_up = (who, round_, at_ms) in goals
        found[who, round_].append(Astray(at_ms, given_up))
    begun = set()
    for key, at_ms, _ in _timed(told[told["reason"] == "goal"], "reason"):
        if key in begun and (*key, at_ms) not in astray:
            found[key].append(GoalEnd(at_ms, (*key, at_ms) in rescued))
        begun.add(key)
    return found


def _timed(rows: pd.DataFrame, column: str) -> Iterator[tuple[tuple[str, int], int, Any]]:
    """Mission, mission time in ms and the value of a column, for each row."""
    for who, round_, at_ms, value in zip(
        *(rows[name] for name in ("participant", "round", "at_ms", column)), strict=True
    ):
        yield (str(who), int(round_)), int(at_ms), value


def _rescues(victims: pd.DataFrame) -> Iterator[tuple[str, int, int]]:
    saved = victims[victims["fate"] == "rescued"]
    for who, round_, at_ms in zip(
        saved["participant"], saved["round"], saved["fate_ms"], strict=True
    ):
        yield str(who), int(round_), int(at_ms)
