"""Writes the golden journals of the present schema: `python -m tests.journal.golden`.

Once a schema has been released its golden journals are never written again.
"""

from pathlib import Path
from typing import Any, get_args

import msgspec

from game.coach.spec import CoachSpec
from game.journal.clock import VirtualClock
from game.journal.records import SCHEMA_VERSION, MissionStarted, Record, Resumed, SessionStarted
from game.journal.sink import MemorySink
from game.journal.writer import Journal
from game.session.playing import mission_started
from tests.session.toy import HUT, SETTINGS, opening, played

FOLDER = Path(__file__).resolve().parents[1] / "data" / "journals"


def every_record() -> bytes:
    """A journal, of no possible session, with one record of each kind."""
    sink, clock = MemorySink(), VirtualClock()
    journal = Journal(sink, clock)
    journal.append(opening())
    apart = (SessionStarted, Resumed, MissionStarted)
    for kind in get_args(Record):
        if kind not in apart:
            clock.now_ms += 1_000
            journal.append(_made_up(kind))
    later = Journal(sink, clock, seq=len(get_args(Record)) - 2, segment=1)
    later.append(_made_up(Resumed))
    later.append(mission_started(HUT, SETTINGS, CoachSpec("ana", preset="calibrated"), 7))
    return bytes(sink.data)


def _made_up(kind: type[msgspec.Struct]) -> Any:
    schema = msgspec.json.schema(kind)
    return msgspec.convert(_value(schema, schema["$defs"]), kind)


def _value(schema: dict[str, Any], definitions: dict[str, Any]) -> Any:
    """A small value that satisfies the schema."""
    if "$ref" in schema:
        return _value(definitions[schema["$ref"].rsplit("/", 1)[1]], definitions)
    if "anyOf" in schema:
        return _value(schema["anyOf"][0], definitions)
    if "enum" in schema:
        return schema["enum"][0]
    match schema.get("type"):
        case "object":
            fields = schema.get("properties", {})
            return {name: _value(fields[name], definitions) for name in fields}
        case "array":
            items = schema.get("prefixItems") or [schema["items"]]
            return [_value(item, definitions) for item in items]
        case "integer":
            return schema.get("default", 1)
        case "number":
            return schema.get("default", 0.5)
        case "boolean":
            return True
        case "null":
            return None
        case _:
            return "words"


def main() -> None:
    FOLDER.mkdir(parents=True, exist_ok=True)
    named = {"mission": played(), "every-record": every_record()}
    for name, data in named.items():
        (FOLDER / f"schema-{SCHEMA_VERSION}-{name}.jsonl").write_bytes(data)


if __name__ == "__main__":
    main()
