"""What the study's account may not read is named by every command, and nobody is left out."""

from __future__ import annotations

import shutil
from collections.abc import Iterator
from pathlib import Path

import pytest

from game.study.folder import Identity, Study
from tests.study.people import small_study, take_part
from tests.unprivileged import ana

JOURNAL = "sessions/live/P01/journal.jsonl"


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Study:
    study = small_study(tmp_path_factory.mktemp("unreadable") / "study")
    for participant in ("P01", "P02"):
        take_part(study, Identity("live", participant))
    return study


@pytest.fixture
def folder(made: Study, tmp_path: Path) -> Iterator[Path]:
    folder = tmp_path / "study"
    shutil.copytree(made.folder, folder)
    yield folder
    for name in ("sessions", "sessions/live", "sessions/live/P01", "versions"):
        if (folder / name).exists():
            (folder / name).chmod(0o700)


@pytest.mark.parametrize("name", ["sessions", "sessions/live", "sessions/live/P01", JOURNAL])
def test_an_unreadable_folder_or_journal_is_named_by_all(
    folder: Path, tmp_path: Path, name: str
) -> None:
    (folder / name).chmod(0)
    out = tmp_path / "out"
    tried = {
        "status": (ana("study", "status", folder), 1),
        "export": (ana("study", "export", folder, out), 2),
        "data": (ana("study", "data", folder, "P01", out), 2),
        "verify": (ana("verify", folder), 2),
        "analyse": (ana("analyse", folder, "--json", out), 2),
    }
    for command, (done, status) in tried.items():
        told = done.stdout + done.stderr
        assert done.returncode == status, f"{command}: {told}"
        assert "Traceback" not in told, command
        assert name in told or name == JOURNAL, command
        assert "Permission denied" in told, command
    assert not out.exists()


@pytest.mark.parametrize("name", ["sessions/live/P01", JOURNAL])
def test_who_cannot_be_read_can_be_left_out(folder: Path, tmp_path: Path, name: str) -> None:
    (folder / name).chmod(0)
    out = tmp_path / "out"
    assert ana("study", "export", folder, out, "--without", "P01").returncode == 0
    assert [path.name for path in (out / "data/raw/live").iterdir()] == ["P02"]


@pytest.mark.long
def test_versions_that_cannot_be_read_are_not_left_out(folder: Path, tmp_path: Path) -> None:
    (folder / "versions").chmod(0)
    (folder / JOURNAL).chmod(0)
    told = ana("study", "check", folder).stderr
    assert "versions cannot be read by this account; allow it with chmod u+r" in told
    assert f"{JOURNAL} cannot be read by this account" in told
    (folder / JOURNAL).chmod(0o600)
    done = ana("study", "export", folder, tmp_path / "out")
    assert (done.returncode, "versions" in done.stderr) == (2, True)
    assert not (tmp_path / "out").exists()


def test_whoever_cannot_be_read_can_withdraw_once_the_folder_can_be_opened(folder: Path) -> None:
    (folder / JOURNAL).chmod(0)
    asked = ana("study", "withdraw", folder, "P01", "--yes")
    assert asked.returncode == 0, asked.stderr
    assert not (folder / JOURNAL).parent.exists()
    (folder / "sessions/live/P02").chmod(0)
    refused = ana("study", "withdraw", folder, "P02", "--yes")
    assert refused.returncode == 2
    assert "sessions/live/P02" in refused.stderr
    (folder / "sessions/live/P02").chmod(0o700)
    assert ana("study", "withdraw", folder, "P02", "--yes").returncode == 0
