"""Which commit results name: that of the running code, and only that."""

import subprocess
from pathlib import Path

import pytest

from analysis.sources.absent import Absent
from analysis.sources.provenance import commit_of

IDENTITY = ("-c", "user.name=nobody", "-c", "user.email=nobody@localhost")


def git(folder: Path, *arguments: str) -> str:
    command = ["git", "-C", str(folder), *IDENTITY, *arguments]
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout.strip()


@pytest.fixture
def clone(tmp_path: Path) -> Path:
    for name in ("analysis/sources/provenance.py", "game/cli.py", "docs/notes.md"):
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text("as committed\n")
    git(tmp_path, "init", "--quiet")
    git(tmp_path, "add", "--all")
    git(tmp_path, "commit", "--quiet", "--message", "as committed")
    return tmp_path


def test_a_clean_clone_names_its_commit_even_where_there_is_a_tag(clone: Path) -> None:
    git(clone, "tag", "--annotate", "v1", "--message", "a release")
    (clone / "docs" / "notes.md").write_text("changed, but no code\n")
    assert commit_of(clone) == git(clone, "rev-parse", "HEAD")


@pytest.mark.parametrize("name", ["game/cli.py", "analysis/sources/not_added.py"])
def test_changed_and_added_code_makes_it_dirty(clone: Path, name: str) -> None:
    (clone / name).write_text("changed\n")
    assert commit_of(clone) == f"{git(clone, 'rev-parse', 'HEAD')}-dirty"


def test_the_environment_names_no_other_repository(
    clone: Path, tmp_path_factory: pytest.TempPathFactory, monkeypatch: pytest.MonkeyPatch
) -> None:
    other = tmp_path_factory.mktemp("other")
    git(other, "init", "--quiet")
    head = git(clone, "rev-parse", "HEAD")
    monkeypatch.setenv("GIT_DIR", str(other / ".git"))
    assert commit_of(clone) == head


def test_a_repository_around_the_code_is_not_its_own(
    clone: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    installed = clone / "venv" / "site-packages"
    installed.mkdir(parents=True)
    assert commit_of(installed) == Absent("not run in a clone of the repository")
    git(clone, "rm", "--quiet", "--cached", "analysis/sources/provenance.py")
    assert commit_of(clone) == Absent("not run in a clone of the repository")
    monkeypatch.setenv("PATH", "")
    assert "could not be asked" in str(commit_of(clone))
