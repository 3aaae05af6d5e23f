"""Reads a dataset that `ana study export` has written: its tables, as they are."""

import csv
import re
from collections.abc import Iterable, Iterator
from pathlib import Path

import pandas as pd

from analysis.sources.absent import SourceError
from analysis.sources.designs import crossed_in
from analysis.sources.recorded import ANALYSED, Recorded, recorded
from analysis.sources.study_folder import forms_of
from analysis.sources.tables_folder import table_of
from game.forms.form import Forms
from game.journal.records import STUDY_MODES, StudyMode

DESCRIPTION = "dataset_description.json"
_FILE = re.compile(r"study-(\w+)_session-(live|pilot|simulated)_description-(\w+)_data\.csv")
_GUARDED = re.compile(r"'\s*[=+\-@\uff1d\uff0b\uff0d\uff20]")
"""A text that a spreadsheet would compute, with the apostrophe that an export puts before it."""


def is_dataset(folder: Path) -> bool:
    """Whether `ana study export` may have written this folder."""
    return (folder / DESCRIPTION).is_file() and (folder / "data").is_dir()


def read_dataset(folder: Path, mode: StudyMode | None = None) -> Recorded:
    """The sessions of one mode in a dataset; without `mode`, of the only one there is.

    Raises SourceError, naming the file, for a table that is missing or holds something else, and
    where it is not clear which sessions are meant.
    """
    files = {
        (found[2], found[3]): path
        for path in sorted((folder / "data").glob("*.csv"))
        if (found := _FILE.fullmatch(path.name))
    }
    there = [mode for mode in STUDY_MODES if (mode, "participants") in files]
    wanted = mode or _only(there, folder)
    if wanted not in there:
        raise SourceError(
            f"there are no {wanted} sessions in the dataset",
            place=str(folder),
            hint=f"Take those that there are: {_options(there)}",
        )
    forms = forms_of(folder / "materials")
    missing = [name for name in ANALYSED if (wanted, name) not in files]
    if missing:
        raise SourceError(
            f"the dataset lacks the table {missing[0]}",
            place=str(folder / "data"),
            hint="Export the study again",
        )
    frames = {name: _read(files[wanted, name], name, forms) for name in ANALYSED}
    notes = ["these are pilot sessions, no data of the study"] if wanted == "pilot" else []
    crossed = crossed_in(folder / "materials")
    return recorded(frames, folder.resolve().name, notes, forms, crossed)


def _read(path: Path, name: str, forms: Forms) -> pd.DataFrame:
    try:
        with path.open(encoding="utf-8", newline="") as file:
            return table_of(_unguarded(csv.reader(file)), name, forms)
    except (OSError, ValueError) as error:
        raise SourceError(
            f"the table cannot be read ({error})",
            place=str(path),
            hint="Export the study again with this version, or analyse the study folder",
        ) from error


def _unguarded(rows: Iterable[list[str]]) -> Iterator[list[str]]:
    return ([cell[1:] if _GUARDED.match(cell) else cell for cell in row] for row in rows)


def _only(there: list[StudyMode], folder: Path) -> StudyMode:
    if len(there) == 1 and there != ["pilot"]:
        return there[0]
    raise SourceError(
        "the dataset has no sessions"
        if not there
        else f"the dataset has {' and '.join(there)} sessions; they are analysed apart",
        place=str(folder),
        hint=f"Say which: {_options(there)}" if there else "Export the study again",
    )


def _options(modes: Iterable[StudyMode]) -> str:
    return " or ".join(f"--mode {mode}" for mode in modes) or "none"
