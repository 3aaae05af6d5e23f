"""The JSON schema of a journal's lines, made from the types. `python -m game.journal.schema`."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import msgspec

from game.journal.records import SCHEMA_VERSION, Envelope, Record
from game.places import checkout

SHIPPED = Path("data", "schema", "journal.schema.json")
"""The path of the schema, from the root of the checkout."""


def journal_schema() -> dict[str, Any]:
    """The JSON schema (draft 2020-12) that every line of a journal satisfies."""
    template = "#/$defs/{name}"
    (envelope, record), definitions = msgspec.json.schema_components(
        [Envelope, Record], ref_template=template
    )
    return {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": f"A line of an ana journal, schema version {SCHEMA_VERSION}",
        "description": "The fields of the envelope and those of one record, side by side.",
        "allOf": [envelope, record],
        "$defs": definitions,
    }


def schema_text() -> str:
    """The text of the shipped schema file."""
    return msgspec.json.format(msgspec.json.encode(journal_schema()), indent=2).decode() + "\n"


def main() -> int:
    """Write the shipped schema file; outside a checkout, print it instead."""
    root = checkout()
    if root is None:
        sys.stdout.write(schema_text())
        return 0
    target = root / SHIPPED
    target.parent.mkdir(parents=True, exist_ok=True)
    target.write_text(schema_text(), encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
