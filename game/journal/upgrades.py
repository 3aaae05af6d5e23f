"""Reading journals of earlier schemas as if they had today's.

To change the schema: increase `SCHEMA_VERSION`, add to `UPGRADES` a pure function that turns the
fields of a record of the previous version into those of the new one, and keep a golden journal of
the old version in `tests/data/journals/`.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from game.journal.records import SCHEMA_VERSION

Fields = dict[str, Any]
"""One line of a journal as plain JSON values: the fields of the envelope and of the record."""

Upgrade = Callable[[Fields], Fields]

UPGRADES: Mapping[int, Upgrade] = {1: lambda fields: fields}
"""From schema version n to n + 1, for every version before the present one. Schema 2 only added:
kinds of records, and fields with defaults."""


def upgraded(fields: Fields, schema: int, upgrades: Mapping[int, Upgrade]) -> Fields:
    """The fields of a record written under `schema`, as the present schema has them.

    Raises KeyError if there is no upgrade from `schema`.
    """
    for version in range(schema, SCHEMA_VERSION):
        fields = upgrades[version](fields)
    return fields
