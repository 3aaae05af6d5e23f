"""What a study's settings say of its design, and how results call its instructors."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pandas as pd
import pytest

from analysis.battery import run_battery
from analysis.pages.figures import figures_of
from analysis.sources.designs import PAPER_DESIGN, Crossed, crossed_in
from analysis.sources.frames import StudyData
from game.forms.reading import paper_forms
from game.tables.exclusions import read_rules


@pytest.mark.parametrize(
    ("settings", "words", "levels"),
    [
        ("", ("static", "adaptive"), ("C1", "C2", "C3")),
        ('coach = "knowledge"', ("static", "adaptive"), ("C1", "C2", "C3")),
        ("static_levels = [1, 3]", ("static", "adaptive"), ("C1", "C3")),
        ('instructors = ["ana", "yoked"]', ("ana", "yoked"), ("C2",)),
        ('instructors = ["static:1", "static:3"]', ("static:1", "static:3"), ("C2",)),
        ('instructors = ["static:1", "ana:belief"]', ("static", "adaptive"), ("C2",)),
    ],
)
def test_a_design_is_read_from_its_settings(
    settings: str, words: tuple[str, str], levels: tuple[str, ...], tmp_path: Path
) -> None:
    (tmp_path / "study.toml").write_text(settings)
    crossed = crossed_in(tmp_path)
    assert (crossed.words, crossed.levels) == (words, levels)
    assert bool(crossed.mapping) == (words != ("static", "adaptive"))


def test_the_papers_design_needs_no_note() -> None:
    assert PAPER_DESIGN.notes(paper_forms()) == []


YOKED = Crossed(instructors=("ana", "yoked"), levels=("C2",))
TWO_LEVELS = Crossed(levels=("C1", "C3"))


@pytest.mark.parametrize("crossed", [YOKED, TWO_LEVELS])
def test_a_design_of_fewer_levels_is_analysed_without_a_problem(
    crossed: Crossed,
    make_table: Callable[..., pd.DataFrame],
    read_table: Callable[..., StudyData],
) -> None:
    sizes = {(group, level): 6 for group in ("LOW", "MED", "HIGH") for level in crossed.levels}
    table = make_table(sizes).drop(columns="disobeyed")
    study = replace(read_table(table), crossed=crossed)
    result = run_battery(study, read_rules())
    assert (result.exit_status, result.problems) == (0, ())
    told = result.table()
    assert f"{crossed.gap}: " in told
    assert ("complexity" in told) == (len(crossed.levels) > 1)
    effects = result.results["outcomes"]["victims"]["anova"]  # type: ignore[call-overload,index]
    assert len(effects) == (8 if len(crossed.levels) > 1 else 4)  # type: ignore[arg-type]
    drawn = [figure.name for figure in figures_of(study)]
    assert ("fig7_mental_states" in drawn) == (len(crossed.levels) > 1)
    assert "fig9_engagement" in drawn
