"""A study in which one scripted participant has finished, to replay on screens."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from game.screens.study.base import StudyScreen
from game.study.folder import Study, open_study
from tests.screens.study.seats import kinds_of
from tests.study.people import finished_study


@pytest.fixture(scope="session")
def finished(tmp_path_factory: pytest.TempPathFactory) -> Study:
    """Do not change it."""
    return finished_study(tmp_path_factory.mktemp("screens") / "finished")


@pytest.fixture
def study(finished: Study, tmp_path: Path) -> Study:
    """A copy of it."""
    shutil.copytree(finished.folder, tmp_path / "study")
    return open_study(tmp_path / "study")


@pytest.fixture
def hearing(monkeypatch: pytest.MonkeyPatch) -> None:
    """Screens accept keys at once."""
    for screen in kinds_of(StudyScreen):
        monkeypatch.setattr(screen, "DEAF_S", 0.0)
