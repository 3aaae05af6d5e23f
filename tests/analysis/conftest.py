"""Made-up studies for the analysis tests, and the folder of the published numbers."""

from collections.abc import Callable, Mapping
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from analysis.sources.frames import StudyData
from analysis.sources.longcsv import read_long_csv

GROUPS = ("LOW", "MED", "HIGH")
LEVELS = ("C1", "C2", "C3")
STATES = ("engagement", "confidence", "frustration", "confusion")
ITEMS = ("pref1", "pref2", "pref3", "pref4")

Sizes = Mapping[tuple[str, str], int]
MakeTable = Callable[..., pd.DataFrame]
ReadTable = Callable[..., StudyData]


def unequal_sizes() -> dict[tuple[str, str], int]:
    cells = [(group, level) for group in GROUPS for level in LEVELS]
    return dict(zip(cells, (5, 7, 4, 6, 3, 8, 5, 6, 4), strict=True))


def made_up_table(sizes: Sizes | None = None, seed: int = 1) -> pd.DataFrame:
    """A long table with person effects, whole answers, and every optional column."""
    rng = np.random.default_rng(seed)
    rows = []
    who = 0
    for (group, level), size in (unequal_sizes() if sizes is None else sizes).items():
        for _ in range(size):
            who += 1
            person = rng.normal(0, 10)
            tilt = rng.normal(0, 0.8)
            order = "static_first" if who % 2 else "adaptive_first"
            preferred = "adaptive" if rng.random() < 0.6 else "static"
            for at, adaptivity in enumerate(("static", "adaptive")):
                lift = 6 * GROUPS.index(group) * at - 4 * LEVELS.index(level) * (1 - at)
                row: dict[str, object] = {
                    "participant": f"P{who:03d}",
                    "knowledge": group,
                    "complexity": level,
                    "adaptivity": adaptivity,
                    "victims": int(np.clip(round(11 + person / 5 + rng.normal(0, 2)), 0, 20)),
                    "order": order,
                    "building": ("north", "south")[(who // 2 + at) % 2],
                    "preferred_instructor": preferred,
                    "disobeyed": who % 8,
                }
                for state in STATES:
                    row[state] = int(np.clip(round(55 + lift + person + rng.normal(0, 12)), 1, 100))
                for item in ITEMS:
                    row[item] = int(np.clip(round(3 + tilt + rng.normal(0, 0.9)), 1, 5))
                rows.append(row)
    return pd.DataFrame(rows)


@pytest.fixture(scope="session")
def make_table() -> MakeTable:
    return made_up_table


@pytest.fixture
def read_table(tmp_path: Path) -> ReadTable:
    """Writes a long table (and quiz scores by participant) to CSV and reads it back as a study."""

    def read(table: pd.DataFrame, quiz: Mapping[str, float] | None = None) -> StudyData:
        source = tmp_path / "long.csv"
        table.to_csv(source, index=False)
        scores = None
        if quiz is not None:
            scores = tmp_path / "quiz.csv"
            pd.DataFrame({"participant": list(quiz), "quiz_static": list(quiz.values())}).to_csv(
                scores, index=False
            )
        return read_long_csv(source, scores)

    return read


@pytest.fixture(scope="session")
def study(tmp_path_factory: pytest.TempPathFactory) -> StudyData:
    source = tmp_path_factory.mktemp("made_up") / "long.csv"
    made_up_table().drop(columns="disobeyed").to_csv(source, index=False)
    return read_long_csv(source)


@pytest.fixture(scope="session")
def published() -> Path:
    return Path(__file__).resolve().parents[2] / "data" / "paper"
