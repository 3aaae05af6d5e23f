"""Where results come from: versions, the hash of each input, settings and seeds."""

from __future__ import annotations

import hashlib
import os
import platform
import subprocess
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from datetime import UTC, datetime
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

from analysis.sources.absent import Absent, Leaf, Row
from analysis.sources.study_folder import is_study_folder, mode_of
from analysis.sources.tables_folder import ENDING, is_tables_folder
from game import __version__
from game.journal.folders import journals
from game.journal.records import StudyMode
from game.tables.exclusions import RULES_FILE

LIBRARIES = ("numpy", "scipy", "pandas", "matplotlib")
#: Set by builds that must give the same bytes: the date in seconds since 1970.
DATE_VARIABLE = "SOURCE_DATE_EPOCH"
_ROOT = Path(__file__).resolve().parents[2]
_CODE = ("analysis", "game")
_THIS = "analysis/sources/provenance.py"


@dataclass(frozen=True)
class InputFile:
    """A file that was read, by its name inside the source, and its SHA-256."""

    name: str
    sha256: str


@dataclass(frozen=True)
class Provenance:
    """All that a reader needs to get the same results again. `commit` is Absent outside a clone."""

    version: str
    commit: str | Absent
    inputs: tuple[InputFile, ...]
    date: str
    settings: Mapping[str, Leaf]
    seeds: Mapping[str, int]
    libraries: Mapping[str, str]

    @property
    def sha256(self) -> str:
        """One hash of all inputs: of their names and hashes."""
        lines = "".join(f"{one.sha256}  {one.name}\n" for one in self.inputs)
        return hashlib.sha256(lines.encode()).hexdigest()

    def line(self) -> str:
        """The provenance in a line, without the date."""
        commit = "" if isinstance(self.commit, Absent) else f", commit {self.commit}"
        return f"ana {self.version}{commit}; inputs SHA-256 {self.sha256}"

    def row(self) -> Row:
        """The provenance as written to the results."""
        return {
            "ana": self.version,
            "commit": self.commit,
            "date": self.date,
            "inputs_sha256": self.sha256,
            "inputs": [{"name": one.name, "sha256": one.sha256} for one in self.inputs],
            "settings": dict(self.settings),
            "seeds": dict(self.seeds),
            "libraries": dict(self.libraries),
        }


def provenance(
    source: Path,
    beside: Path | None,
    mode: StudyMode | None,
    settings: Mapping[str, Leaf],
    seeds: Mapping[str, int],
) -> Provenance:
    """The provenance of what is made of these inputs, now; `beside` is a file given with them."""
    files = {RULES_FILE.name: RULES_FILE, **dict(_files(source, mode))}
    if beside is not None:
        files[beside.name] = beside
    return Provenance(
        version=__version__,
        commit=commit_of(_ROOT),
        inputs=tuple(InputFile(name, _hash(path)) for name, path in sorted(files.items())),
        date=_now().isoformat(timespec="seconds"),
        settings=settings,
        seeds=seeds,
        libraries={"python": platform.python_version(), **_installed()},
    )


def _files(source: Path, mode: StudyMode | None) -> Iterable[tuple[str, Path]]:
    if not source.is_dir():
        return [(source.name, source)]
    if is_tables_folder(source):
        return [(path.name, path) for path in source.glob(f"*{ENDING}")]
    if is_study_folder(source):
        found = [*journals(source, mode_of(source, mode)), *source.glob("*.toml")]
        return [(path.relative_to(source).as_posix(), path) for path in found]
    return []


def _hash(path: Path) -> str:
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


def commit_of(code: Path) -> str | Absent:
    """The commit of the running `code`, a folder with `analysis` and `game` in it, with `-dirty`
    after it where those two are not as committed.

    A repository around an installed package is not that of its code: one counts only if it begins
    at the folder and tracks this very file. Absent, with the reason, where there is none, or where
    git cannot be asked.
    """
    if not (code / ".git").exists():
        return Absent("not run in a clone of the repository")
    parts = [path for path in _CODE if (code / path).exists()]
    try:
        if not _git(code, "ls-files", "--", _THIS):
            return Absent("not run in a clone of the repository")
        commit = _git(code, "rev-parse", "HEAD")
        changed = _git(code, "status", "--porcelain", "--untracked-files=all", "--", *parts)
    except (OSError, subprocess.SubprocessError):
        return Absent("git, which knows the commit of this clone, could not be asked")
    return f"{commit}-dirty" if changed else commit


def _git(code: Path, *arguments: str) -> str:
    """What git answers about the repository of `code`, whatever repository the caller's own
    environment names."""
    own = {name: value for name, value in os.environ.items() if not name.startswith("GIT_")}
    command = ["git", "-C", str(code), *arguments]
    run = subprocess.run(command, capture_output=True, text=True, check=True, timeout=10, env=own)
    return run.stdout.strip()


def _now() -> datetime:
    given = os.environ.get(DATE_VARIABLE, "")
    return datetime.fromtimestamp(int(given), UTC) if given.isdigit() else datetime.now(UTC)


def _installed() -> dict[str, str]:
    found = {}
    for name in LIBRARIES:
        try:
            found[name] = version(name)
        except PackageNotFoundError:
            continue
    return found
