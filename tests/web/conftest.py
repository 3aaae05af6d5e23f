"""Studies and servers that the tests of the browser share."""

from __future__ import annotations

import pytest

from game.study.folder import Study
from tests.study.people import finished_study


@pytest.fixture(scope="session")
def finished(tmp_path_factory: pytest.TempPathFactory) -> Study:
    """A study in which the pilot P01 has finished."""
    return finished_study(tmp_path_factory.mktemp("study") / "finished")
