"""The whole battery on easy and hard data: nothing silent, nothing lost, refusals by name."""

import json
import warnings
from collections.abc import Callable
from dataclasses import replace
from itertools import chain
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest

from analysis.battery import BatteryResult, analyse_source, run_battery, stopped
from analysis.pages import style
from analysis.pages.figures import fig8_performance
from analysis.pages.style import FORMATS
from analysis.sources.absent import Absent, SourceError, plain
from analysis.sources.factors import LIKERT_ITEMS, MENTAL_STATES, OUTCOMES
from analysis.sources.frames import StudyData
from game.tables.exclusions import read_rules

ReadTable = Callable[..., StudyData]
MakeTable = Callable[..., pd.DataFrame]
Battery = Callable[..., tuple[BatteryResult, Any]]

CELLS = [(group, level) for group in ("LOW", "MED", "HIGH") for level in ("C1", "C2", "C3")]


@pytest.fixture
def battery(read_table: ReadTable) -> Battery:
    """Runs the battery on a table; any warning of the numerical libraries is an error."""

    def run(table: pd.DataFrame, **more: object) -> tuple[BatteryResult, Any]:
        with warnings.catch_warnings():
            warnings.simplefilter("error", RuntimeWarning)
            result = run_battery(read_table(table, **more), read_rules())
        return result, json.loads(result.to_json())

    return run


@pytest.fixture
def table(make_table: MakeTable) -> pd.DataFrame:
    answers = dict.fromkeys((*MENTAL_STATES, *LIKERT_ITEMS), float)
    return make_table().drop(columns="disobeyed").astype(answers)


def nulls(node: Any, path: str = "") -> list[str]:
    if node is None:
        return [path]
    if isinstance(node, dict):
        return [p for k, v in node.items() for p in nulls(v, f"{path}.{k}" if path else k)]
    if isinstance(node, list):
        return [p for i, v in enumerate(node) for p in nulls(v, f"{path}[{i}]")]
    return []


def reasons(numbers: Any) -> dict[str, str]:
    return {path: entry["reason"] for entry in numbers["absent"] for path in entry["paths"]}


def test_plain_data_have_no_problem(battery: Battery, table: pd.DataFrame) -> None:
    result, numbers = battery(table)
    assert result.exit_status == 0 and result.problems == ()
    assert set(numbers["outcomes"]) == set(OUTCOMES)
    assert numbers["source"]["n_analysed"] == table["participant"].nunique()
    assert all(len(numbers["outcomes"][y]["anova"]) == 8 for y in OUTCOMES)
    text = result.table()
    assert "knowledge:complexity:adaptivity" in text and max(map(len, text.splitlines())) < 120


def test_same_rows_in_another_order_give_the_same_bytes(
    battery: Battery, table: pd.DataFrame
) -> None:
    straight, _ = battery(table)
    shuffled, _ = battery(table.sample(frac=1, random_state=5))
    assert straight.to_json() == shuffled.to_json()


def empty_cell(table: pd.DataFrame) -> pd.DataFrame:
    return table[~((table["knowledge"] == "HIGH") & (table["complexity"] == "C2"))]


def holes(table: pd.DataFrame) -> pd.DataFrame:
    gone = np.random.default_rng(0).random(len(table)) < 0.15
    table.loc[gone, [*MENTAL_STATES, *LIKERT_ITEMS]] = np.nan
    return table


def ceiling(table: pd.DataFrame) -> pd.DataFrame:
    return table.assign(victims=20)


def ceiling_of_one_group(table: pd.DataFrame) -> pd.DataFrame:
    return table.assign(victims=table["victims"].where(table["knowledge"] != "HIGH", 20))


def no_answers(table: pd.DataFrame) -> pd.DataFrame:
    table[[*MENTAL_STATES, *LIKERT_ITEMS]] = np.nan
    return table


def one_round_only(table: pd.DataFrame) -> pd.DataFrame:
    return table[table["adaptivity"] == "static"]


def one_person(table: pd.DataFrame) -> pd.DataFrame:
    return table.head(2)


