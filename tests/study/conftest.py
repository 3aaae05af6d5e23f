"""A study in which one scripted participant has finished."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from game.study.folder import Study, open_study
from tests.study.people import finished_study


@pytest.fixture(scope="session")
def finished(tmp_path_factory: pytest.TempPathFactory) -> Study:
    """Do not change it: take a copy."""
    return finished_study(tmp_path_factory.mktemp("study") / "finished")


@pytest.fixture
def copy(finished: Study, tmp_path: Path) -> Study:
    """A copy of the finished study, to change."""
    folder = tmp_path / "copy"
    shutil.copytree(finished.folder, folder)
    return open_study(folder)
