"""A published study of the same design, through the functions of the study's own ANOVA.

O'Brien and Kaiser (1985) have treatment x gender between people and the phase of a measurement
within them: here knowledge, two static levels, and the round.
"""

import json
from pathlib import Path
from typing import Any

import pandas as pd
import pytest

from analysis.sources.designs import Crossed
from analysis.sources.frames import StudyData, paired
from analysis.stats.anova import mixed_anova
from analysis.stats.mixed import mixed_model
from analysis.stats.posthoc import RoundModels, difference_knowledge_within_complexity
from tests.analysis.stats.test_reference import differences

REFERENCE = Path(__file__).resolve().parents[2] / "reference"
GROUPS = {"control": "LOW", "A": "MED", "B": "HIGH"}
LEVELS = {"F": "C1", "M": "C2"}
OUTCOME = "victims"


def study_of(phases: dict[str, str]) -> StudyData:
    """The mean over the hours of these phases, each under the name of a round."""
    table = pd.read_csv(REFERENCE / "obrien_kaiser.csv", dtype={"id": str})
    people = table.drop_duplicates("id").set_index("id").sort_index()
    rounds = table.assign(adaptivity=table["phase"].map(phases)).dropna(subset=["adaptivity"])
    means = rounds.groupby(["id", "adaptivity"], as_index=False)["value"].mean()
    factors = {
        "knowledge": people["treatment"].map(GROUPS),
        "complexity": people["gender"].map(LEVELS),
    }
    return StudyData(
        pd.DataFrame(factors, index=people.index),
        pd.DataFrame(means.set_axis(["participant", "adaptivity", OUTCOME], axis=1)),
        "O'Brien and Kaiser (1985)",
        crossed=Crossed(levels=("C1", "C2")),
    )


@pytest.mark.parametrize("later", ["post", "fup"])
def test_every_number_that_r_gives(later: str) -> None:
    study = study_of({"pre": "static", later: "adaptive"})
    pair = paired(study, OUTCOME)
    ours: dict[str, Any] = {
        "anova": [row.row() | {"wilks": row.wilks} for row in mixed_anova(pair)],
        "lmm": mixed_model(study, OUTCOME),
        "posthoc_diff_knowledge_within_complexity": difference_knowledge_within_complexity(
            RoundModels.of(pair)
        ),
    }
    expected = json.loads((REFERENCE / "obrien_kaiser.json").read_text(encoding="utf-8"))
    for part, theirs in expected[later].items():
        assert differences(ours[part], theirs, f".{part}.") == []


def test_the_printed_between_effects() -> None:
    """The sum of all phases bears the between effects that are printed for the whole study."""
    study = study_of({"pre": "static", "post": "static", "fup": "adaptive"})
    weights = study.rounds["adaptivity"].map({"static": 2.0, "adaptive": 1.0})
    whole = study.rounds.assign(**{OUTCOME: study.rounds[OUTCOME] * weights})
    summed = StudyData(study.participants, whole, study.label, crossed=study.crossed)
    tests = {row.effect: row.test for row in mixed_anova(paired(summed, OUTCOME))}
    printed = {"knowledge": 3.94, "complexity": 3.66, "knowledge:complexity": 2.86}
    assert {name: round(tests[name].F, 2) for name in printed} == printed
    assert all(tests[name].df2 == 10 for name in printed)