def nobody_changes(table: pd.DataFrame) -> pd.DataFrame:
    for column in MENTAL_STATES:
        table[column] = table.groupby("participant")[column].transform("first")
    return table


def same_likert(table: pd.DataFrame) -> pd.DataFrame:
    return table.assign(**dict.fromkeys(LIKERT_ITEMS, 3))


HARD = {
    empty_cell: OUTCOMES,
    holes: (),
    ceiling: ("victims",),
    ceiling_of_one_group: (),
    no_answers: OUTCOMES[1:],
    one_round_only: OUTCOMES,
    one_person: OUTCOMES,
    nobody_changes: MENTAL_STATES,
    same_likert: ("preference",),
}


@pytest.mark.parametrize(("damage", "lost"), HARD.items(), ids=[f.__name__ for f in HARD])
def test_hard_data_come_out_or_are_refused_by_name(
    battery: Battery,
    table: pd.DataFrame,
    damage: Callable[[pd.DataFrame], pd.DataFrame],
    lost: tuple[str, ...],
) -> None:
    result, numbers = battery(damage(table))
    named = [problem.partition(":")[0].split(", ") for problem in result.problems]
    assert sorted(chain.from_iterable(named)) == sorted(lost)
    assert result.exit_status == (2 if lost else 0)
    assert {y for y in OUTCOMES if numbers["outcomes"][y]["anova"] is None} == set(lost)
    assert set(nulls(numbers)) == set(reasons(numbers))
    assert all(reasons(numbers).values())
    assert result.table()


def test_an_empty_cell_stops_the_anova_alone(battery: Battery, table: pd.DataFrame) -> None:
    result, numbers = battery(empty_cell(table))
    assert all("HIGH C2" in problem for problem in result.problems)
    rows = numbers["outcomes"]["engagement"]
    within = rows["posthoc_complexity_within_knowledge_by_round"]
    assert sum(row["p_holm"] is None for row in within) == 4
    assert sum(row["p_holm"] is not None for row in within) == 14
    assert rows["paired"]["t"] is not None
    assert rows["lmm"]["var_resid"] > 0
    assert rows["assumptions"]["levene_median"]["diff"]["df1"] == 7
    assert numbers["alpha"]["all"]["listwise"] is not None
    assert numbers["holm_across_mental_states"]["adaptivity"]["confusion"] is None


def test_an_outcome_may_lose_a_cell_alone(battery: Battery, table: pd.DataFrame) -> None:
    inside = (table["knowledge"] == "LOW") & (table["complexity"] == "C3")
    table.loc[inside & (table["adaptivity"] == "adaptive"), "confusion"] = np.nan
    result, numbers = battery(table)
    assert result.problems == (
        "confusion: the ANOVA is left out: empty analysis cell (knowledge x complexity): LOW C3",
    )
    holm = numbers["holm_across_mental_states"]["knowledge"]
    p = {y: numbers["outcomes"][y]["anova"][1]["p"] for y in MENTAL_STATES[:3]}
    assert min(holm[y] for y in p) == pytest.approx(min(1, 3 * min(p.values())))


def test_one_reason_is_told_once_and_none_for_a_test_that_the_design_has_not(
    study: StudyData,
) -> None:
    reason = Absent("there is nobody")
    anovas: dict[str, Any] = dict.fromkeys(("victims", "confusion"), reason) | {"engagement": []}
    told = ["victims, confusion: the ANOVAs are left out: there is nobody"]
    assert stopped(study, reason, anovas) == [*told]
    one_round = replace(study, crossed=replace(study.crossed, rounds=1))
    assert stopped(one_round, reason, anovas) == []


@pytest.mark.parametrize("size", [1, 2])
def test_small_cells_come_out(battery: Battery, make_table: MakeTable, size: int) -> None:
    sizes = dict.fromkeys(CELLS, 6) | {CELLS[0]: size, CELLS[4]: size}
    result, numbers = battery(make_table(sizes).drop(columns="disobeyed"))
    assert result.problems == ()
    row = numbers["outcomes"]["victims"]["anova"][7]
    assert row["df2"] == 7 * 6 + 2 * size - 9 and 0 < row["p"] <= 1
    assert numbers["outcomes"]["victims"]["cells"][0]["n"] == size
    assert (numbers["outcomes"]["victims"]["cells"][0]["sd"] is None) == (size == 1)


