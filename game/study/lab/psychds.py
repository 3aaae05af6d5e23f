"""What makes a folder of tables a Psych-DS dataset: names, description, codebook.

The rules are those of https://psychds-docs.readthedocs.io (rules and conventions): data files are
called `key-value_key-value_data.csv` with the official keys and alphanumeric values, and
`variableMeasured` of `dataset_description.json` lists exactly the columns of all of them.
"""

from __future__ import annotations

import csv
import io
import re
import unicodedata
from collections.abc import Iterable, Mapping, Sequence
from inspect import getdoc
from typing import Any

import msgspec

from game.tables.columns import TableColumn, cell, columns
from game.tables.rows import TableRow

IGNORED = "data/raw/\nraw/\n"
IGNORE_FILES = (".psychds-ignore", ".psychdsignore")
"""Older and newer validators read one or the other."""


_FORMULA = tuple("=+-@\uff1d\uff0b\uff0d\uff20")
"""How a text begins that a spreadsheet would compute, blanks before it or not; the last four are
the wide signs of Chinese and Japanese keyboards."""


class DatasetNotes(msgspec.Struct, frozen=True, forbid_unknown_fields=True, kw_only=True):
    """What only the lab can say about its dataset; every field is optional."""

    description: str = ""
    authors: tuple[str, ...] = ()
    license: str = ""
    citation: str = ""
    keywords: tuple[str, ...] = (
        "human-AI teaming",
        "adaptive assistance",
        "navigation instructions",
    )


def file_name(study: str, mode: str, table: str) -> str:
    """The name of a table's file: `study-..._session-..._description-..._data.csv`."""
    return f"study-{alphanumeric(study)}_session-{mode}_description-{table}_data.csv"


def alphanumeric(words: str) -> str:
    """Words as one value in a file name: plain letters and digits, or `study` if none are left."""
    plain = unicodedata.normalize("NFKD", words).encode("ascii", "ignore").decode()
    parts = re.findall(r"[A-Za-z0-9]+", plain)
    return "".join(part[0].upper() + part[1:] for part in parts) or "study"


def table_text(row: type[TableRow], rows: Iterable[TableRow]) -> str:
    """A table as CSV with a header."""
    names = [column.name for column in columns(row)]
    return _csv(names, ([_safe(getattr(one, name)) for name in names] for one in rows))


def _safe(value: object) -> str:
    """A cell. Text that a spreadsheet would take for a formula gets an apostrophe before it."""
    text = cell(value)
    return f"'{text}" if isinstance(value, str) and text.lstrip().startswith(_FORMULA) else text


def all_columns(tables: Iterable[type[TableRow]]) -> dict[str, TableColumn]:
    """The columns of all tables by name, in order of first appearance."""
    found: dict[str, TableColumn] = {}
    for row in tables:
        for column in columns(row):
            found.setdefault(column.name, column)
    return found


def description(
    name: str, summary: str, notes: DatasetNotes, tables: Iterable[type[TableRow]]
) -> bytes:
    """dataset_description.json; `summary` describes the dataset in a sentence or two."""
    content: dict[str, Any] = {
        "@context": "http://schema.org/",
        "@type": "Dataset",
        "name": name,
        "description": f"{notes.description} {summary}".strip(),
        "keywords": list(notes.keywords),
        "variableMeasured": [_variable(column) for column in all_columns(tables).values()],
    }
    if notes.authors:
        content["author"] = [{"@type": "Person", "name": author} for author in notes.authors]
    for key in ("license", "citation"):
        if getattr(notes, key):
            content[key] = getattr(notes, key)
    return msgspec.json.format(msgspec.json.encode(content), indent=2) + b"\n"


def codebook_table(tables: Mapping[str, type[TableRow]]) -> str:
    """The codebook as CSV: one row per table and column."""
    header = ["table", "column", "meaning", "unit", "values", "may_be_empty"]
    return _csv(
        header,
        (
            [name, one.name, one.meaning, one.unit, one.values, "yes" if one.optional else "no"]
            for name, row in tables.items()
            for one in columns(row)
        ),
    )


def codebook_page(tables: Mapping[str, type[TableRow]]) -> str:
    """The codebook as Markdown."""
    parts = [
        "# Codebook\n\nAn empty cell means that there is no value: not asked, not answered or not "
        "reached. Line breaks within a text are written as spaces, and a text that a spreadsheet "
        "would take for a formula has an apostrophe before it. Mission times count from the "
        "start of the mission.\n\n"
    ]
    for name, row in tables.items():
        parts.append(f"## {name}\n\n{_paragraphs(getdoc(row) or '')}\n\n")
        parts.append("| column | meaning | unit | values |\n|---|---|---|---|\n")
        for one in columns(row):
            values = f"{one.values}; may be empty" if one.optional else one.values
            cells_ = (f"`{one.name}`", one.meaning, one.unit, values)
            parts.append("| " + " | ".join(cell.replace("|", "\\|") for cell in cells_) + " |\n")
        parts.append("\n")
    return "".join(parts)


def _variable(column: TableColumn) -> dict[str, str]:
    variable = {
        "@type": "PropertyValue",
        "name": column.name,
        "description": f"{column.meaning} Values: {column.values}.",
    }
    return variable | ({"unitText": column.unit} if column.unit else {})


def _paragraphs(text: str) -> str:
    return "\n\n".join(" ".join(paragraph.split()) for paragraph in text.split("\n\n"))


def _csv(header: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\n")
    writer.writerow(header)
    writer.writerows(rows)
    return out.getvalue()
