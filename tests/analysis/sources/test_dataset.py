"""An exported dataset is analysed as the study folder that it came from is."""

from __future__ import annotations

import shutil
from pathlib import Path

import pandas as pd
import pytest

from analysis.sources.absent import SourceError
from analysis.sources.recorded import ANALYSED
from analysis.sources.source import holds_live_sessions, load_recorded
from analysis.sources.tables_folder import write_tables
from game.study.folder import Identity, open_study
from game.study.lab.export import export_study
from tests.study.people import take_part
from tests.tables.test_asked import wide_study


@pytest.fixture(scope="module")
def exported(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Path]:
    """A study with many forms, in which one scripted person took part, and its dataset."""
    folder = tmp_path_factory.mktemp("dataset")
    study = wide_study(folder / "study")
    forms = (study.folder / "forms.toml").read_text().split("[[form]]")
    kept = [form for form in forms if "games_kinds" not in form and 'id = "age"' not in form]
    (study.folder / "forms.toml").write_text("[[form]]".join(kept))
    take_part(open_study(study.folder), Identity("live", "P01"))
    export_study(study.folder, folder / "out")
    return study.folder, folder / "out"


def test_it_holds_what_the_study_folder_holds(exported: tuple[Path, Path], tmp_path: Path) -> None:
    folder, dataset = exported
    direct, read = load_recorded(folder, check=False), load_recorded(dataset)
    assert read.forms == direct.forms
    for name in ANALYSED:
        pd.testing.assert_frame_equal(direct.frame(name), read.frame(name))
    assert direct.study().outcomes == read.study().outcomes
    assert "tlx_raw" in read.study().outcomes
    assert not holds_live_sessions(dataset)
    write_tables(read, tmp_path / "tables")
    again = load_recorded(tmp_path / "tables")
    assert again.forms == direct.forms
    assert again.crossed == direct.crossed
    assert again.crossed.primary is not None
    for name in ANALYSED:
        pd.testing.assert_frame_equal(direct.frame(name), again.frame(name))


def test_what_is_missing_is_named(exported: tuple[Path, Path], tmp_path: Path) -> None:
    copy = Path(shutil.copytree(exported[1], tmp_path / "copy"))
    with pytest.raises(SourceError, match=r"no pilot sessions.*--mode live"):
        load_recorded(copy, "pilot")
    rounds = next(copy.glob("data/*rounds_data.csv"))
    rounds.write_text(rounds.read_text().replace("tlx_raw", "tlx"))
    with pytest.raises(SourceError, match=r"rounds_data\.csv.*columns are not those"):
        load_recorded(copy)
    rounds.unlink()
    with pytest.raises(SourceError, match="lacks the table rounds"):
        load_recorded(copy)