def test_missing_answers_are_not_zeros(battery: Battery, table: pd.DataFrame) -> None:
    table.loc[table["participant"] == "P001", "pref2"] = np.nan
    _, numbers = battery(table)
    preference = numbers["outcomes"]["preference"]
    assert preference["n_dropped"] == 1
    assert preference["cells"][0]["n"] == 4
    assert numbers["alpha"]["all"]["rows_any"] == numbers["alpha"]["all"]["rows_complete"] + 2


def scores_of(table: pd.DataFrame) -> dict[str, float]:
    return {who: float(at * 7 % 21) for at, who in enumerate(table["participant"].unique())}


def test_groups_are_formed_from_the_scores(battery: Battery, table: pd.DataFrame) -> None:
    scores = scores_of(table)
    result, numbers = battery(table.drop(columns="knowledge"), quiz=scores)
    assert numbers["source"]["groups"] == "formed from quiz_static"
    stated = result.study.participants["knowledge"].to_dict()
    assert stated == numbers["clustering"]["labels"]
    assert numbers["sensitivity"]["continuous_score"]["victims"] is not None


def test_stated_groups_are_kept_and_a_difference_is_told(
    battery: Battery, table: pd.DataFrame
) -> None:
    result, numbers = battery(table, quiz=scores_of(table))
    stated = table.drop_duplicates("participant").set_index("participant")["knowledge"].to_dict()
    assert result.study.participants["knowledge"].to_dict() == stated
    moved = {who for who, group in numbers["clustering"]["labels"].items() if group != stated[who]}
    note = next(note for note in result.notes if "another" in note)
    assert f"{len(moved)} of {len(stated)}" in note and all(who in note for who in moved)


@pytest.mark.parametrize("stated", [True, False])
def test_one_score_for_all_is_a_problem(
    battery: Battery, table: pd.DataFrame, stated: bool
) -> None:
    scores = dict.fromkeys(scores_of(table), 7.0)
    result, numbers = battery(table if stated else table.drop(columns="knowledge"), quiz=scores)
    assert result.exit_status == 2 and "1 distinct quiz score" in result.problems[0]
    assert numbers["clustering"] is None
    assert (numbers["outcomes"]["victims"]["anova"] is not None) == stated
    assert numbers["outcomes"]["victims"]["paired"]["t"] is not None


def test_a_tie_of_the_scores_is_noted_with_the_other_groupings_anovas(
    battery: Battery, table: pd.DataFrame
) -> None:
    people = table["participant"].unique()
    scores = {who: float(at % 4) for at, who in enumerate(people)}
    result, numbers = battery(table.drop(columns="knowledge"), quiz=scores)
    assert any("equally well" in note for note in result.notes)
    others = numbers["sensitivity"]["other_groupings"]
    assert [(row["max_low"], row["max_med"]) for row in others] == [(0, 2), (1, 2)]
    regrouped = {who: "LOW" if score <= 1 else "MED" if score <= 2 else "HIGH"
                 for who, score in scores.items()}  # fmt: skip
    stated = table.assign(knowledge=table["participant"].map(regrouped))
    _, direct = battery(stated)
    main = {row["effect"]: row["F"] for row in direct["outcomes"]["victims"]["anova"]}
    ours = {row["effect"]: row["F"] for row in others[1]["results"]["victims"]}
    assert ours == pytest.approx(main)
    assert numbers["clustering"]["labels"] == {
        who: "LOW" if score < 1 else "MED" if score < 2 else "HIGH" for who, score in scores.items()
    }


