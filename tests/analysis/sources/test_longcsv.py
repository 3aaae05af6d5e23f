"""Reading a long CSV: what is taken, and what is refused with place and hint."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from analysis.sources.absent import SourceError
from analysis.sources.frames import StudyData, both_rounds, missing_notes, paired
from analysis.sources.longcsv import read_long_csv

ReadTable = Callable[..., StudyData]


@pytest.fixture
def table(make_table: Callable[..., pd.DataFrame]) -> pd.DataFrame:
    return make_table()


def complaint(read_table: ReadTable, table: pd.DataFrame, **more: object) -> str:
    with pytest.raises(SourceError) as caught:
        read_table(table, **more)
    return str(caught.value)


def test_reads_both_tables(read_table: ReadTable, table: pd.DataFrame) -> None:
    study = read_table(table)
    assert len(study.participants) == table["participant"].nunique()
    assert len(study.rounds) == len(table)
    assert study.has("order") and study.has("building") and not study.has("quiz_static")
    assert not study.notes


def test_order_of_rows_and_columns_says_nothing(read_table: ReadTable, table: pd.DataFrame) -> None:
    straight = read_table(table)
    shuffled = read_table(table.sample(frac=1, random_state=3)[sorted(table.columns)])
    pd.testing.assert_frame_equal(
        straight.participants.sort_index(axis=1), shuffled.participants.sort_index(axis=1)
    )
    pd.testing.assert_frame_equal(
        straight.rounds.sort_index(axis=1), shuffled.rounds.sort_index(axis=1)
    )


@pytest.mark.parametrize("mark", ["", "NA", "NaN", "n/a", "."])
def test_a_missing_answer_stays_missing(
    read_table: ReadTable, table: pd.DataFrame, mark: str
) -> None:
    table = table.astype({"pref3": object, "engagement": object})
    table.loc[0, ["pref3", "engagement"]] = mark
    study = read_table(table)
    row = study.rounds.iloc[0]
    assert np.isnan(row["pref3"]) and np.isnan(row["engagement"])
    assert np.isnan(row["preference"])
    assert paired(study, "preference").n_dropped == 1
    assert paired(study, "confusion").n_dropped == 0


def test_preference_is_the_sum_of_the_items(read_table: ReadTable, table: pd.DataFrame) -> None:
    rounds = read_table(table).rounds.set_index(["participant", "adaptivity"])["preference"]
    sums = table.set_index(["participant", "adaptivity"])[["pref1", "pref2", "pref3", "pref4"]]
    pd.testing.assert_series_equal(
        rounds.sort_index(), sums.sum(axis=1).sort_index(), check_dtype=False, check_names=False
    )


def test_a_participant_may_be_called_na(read_table: ReadTable, table: pd.DataFrame) -> None:
    study = read_table(table.replace({"participant": {"P001": "NA"}}))
    assert "NA" in study.participants.index


def test_missing_column(read_table: ReadTable, table: pd.DataFrame) -> None:
    text = complaint(read_table, table.drop(columns=["pref2", "confusion"]))
    assert "line 1" in text and "'confusion'" in text and "'pref2'" in text


def test_missing_knowledge_asks_for_the_quiz(read_table: ReadTable, table: pd.DataFrame) -> None:
    assert "--quiz" in complaint(read_table, table.drop(columns="knowledge"))


def test_duplicate_row(read_table: ReadTable, table: pd.DataFrame) -> None:
    text = complaint(read_table, pd.concat([table, table.iloc[[4]]]))
    assert "P003" in text and "static" in text and "more than one row" in text


@pytest.mark.parametrize(
    ("column", "value", "words"),
    [
        ("engagement", 0, "from 1 to 100"),
        ("engagement", 101, "from 1 to 100"),
        ("frustration", 55.5, "whole"),
        ("pref1", 6, "from 1 to 5"),
        ("pref4", 0, "from 1 to 5"),
        ("victims", -1, "at least 0"),
    ],
)
def test_value_out_of_range(
    read_table: ReadTable, table: pd.DataFrame, column: str, value: float, words: str
) -> None:
    table[column] = table[column].astype(float)
    table.loc[0, column] = value
    text = complaint(read_table, table)
    assert "P001" in text and column in text and words in text


@pytest.mark.parametrize("value", ["many", "inf", "1,5"])
def test_not_a_number_names_the_line(
    read_table: ReadTable, table: pd.DataFrame, value: str
) -> None:
    table["victims"] = table["victims"].astype(object)
    table.loc[6, "victims"] = value
    text = complaint(read_table, table)
    assert "line 8" in text and "victims" in text and value in text


@pytest.mark.parametrize(
    ("column", "value"),
    [("knowledge", "low"), ("complexity", "C4"), ("adaptivity", "ana"), ("complexity", "")],
)
def test_unknown_level(read_table: ReadTable, table: pd.DataFrame, column: str, value: str) -> None:
    table.loc[table["participant"] == "P002", column] = value
    text = complaint(read_table, table)
    assert "P002" in text and column in text and "must be one of" in text


def test_a_person_has_one_level(read_table: ReadTable, table: pd.DataFrame) -> None:
    table.loc[3, "complexity"] = "C3"
    text = complaint(read_table, table)
    assert "P002" in text and "lines 4, 5" in text


def test_one_round_is_kept_and_told(read_table: ReadTable, table: pd.DataFrame) -> None:
    study = read_table(table.drop(index=1))
    every = "victims, engagement, confidence, frustration, confusion, preference"
    assert missing_notes(study) == [
        f"{every}: one round only of P001, kept by the mixed model and left out wherever both "
        "rounds are needed"
    ]
    assert "P001" not in both_rounds(study, "victims").index
    assert len(study.rounds) == len(table) - 1


def test_unused_columns_are_told(read_table: ReadTable, table: pd.DataFrame) -> None:
    assert "columns not used: mood" in read_table(table.assign(mood=3)).notes


def test_real_and_simulated_are_not_mixed(read_table: ReadTable, table: pd.DataFrame) -> None:
    assert read_table(table.assign(simulated=True)).simulated
    assert not read_table(table.assign(simulated=False)).simulated
    mixed = table.assign(simulated=table["participant"] == "P001")
    assert "apart" in complaint(read_table, mixed)


def test_empty_files(tmp_path: Path, table: pd.DataFrame) -> None:
    nothing = tmp_path / "nothing.csv"
    nothing.touch()
    header = tmp_path / "header.csv"
    table.head(0).to_csv(header, index=False)
    for path, words in ((nothing, "not a CSV"), (header, "no rows"), (tmp_path / "x", "no such")):
        with pytest.raises(SourceError, match=words):
            read_long_csv(path)


def test_quiz_scores(read_table: ReadTable, table: pd.DataFrame) -> None:
    people = list(table["participant"].unique())
    scores = {who: float(at % 12) for at, who in enumerate(people)}
    assert "line 2" in complaint(read_table, table, quiz=scores | {"P001": -1.0})
    del scores["P004"]
    study = read_table(table, quiz=scores)
    assert "no quiz score for P004" in study.notes
    assert study.participants.loc["P002", "quiz_static"] == 1.0


def test_a_note_names_who_lacks_which_outcomes(read_table: ReadTable, table: pd.DataFrame) -> None:
    table = table.astype(dict.fromkeys(("engagement", "confusion"), float))
    table.loc[[0, 1, 2], ["engagement", "confusion"]] = np.nan
    study = read_table(table)
    assert missing_notes(study) == [
        "engagement, confusion: no round of P001; one round only of P002, kept by the mixed model "
        "and left out wherever both rounds are needed"
    ]
    pair = paired(study, "engagement")
    assert pair.n_dropped == 2
