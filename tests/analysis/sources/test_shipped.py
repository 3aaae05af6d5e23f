"""The shipped simulated study is what its README says, and effects that were planted are found."""

from pathlib import Path

import pandas as pd
import pytest

from analysis.battery import alignment_rows, holm_across
from analysis.sources.factors import MENTAL_STATES
from analysis.sources.frames import paired
from analysis.sources.recorded import ANALYSED, Recorded
from analysis.sources.study_folder import read_study_folder
from analysis.sources.tables_folder import read_tables
from analysis.stats.anova import THREE_WAY, mixed_anova
from analysis.stats.groups import grouped
from analysis.stats.posthoc import RoundModels
from tests.analysis.simulated import SEED, SHIPPED, first_of_the_shipped

ALPHA = 0.05


@pytest.fixture(scope="module")
def shipped() -> Recorded:
    return read_tables(SHIPPED)


def test_it_is_whole_and_labelled(shipped: Recorded) -> None:
    study = shipped.study()
    assert study.simulated
    assert len(study.participants) == 108
    assert study.participants["order"].value_counts().to_dict() == {
        "static_first": 54,
        "adaptive_first": 54,
    }
    assert set(study.participants["complexity"].value_counts()) == {36}
    readme = (SHIPPED / "README.md").read_text(encoding="utf-8")
    assert "simulated" in readme.lower()
    assert f"--participants 108 --seed {SEED}" in readme


def test_a_part_of_it_simulated_again_is_the_same(shipped: Recorded, tmp_path: Path) -> None:
    first_of_the_shipped(tmp_path / "study", 2)
    again = read_study_folder(tmp_path / "study", check=False)
    for name in ANALYSED:
        rows = shipped.frame(name)
        part = rows[rows["participant"].isin(["S0001", "S0002"])].reset_index(drop=True)
        pd.testing.assert_frame_equal(part, again.frame(name), check_dtype=False)


def adjusted_three_way(recorded: Recorded) -> list[float]:
    study, _ = grouped(recorded.study())
    anovas = {state: mixed_anova(paired(study, state)) for state in MENTAL_STATES}
    adjusted = holm_across(anovas)[THREE_WAY]
    return [p for p in adjusted.values() if isinstance(p, float)]


def test_the_planted_alignment_effect_is_recovered(shipped: Recorded) -> None:
    study, _ = grouped(shipped.study())
    static = {
        state: next(
            row
            for row in alignment_rows(RoundModels.of(paired(study, state)))
            if row["of"] == "static"
        )
        for state in MENTAL_STATES
    }
    signs = {"engagement": 1, "confidence": 1, "frustration": -1, "confusion": -1}
    for state, sign in signs.items():
        estimate, p = static[state]["estimate"], static[state]["p.value"]
        assert isinstance(estimate, float) and isinstance(p, float)
        assert sign * estimate > 0, state
        assert p < ALPHA, state
    assert min(adjusted_three_way(shipped)) < ALPHA


@pytest.mark.slow
def test_no_effect_is_claimed_where_none_was_planted(tmp_path: Path) -> None:
    first_of_the_shipped(tmp_path / "study", 72, "indifferent")
    recorded = read_study_folder(tmp_path / "study", check=False)
    assert min(adjusted_three_way(recorded)) > ALPHA
