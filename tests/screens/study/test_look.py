"""A study keeps the look it was made with, and its cells have the size that it says."""

from __future__ import annotations

from pathlib import Path

import pytest

from game.errors import AnaError
from game.screens.study.app import StudyApp
from game.study.folder import Identity, new_study, open_study

P01 = Identity("live", "P01")
LOOK = "look = 2"
CELLS = 'cells = "normal"'


def app_of(folder: Path, *changes: tuple[str, str]) -> StudyApp:
    """A participant's program in a new study whose settings have been changed so."""
    new_study(folder, seed=1, blocks=1)
    path = folder / "study.toml"
    settings = path.read_text()
    for old, new in changes:
        assert old in settings
        settings = settings.replace(old, new)
    path.write_text(settings)
    return StudyApp(open_study(folder), P01)


@pytest.fixture(autouse=True)
def many_colours(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("TERM", "xterm-256color")
    for name in ("NO_COLOR", "COLORTERM", "COLORFGBG"):
        monkeypatch.delenv(name, raising=False)


def test_a_new_study_has_the_look_of_today(tmp_path: Path) -> None:
    app = app_of(tmp_path / "new")
    assert (app.look, app.theme, app.cells) == (2, "ana-dark-256", "normal")


def test_a_study_from_before_there_were_looks_keeps_the_first(tmp_path: Path) -> None:
    app = app_of(tmp_path / "old", (LOOK, "# as it was"), (CELLS, "# as they were"))
    assert (app.look, app.theme, app.cells) == (1, "ana-dark-1", "normal")


def test_cells_can_be_large(tmp_path: Path) -> None:
    assert app_of(tmp_path / "large", (CELLS, 'cells = "large"')).cells == "large"


@pytest.mark.parametrize("wrong", [(LOOK, "look = 3"), (CELLS, 'cells = "huge"')])
def test_others_are_refused(tmp_path: Path, wrong: tuple[str, str]) -> None:
    with pytest.raises(AnaError, match=r"screen\.(look|cells)"):
        app_of(tmp_path / "wrong", wrong)
