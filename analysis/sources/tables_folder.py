"""A study's tables as files: one compressed CSV a table, the same bytes for the same study."""

import csv
import gzip
import io
from collections.abc import Sequence
from pathlib import Path

import pandas as pd

from analysis.sources.absent import SourceError
from analysis.sources.recorded import ANALYSED, Recorded, recorded, typed
from game.tables.columns import cell, columns
from game.tables.session_tables import ROW_TYPES

ENDING = ".csv.gz"


def write_tables(study: Recorded, folder: Path) -> list[Path]:
    """Write each table of the study into `folder`."""
    folder.mkdir(parents=True, exist_ok=True)
    paths = []
    for name in ANALYSED:
        path = folder / f"{name}{ENDING}"
        path.write_bytes(gzip.compress(csv_text(study.frame(name), name).encode(), 9, mtime=0))
        paths.append(path)
    return paths


def csv_text(frame: pd.DataFrame, name: str) -> str:
    """A frame as CSV, its cells as exports have them."""
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\n")
    writer.writerow(frame.columns)
    written = [_cells(frame[column.name], column.values) for column in columns(ROW_TYPES[name])]
    writer.writerows(zip(*written, strict=True))
    return out.getvalue()


def is_tables_folder(folder: Path) -> bool:
    """Whether `write_tables` may have written this folder."""
    return (folder / f"participants{ENDING}").is_file()


def read_tables(folder: Path) -> Recorded:
    """The study in a folder that `write_tables` has written.

    Raises SourceError, naming the file, for a table that is missing or holds something else.
    """
    frames = {name: _read_table(folder / f"{name}{ENDING}", name) for name in ANALYSED}
    return recorded(frames, folder.resolve().name)


def _read_table(path: Path, name: str) -> pd.DataFrame:
    header = [column.name for column in columns(ROW_TYPES[name])]
    try:
        with gzip.open(path, "rt", encoding="utf-8", newline="") as file:
            first, *rows = csv.reader(file)
        if first != header:
            raise ValueError("its columns are not those of the table")
        return typed(name, rows)
    except (OSError, EOFError, ValueError) as error:
        raise SourceError(
            f"the table cannot be read ({error})",
            place=str(path),
            hint="Write the tables again with this version: python -m analysis.reproduce",
        ) from error


def _cells(values: "pd.Series", kind: str) -> Sequence[str]:
    if kind == "whole number":
        return ["" if pd.isna(value) else str(int(value)) for value in values]
    return ["" if pd.isna(value) else cell(value) for value in values]
