"""What came of the coach's evaluations, and who stands for a group, on made-up missions."""

import pandas as pd
import pytest

from analysis.pages.coach_inside import calibration_rows, evaluations, verdict_rows
from analysis.pages.traces import illustrative
from analysis.sources.absent import Refusal
from analysis.sources.frames import StudyData
from analysis.sources.recorded import Recorded
from tests.analysis.stats.test_intervals import published

GROUPS = {"a": "LOW", "b": "HIGH"}


def study() -> StudyData:
    people = pd.DataFrame({"knowledge": GROUPS, "complexity": "C1"})
    return StudyData(people, pd.DataFrame({"participant": []}), "made up", simulated=True)


def recorded() -> Recorded:
    mission = {"participant": "a", "round": 1}
    other = {"participant": "b", "round": 2}
    evaluated = [
        {**mission, "at_ms": 1000, "goal": "v1", "verdict": "raise", "comprehension": 0.95},
        {**mission, "at_ms": 5000, "goal": "v2", "verdict": "lower", "comprehension": 0.05},
        {**mission, "at_ms": 9000, "goal": "v3", "verdict": "keep", "comprehension": 0.55},
        {**other, "at_ms": 2000, "goal": "v1", "verdict": "none", "comprehension": 0.5},
        {**other, "at_ms": 3000, "goal": "v1", "verdict": "raise", "comprehension": 0.9},
    ]
    fates = {"v1": ("Attic", 4000.0), "v2": ("Attic", None), "v3": (None, 8000.0)}
    victims = [
        {**who, "victim": name, "room": room, "fate": fate(at_ms), "fate_ms": at_ms}
        for who in (mission, other)
        for name, (room, at_ms) in fates.items()
    ]
    told = [
        {**mission, "at_ms": 14_000, "reason": "misstep"},
        {**mission, "at_ms": 1500, "reason": "completed"},
        {**other, "at_ms": 13_001, "reason": "misstep"},
    ]
    frames = {
        "posteriors": pd.DataFrame(evaluated),
        "victims": pd.DataFrame(victims),
        "instructions": pd.DataFrame(told),
        "rounds": pd.DataFrame([{**mission, "victims": 1.0}, {**other, "victims": 1.0}]),
    }
    return Recorded(frames, "made up", simulated=True)


def fate(at_ms: float | None) -> str:
    return "waiting" if at_ms is None else "rescued"


def test_what_came_of_each_evaluation() -> None:
    table = evaluations(recorded(), study())
    assert list(table["at_ms"]) == [1000, 5000, 9000, 3000]
    assert table["came_true"].tolist()[:2] == [1.0, 0.0]
    assert pd.isna(table["came_true"][2])
    assert table["came_true"][3] == 1.0
    assert table["no_misstep"].tolist() == [1.0, 0.0, 0.0, 1.0]
    assert table["knowledge"].tolist() == ["LOW"] * 3 + ["HIGH"]


def test_shares_by_tenths_and_by_group() -> None:
    table = evaluations(recorded(), study())
    tenths = calibration_rows(table, "came_true")
    assert [(row["from"], row["evaluations"], row["share"]) for row in tenths] == [
        (0.0, 1, 0.0),
        (0.9, 2, 1.0),
    ]
    low, high = verdict_rows(table)
    assert low["raise"] == low["lower"] == low["keep"] == pytest.approx(1 / 3)
    assert high["raise"] == 1


def test_nothing_to_evaluate_is_refused() -> None:
    silent = recorded()
    frames = {**silent.frames, "posteriors": silent.frame("posteriors").query("verdict == 'none'")}
    with pytest.raises(Refusal, match="no evaluation"):
        evaluations(Recorded(frames, "made up", simulated=True), study())


def test_the_person_nearest_the_mean_stands_for_a_group() -> None:
    missions = published().assign(
        complexity="C1",
        round=(published()["adaptivity"] == "adaptive") + 1,
        building="x",
        order="static_first",
        switches=1,
        missteps=0,
        disobeyed_in_round=0,
    )
    people = missions.drop_duplicates("participant").set_index("participant")
    everybody = StudyData(people[["knowledge", "complexity"]], missions, "made up", simulated=True)
    source = Recorded({"rounds": missions.drop(columns="knowledge")}, "made up", simulated=True)
    chosen = illustrative(source, everybody)
    assert list(chosen) == ["LOW", "MED", "HIGH"]
    for group, who in chosen.items():
        own = missions[(missions["knowledge"] == group) & (missions["adaptivity"] == "adaptive")]
        away = (own.set_index("participant")["share_c1"] - own["share_c1"].mean()).abs()
        assert away[who] == away.min()
