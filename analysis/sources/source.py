"""Finds out what kind of source was given, and reads it."""

from dataclasses import dataclass
from pathlib import Path

from analysis.sources.absent import SourceError
from analysis.sources.dataset import is_dataset, read_dataset
from analysis.sources.frames import StudyData
from analysis.sources.longcsv import read_described_table, read_long_csv
from analysis.sources.recorded import Recorded
from analysis.sources.study_folder import (
    Tick,
    is_study_folder,
    mode_of,
    read_study_folder,
)
from analysis.sources.tables_folder import is_tables_folder, read_tables
from game.journal.records import StudyMode


@dataclass(frozen=True)
class Loaded:
    """A study as the statistics take it, and all that its journals tell where there are any."""

    study: StudyData
    recorded: Recorded | None


def load(
    source: Path,
    quiz: Path | None = None,
    mode: StudyMode | None = None,
    *,
    columns: Path | None = None,
    check: bool = True,
    tick: Tick = lambda _done, _all: None,
) -> Loaded:
    """Read one table, with quiz scores if given, a study folder, a dataset exported from one, or
    a folder of tables. `columns` is a TOML file that says what is what in one table.

    Raises SourceError or JournalError naming the place and a hint.
    """
    if source.is_dir():
        if quiz is not None:
            raise SourceError("--quiz goes with a CSV source; sessions have their own scores")
        if columns is not None:
            raise SourceError("--columns goes with one table; a study has its own forms")
        recorded = load_recorded(source, mode, check=check, tick=tick)
        return Loaded(recorded.study(), recorded)
    if mode is not None:
        raise SourceError("--mode goes with a study folder; a CSV has a column 'simulated'")
    if columns is None:
        return Loaded(read_long_csv(source, quiz), None)
    if quiz is not None:
        raise SourceError("--columns names the groups; give it without --quiz")
    return Loaded(read_described_table(source, columns), None)


def holds_live_sessions(source: Path, mode: StudyMode | None = None) -> bool:
    """Whether live sessions of a study folder are what is read of a source that can be read."""
    return is_study_source(source) and mode_of(source, mode) == "live"


def is_study_source(source: Path) -> bool:
    """Whether the journals of a study folder are what is read of a source."""
    return not is_tables_folder(source) and is_study_folder(source)


def load_recorded(
    source: Path,
    mode: StudyMode | None = None,
    *,
    check: bool = True,
    tick: Tick = lambda _done, _all: None,
) -> Recorded:
    """Read a study folder (`mode` and `check` as `read_study_folder` has them), a dataset that was
    exported from one, or its tables.

    Raises SourceError or JournalError naming the place and a hint.
    """
    if is_tables_folder(source):
        return read_tables(source)
    if is_dataset(source):
        return read_dataset(source, mode)
    if is_study_folder(source):
        return read_study_folder(source, mode, check=check, tick=tick)
    raise SourceError(
        "this is neither a study folder nor a dataset nor a folder of tables",
        place=str(source),
        hint="Give the folder that `ana study new`, `ana study export` or `ana simulate` has made",
    )
