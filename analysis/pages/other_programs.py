"""The analysed sample for JASP, jamovi and R, and an R script that repeats the main tests."""

import csv
import io
from collections.abc import Iterable
from pathlib import Path

import pandas as pd

from analysis.sources.factors import ADAPTIVITY
from analysis.sources.frames import StudyData

SCRIPT = Path(__file__).with_name("main_tests.R")
#: What is known of a person, in the order of the columns.
PERSON = ("knowledge", "complexity", "quiz_static", "order", "memorise_minutes",
          "preferred_instructor")  # fmt: skip


def wide_csv(study: StudyData) -> str:
    """One row a participant, as those programs want repeated measures: `engagement_static` and
    `engagement_adaptive`. A missing answer is an empty cell."""
    people = study.participants
    names = dict.fromkeys((*study.outcomes, *study.asked.ranges))
    measures = [(name, part) for name in names for part in ADAPTIVITY]
    rounds = study.by_round.reindex(people.index)
    rounds = rounds.reindex(columns=pd.MultiIndex.from_tuples(measures))
    known = [column for column in PERSON if study.has(column)]
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\n")
    writer.writerow(["participant", *known, *(f"{name}_{part}" for name, part in measures)])
    for who, person, answers in zip(
        people.index, people[known].to_numpy(), rounds.to_numpy(), strict=True
    ):
        writer.writerow([who, *map(_cell, person), *map(_cell, answers)])
    return out.getvalue()


def write_for_other_programs(study: StudyData, folder: Path) -> None:
    """Write `wide.csv` and `main_tests.R` into a folder that exists."""
    (folder / "wide.csv").write_text(wide_csv(study), encoding="utf-8")
    script = SCRIPT.read_text(encoding="utf-8")
    script = script.replace("OUTCOMES", _quoted(study.outcomes))
    script = script.replace("LEVELS", _quoted(study.crossed.levels))
    (folder / SCRIPT.name).write_text(script, encoding="utf-8")


def _quoted(names: Iterable[str]) -> str:
    return ", ".join(f'"{name}"' for name in names)


def _cell(value: object) -> str:
    if pd.isna(value):  # type: ignore[call-overload]
        return ""
    if isinstance(value, float):
        return f"{value:.15g}"
    return str(value)
