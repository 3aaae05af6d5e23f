"""The sample for other programs comes back as it was, and R's main tests of it are ours."""

import shutil
import subprocess
from collections.abc import Callable
from pathlib import Path

import pandas as pd
import pytest

from analysis.pages.other_programs import wide_csv, write_for_other_programs
from analysis.sources.factors import MENTAL_STATES, OUTCOMES
from analysis.sources.frames import StudyData, both_rounds, paired
from analysis.sources.longcsv import read_described_table, read_long_csv
from analysis.stats.anova import mixed_anova

ReadTable = Callable[..., StudyData]
MakeTable = Callable[..., pd.DataFrame]
REFERENCE = Path(__file__).resolve().parents[2] / "reference"


def test_the_wide_table_is_read_back_as_the_same_study(
    read_table: ReadTable, make_table: MakeTable, tmp_path: Path
) -> None:
    table = make_table().drop(columns="disobeyed").astype(dict.fromkeys(MENTAL_STATES, float))
    table.loc[3, "engagement"] = None
    study = read_table(table)
    path = tmp_path / "wide.csv"
    path.write_text(wide_csv(study), encoding="utf-8")
    again = read_long_csv(path)
    for outcome in OUTCOMES:
        pd.testing.assert_frame_equal(both_rounds(again, outcome), both_rounds(study, outcome))
    same = ["knowledge", "complexity", "order", "preferred_instructor"]
    pd.testing.assert_frame_equal(again.participants[same], study.participants[same])


TABLE, TOML = (REFERENCE / f"obrien_kaiser.{kind}" for kind in ("csv", "toml"))


@pytest.mark.skipif(shutil.which("Rscript") is None, reason="R is not installed")
def test_r_gives_the_same_main_tests(study: StudyData, tmp_path: Path) -> None:
    assert_r_agrees(study, tmp_path)


@pytest.mark.skipif(shutil.which("Rscript") is None, reason="R is not installed")
def test_r_gives_the_same_main_tests_with_two_levels(tmp_path: Path) -> None:
    assert_r_agrees(read_described_table(TABLE, TOML), tmp_path)


@pytest.mark.skipif(shutil.which("Rscript") is None, reason="R is not installed")
def test_the_script_says_where_there_is_no_test(study: StudyData, tmp_path: Path) -> None:
    people = study.participants
    emptied = people.index[(people["knowledge"] == "LOW") & (people["complexity"] == "C1")]
    write_for_other_programs(study.without(emptied), tmp_path)
    command = ["Rscript", "main_tests.R"]
    run = subprocess.run(command, cwd=tmp_path, check=True, capture_output=True, timeout=120)
    assert b"has nobody in it" in run.stdout


def assert_r_agrees(study: StudyData, tmp_path: Path) -> None:
    write_for_other_programs(study, tmp_path)
    command = ["Rscript", "main_tests.R", "out.csv"]
    subprocess.run(command, cwd=tmp_path, check=True, capture_output=True, timeout=120)
    rows = pd.read_csv(tmp_path / "out.csv").to_dict("records")
    theirs = {(row["outcome"], row["effect"]): row for row in rows}
    assert len(theirs) == 8 * len(study.outcomes)
    for outcome in study.outcomes:
        pair = paired(study, outcome)
        for effect in mixed_anova(pair):
            row = theirs[outcome, effect.effect]
            assert row["n"] == len(pair.participants)
            assert row["F"] == pytest.approx(effect.test.F, rel=1e-8)
            assert row["p"] == pytest.approx(effect.test.p, rel=1e-6)
            assert row["partial_eta2"] == pytest.approx(effect.test.pes, rel=1e-8)