def test_why_three_tests_of_adaptivity_differ_is_said_once(
    battery: Battery, make_table: MakeTable
) -> None:
    table = make_table(dict.fromkeys(CELLS, 5) | {CELLS[0]: 60}).drop(columns="disobeyed")
    big = (table["knowledge"] == "LOW") & (table["complexity"] == "C1")
    adaptive = table["adaptivity"] == "adaptive"
    for outcome in MENTAL_STATES[:2]:
        table[outcome] = np.clip(table[outcome] + np.where(big, -6, 4) * adaptive, 1, 100)
    result, numbers = battery(table)
    told = [note for note in result.notes if "count the nine cells equally" in note]
    assert len(told) == 1 and "engagement (ANOVA p < .001" in told[0]
    rows = {row["test"]: row for row in numbers["outcomes"]["engagement"]["adaptivity_tests"]}
    anova = numbers["outcomes"]["engagement"]["anova"][4]
    assert anova["effect"] == "adaptivity" and rows["ANOVA"]["p"] == pytest.approx(anova["p"])
    assert rows["HC3"]["p"] == numbers["outcomes"]["engagement"]["hc3_diff"][0]["p"]
    assert rows["paired t"]["p"] == numbers["outcomes"]["engagement"]["paired"]["p"]
    assert rows["ANOVA"]["estimate"] > rows["paired t"]["estimate"]


def test_exclusions_are_applied_and_everybody_shown(
    battery: Battery, make_table: MakeTable
) -> None:
    table = make_table()
    result, numbers = battery(table)
    over = table.drop_duplicates("participant").set_index("participant")["disobeyed"] > 5
    assert numbers["source"]["n_randomised"] == len(over)
    assert numbers["source"]["n_analysed"] == int((~over).sum())
    assert set(result.study.participants.index) == set(over.index[~over])
    everybody, primary, other = numbers["sensitivity"]["exclusions"]
    assert everybody["n_kept"] == len(over) and primary["n_excluded"] == int(over.sum())
    assert other["results"] is None
    assert sum(row["excluded"] for row in primary["by_design_cell"]) == int(over.sum())
    assert sum(row["randomised"] for row in primary["by_design_cell"]) == len(over)
    main = [row["F"] for row in numbers["outcomes"]["confusion"]["anova"]]
    assert [row["F"] for row in primary["results"]["confusion"]] == main
    assert [row["F"] for row in everybody["results"]["confusion"]] != main


def test_simulated_people_are_labelled(battery: Battery, table: pd.DataFrame) -> None:
    result, numbers = battery(table.assign(simulated="yes"))
    assert numbers["source"]["simulated"] is True
    assert "SIMULATED" in result.table().splitlines()[0]
    drawn = fig8_performance(result.study)
    assert drawn.caption.startswith("SIMULATED PEOPLE")
    assert "SIMULATED PEOPLE" in [text.get_text() for text in drawn.figure.texts]


def test_a_number_without_a_reason_is_never_written() -> None:
    with pytest.raises(ValueError, match=r"a\.b\[1\]"):
        plain({"a": {"b": [1.0, float("nan")]}})
    assert plain({"a": [Absent("why"), 2]}) == ({"a": [None, 2]}, {"a[0]": "why"})


def test_from_file_to_figures(
    tmp_path: Path, table: pd.DataFrame, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(style, "FORMATS", {"svg": FORMATS["svg"]})  # the others: test_figures
    source = tmp_path / "long.csv"
    table.to_csv(source, index=False)
    result = analyse_source(source, figures=tmp_path / "figures")
    drawn = {path.name for path in (tmp_path / "figures").glob("*.svg")}
    assert drawn == {
        "fig7_mental_states.svg",
        "fig8_performance.svg",
        "fig9_engagement.svg",
        "adaptivity_estimates.svg",
        *(f"cells_{outcome}.svg" for outcome in OUTCOMES),
    }
    captions = (tmp_path / "figures" / "captions.txt").read_text(encoding="utf-8")
    assert all(f"\n{captions}".count(f"\n{name.removesuffix('.svg')}\n") == 1 for name in drawn)
    assert result.exit_status == 0


def test_a_source_that_is_not_there(tmp_path: Path) -> None:
    for source in (tmp_path / "none.csv", tmp_path):
        with pytest.raises(SourceError):
            analyse_source(source)
