"""The mixed model over more than two rounds, against statsmodels, and where it cannot be had."""

import json
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pandas as pd
import pytest

from analysis.battery import run_battery
from analysis.pages.manuscript.part import Found, Part
from analysis.pages.manuscript.rounds import TITLE, rounds
from analysis.pages.published import PUBLISHED
from analysis.pages.rounds_figure import every_round
from analysis.sources.absent import Refusal
from analysis.sources.frames import StudyData
from analysis.stats.rounds import rounds_rows
from game.tables.exclusions import read_rules
from tests.analysis.peers import smf

BUILDINGS = ("a", "b", "c")


@pytest.fixture
def three_rounds(
    make_table: Callable[..., pd.DataFrame], read_table: Callable[..., StudyData]
) -> StudyData:
    """A study whose instructors take turns over three rounds, with an effect of the round."""
    study = read_table(make_table().drop(columns="disobeyed"))
    rng = np.random.default_rng(3)
    rows = []
    for number, who in enumerate(study.participants.index):
        person = rng.normal(0, 2)
        for round_ in (1, 2, 3):
            adaptivity = ("static", "adaptive")[(number + round_) % 2]
            rows.append(
                {
                    "participant": who,
                    "round": round_,
                    "adaptivity": adaptivity,
                    "building": BUILDINGS[(number // 2 + round_) % 3],
                    "victims": round(12 + person + round_ + rng.normal(0, 1.5)),
                    **dict.fromkeys(study.outcomes[1:], 50 + round(rng.normal(0, 9))),
                }
            )
    return replace(study, every_round=pd.DataFrame(rows))


def test_it_is_the_model_of_statsmodels(three_rounds: StudyData) -> None:
    found = rounds_rows(three_rounds, "victims")["lmm"]
    assert isinstance(found, dict)
    assert three_rounds.every_round is not None
    rows = three_rounds.every_round.join(
        three_rounds.participants[["knowledge", "complexity"]], on="participant"
    )
    theirs = smf.mixedlm(
        "victims ~ C(knowledge, Sum) * C(complexity, Sum) * C(adaptivity, Sum)"
        " + C(round, Sum) + C(building, Sum)",
        rows,
        groups="participant",
    ).fit(reml=True)
    waldtests = theirs.wald_test_terms(scalar=True).table
    names = {"round": "C(round, Sum)", "building": "C(building, Sum)",
             "adaptivity": "C(adaptivity, Sum)", "knowledge": "C(knowledge, Sum)"}  # fmt: skip
    effects = {row["effect"]: row for row in found["anova"]}
    for effect, name in names.items():
        chi2 = float(waldtests.loc[name, "statistic"])
        assert effects[effect]["F"] * effects[effect]["df1"] == pytest.approx(chi2, rel=1e-2)
    assert effects["round"]["p"] < 0.01
    assert found["left_out"] == []


def test_what_the_data_cannot_tell_apart_is_left_out(three_rounds: StudyData) -> None:
    assert three_rounds.every_round is not None
    same = three_rounds.every_round.assign(
        building=three_rounds.every_round["round"].map(dict(zip((1, 2, 3), BUILDINGS, strict=True)))
    )
    found = rounds_rows(replace(three_rounds, every_round=same), "victims")["lmm"]
    assert isinstance(found, dict)
    assert found["left_out"] == ["building"]


def test_two_rounds_have_none_of_it(study: StudyData) -> None:
    with pytest.raises(Refusal, match="no instructor has more than one round"):
        rounds_rows(study, "victims")
    with pytest.raises(Refusal):
        every_round(study)
    assert rounds(Found({}, study, study, None, PUBLISHED)) == Part(TITLE, [], [], [])


def test_it_is_told_and_drawn(three_rounds: StudyData) -> None:
    result = run_battery(three_rounds, read_rules())
    assert "mixed model over all rounds: adaptivity F(1, " in result.table()
    numbers = json.loads(result.to_json())
    part = rounds(Found(numbers, result.study, three_rounds, None, PUBLISHED))
    means, models = part.tables
    told = numbers["outcomes"]["victims"]["rounds"]
    assert means.rows[: len(told["means"])] == tuple(
        ("victims", str(row["round"]), row["adaptivity"], str(row["n"]), f"{row['mean']:.2f}",
         f"{row['sd']:.2f}")
        for row in told["means"]
    )  # fmt: skip
    effects = [row["effect"] for row in told["lmm"]["anova"]]
    assert {"adaptivity", "round", "building"} <= set(effects)
    assert [row[1] for row in models.rows if row[0] == "victims"] == effects
    assert [draw().name for draw in part.drawings] == ["rounds"]
