"""The rules of Psych-DS, applied to a folder: https://psychds-docs.readthedocs.io.

What the public validator calls an error is one here, and so are unofficial keywords.
"""

from __future__ import annotations

import csv
import json
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

FILE_NAME = re.compile(r"([a-z]+-[a-zA-Z0-9]+)(_[a-z]+-[a-zA-Z0-9]+)*_data\.csv")
OFFICIAL = {
    "study", "site", "subject", "session", "task", "condition", "trial", "stimulus", "description",
}  # fmt: skip
IGNORE_FILES = (".psychds-ignore", ".psychdsignore")
ELSEWHERE = {"analysis", "documentation", "materials", "products", "results"}
LOOSE_FILES = {"dataset_description.json", "README.md", "CHANGES.md", *IGNORE_FILES}


def broken_rules(dataset: Path) -> list[str]:
    """Everything in the dataset that Psych-DS does not allow."""
    return list(_broken(dataset))


def _broken(dataset: Path) -> Iterator[str]:
    try:
        about = json.loads((dataset / "dataset_description.json").read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        yield f"dataset_description.json: {error}"
        return
    yield from _description(about)
    yield from _files(dataset)
    tables = sorted((dataset / "data").rglob("*.csv"))
    if not tables:
        yield "there are no data files"
    found: set[str] = set()
    for table in tables:
        yield from _name(table.name)
        header: list[str] = []
        yield from _table(table, header)
        found.update(header)
    measured = [one if isinstance(one, str) else one["name"] for one in about["variableMeasured"]]
    if len(set(measured)) < len(measured):
        yield "variableMeasured names a column twice"
    for column in sorted(found ^ set(measured)):
        where = "no data file" if column in measured else "not in variableMeasured"
        yield f"column {column}: {where}"


def _description(about: dict[str, Any]) -> Iterator[str]:
    if str(about.get("@context")).replace("https", "http").rstrip("/") != "http://schema.org":
        yield "@context is not schema.org"
    if about.get("@type") != "Dataset":
        yield "@type is not Dataset"
    for key in ("name", "description"):
        if not (isinstance(about.get(key), str) and about[key]):
            yield f"{key} is missing"
    if not isinstance(about.get("variableMeasured"), list):
        yield "variableMeasured is no list"
    for one in about.get("variableMeasured", []):
        if isinstance(one, dict) and one.get("@type", one.get("type")) != "PropertyValue":
            yield f"{one} is no PropertyValue"


def _files(dataset: Path) -> Iterator[str]:
    """Files that a validator would look at without knowing them."""
    ignored = [
        line
        for name in IGNORE_FILES
        if (dataset / name).exists()
        for line in (dataset / name).read_text().splitlines()
    ]
    for path in dataset.rglob("*"):
        place = path.relative_to(dataset).as_posix()
        if path.is_dir() or place in LOOSE_FILES or place.split("/")[0] in ELSEWHERE:
            continue
        if any(place.startswith(folder) for folder in ignored):
            continue
        if not (place.startswith("data/") and place.endswith("_data.csv")):
            yield f"{place} is not checked by anything"


def _name(name: str) -> Iterator[str]:
    if FILE_NAME.fullmatch(name) is None:
        yield f"{name}: not keyword-value_..._data.csv"
    for pair in name.removesuffix("_data.csv").split("_"):
        if pair.partition("-")[0] not in OFFICIAL:
            yield f"{name}: {pair} has no official keyword"


def _table(path: Path, header: list[str]) -> Iterator[str]:
    with path.open(encoding="utf-8", newline="") as file:
        rows = list(csv.reader(file, strict=True))
    if not rows:
        yield f"{path.name}: no header"
        return
    header += rows[0]
    if len(set(header)) < len(header) or "" in header:
        yield f"{path.name}: a column has no name, or two have the same"
    for number, row in enumerate(rows[1:], start=2):
        if len(row) != len(header):
            yield f"{path.name}: row {number} has {len(row)} cells"
    if "row_id" in header:
        place = header.index("row_id")
        ids = [row[place] for row in rows[1:]]
        if len(set(ids)) < len(ids):
            yield f"{path.name}: row_id is not unique"
