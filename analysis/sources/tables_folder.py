"""A study's tables as files: one compressed CSV a table, the same bytes for the same study."""

import csv
import gzip
import io
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import TypeVar

import msgspec
import pandas as pd

from analysis.sources.absent import SourceError
from analysis.sources.designs import PAPER_DESIGN, Crossed
from analysis.sources.recorded import ANALYSED, Recorded, recorded, typed
from game.forms.form import Forms
from game.forms.reading import paper_forms
from game.tables.columns import cell, columns
from game.tables.session_tables import row_types

Kind = TypeVar("Kind")

ENDING = ".csv.gz"
ASKED = "forms.json"
"""The study's forms, where they are not the paper's."""
DESIGN = "design.json"
"""What the study crosses, and its primary outcomes, where settings say so."""


def write_tables(study: Recorded, folder: Path) -> list[Path]:
    """Write each table of the study into `folder`."""
    folder.mkdir(parents=True, exist_ok=True)
    paths = []
    for name in ANALYSED:
        path = folder / f"{name}{ENDING}"
        text = csv_text(study.frame(name), name, study.forms)
        path.write_bytes(gzip.compress(text.encode(), 9, mtime=0))
        paths.append(path)
    if study.forms != paper_forms():
        (folder / ASKED).write_bytes(msgspec.json.format(msgspec.json.encode(study.forms)))
        paths.append(folder / ASKED)
    if study.crossed != PAPER_DESIGN:
        (folder / DESIGN).write_bytes(msgspec.json.format(msgspec.json.encode(study.crossed)))
        paths.append(folder / DESIGN)
    return paths


def csv_text(frame: pd.DataFrame, name: str, forms: Forms | None = None) -> str:
    """A frame as CSV, its cells as exports have them."""
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\n")
    writer.writerow(frame.columns)
    written = [
        _cells(frame[column.name], column.values)
        for column in columns(row_types(forms or paper_forms())[name])
    ]
    writer.writerows(zip(*written, strict=True))
    return out.getvalue()


def is_tables_folder(folder: Path) -> bool:
    """Whether `write_tables` may have written this folder."""
    return (folder / f"participants{ENDING}").is_file()


def read_tables(folder: Path) -> Recorded:
    """The study in a folder that `write_tables` has written.

    Raises SourceError, naming the file, for a table that is missing or holds something else.
    """
    forms = _said(folder / ASKED, Forms, "forms") or paper_forms()
    crossed = _said(folder / DESIGN, Crossed, "design") or PAPER_DESIGN
    frames = {name: _read_table(folder / f"{name}{ENDING}", name, forms) for name in ANALYSED}
    return recorded(frames, folder.resolve().name, forms=forms, crossed=crossed)


def _said(path: Path, kind: type[Kind], what: str) -> Kind | None:
    """What stands in a file beside the tables; None where there is none."""
    try:
        return msgspec.json.decode(path.read_bytes(), type=kind)
    except FileNotFoundError:
        return None
    except (OSError, msgspec.MsgspecError) as error:
        raise SourceError(f"the {what} cannot be read ({error})", place=str(path)) from error


def _read_table(path: Path, name: str, forms: Forms) -> pd.DataFrame:
    try:
        with gzip.open(path, "rt", encoding="utf-8", newline="") as file:
            return table_of(csv.reader(file), name, forms)
    except (OSError, EOFError, ValueError) as error:
        raise SourceError(
            f"the table cannot be read ({error})",
            place=str(path),
            hint="Write the tables again with this version: python -m analysis.reproduce",
        ) from error


def table_of(lines: Iterable[list[str]], name: str, forms: Forms) -> pd.DataFrame:
    """A frame of a header and its rows. Raises ValueError for those of another table."""
    header = [column.name for column in columns(row_types(forms)[name])]
    first, *rows = lines
    if first != header:
        raise ValueError("its columns are not those of the table")
    return typed(name, rows, forms)


def _cells(values: "pd.Series", kind: str) -> Sequence[str]:
    if kind == "whole number":
        return ["" if pd.isna(value) else str(int(value)) for value in values]
    return ["" if pd.isna(value) else cell(value) for value in values]
