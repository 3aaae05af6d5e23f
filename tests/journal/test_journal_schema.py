"""The shipped schema matches the types; golden journals satisfy it and can be read."""

import json
from pathlib import Path
from typing import Any, get_args

import msgspec
import pytest

from game.journal.reader import read_journal
from game.journal.records import SCHEMA_VERSION, Envelope, Record
from game.journal.schema import SHIPPED, journal_schema, schema_text
from game.session.replay import Replay
from game.session.verification import verify
from tests.session.toy import toy

ROOT = Path(__file__).resolve().parents[2]
GOLDEN = ROOT / "tests" / "data" / "journals"
KINDS: tuple[type[msgspec.Struct], ...] = get_args(Record)


def lines(path: Path) -> list[dict[str, Any]]:
    return [json.loads(line) for line in path.read_bytes().splitlines()]


def validator() -> Any:
    import jsonschema  # it takes a second

    return jsonschema.Draft202012Validator(journal_schema())


def test_the_shipped_schema_is_current() -> None:
    shipped = (ROOT / SHIPPED).read_text(encoding="utf-8")
    assert shipped == schema_text(), "run `make schema`"


def test_the_schema_is_a_valid_json_schema() -> None:
    validator().check_schema(journal_schema())


@pytest.mark.parametrize("name", ["mission", "every-record"])
def test_the_golden_journals_satisfy_it(name: str) -> None:
    check = validator()
    for schema in range(1, SCHEMA_VERSION + 1):
        for line in lines(GOLDEN / f"schema-{schema}-{name}.jsonl"):
            check.validate(line)


@pytest.mark.parametrize(
    "spoil",
    [
        {"type": "dreamt"},
        {"seq": "four"},
        {"utc": "2026-01-01"},
        {"phase": "lunch break"},
        {"at_ms": None},
        {"position": [1, 2, 3]},
    ],
)
def test_a_spoilt_line_does_not_satisfy_it(spoil: dict[str, Any]) -> None:
    acted = next(
        line for line in lines(GOLDEN / "schema-1-mission.jsonl") if line["type"] == "acted"
    )
    check = validator()
    assert check.is_valid(acted)
    assert not check.is_valid(acted | spoil)
    for field in ("seq", "t_ms", "utc", "at_ms", "action"):
        assert not check.is_valid({name: acted[name] for name in acted if name != field})


def test_golden_journals_of_every_schema_version_are_read() -> None:
    for schema in range(1, SCHEMA_VERSION + 1):
        paths = sorted(GOLDEN.glob(f"schema-{schema}-*.jsonl"))
        assert paths
        for path in paths:
            read = read_journal(path)
            assert read.started.versions.schema == schema
            assert len(read.entries) == len(lines(path))


def test_the_golden_mission_reproduces_and_replays() -> None:
    path = GOLDEN / f"schema-{SCHEMA_VERSION}-mission.jsonl"
    assert verify(path, build=toy).difference is None
    replay = Replay(read_journal(path))
    replay.seek(replay.duration_ms)
    observation = replay.observation()
    assert observation.ended
    assert observation.rescued == 2


def test_the_other_golden_journal_has_every_kind_of_record() -> None:
    read = read_journal(GOLDEN / f"schema-{SCHEMA_VERSION}-every-record.jsonl")
    assert {type(entry.record) for entry in read.entries} == set(KINDS)


@pytest.mark.parametrize("kind", KINDS, ids=lambda kind: str(kind.__name__))
def test_no_record_has_a_field_of_the_envelope(kind: type[msgspec.Struct]) -> None:
    assert not set(Envelope.__struct_fields__) & set(kind.__struct_fields__)
    assert "type" not in kind.__struct_fields__


def test_no_two_records_share_a_name() -> None:
    names = [kind.__struct_config__.tag for kind in KINDS]
    assert len(set(names)) == len(names)


def test_the_documentation_names_every_record_and_every_field_of_the_envelope() -> None:
    words = (ROOT / "docs" / "journal.md").read_text(encoding="utf-8")
    tags = [str(kind.__struct_config__.tag) for kind in KINDS]
    missing = [name for name in (*tags, *Envelope.__struct_fields__) if f"`{name}`" not in words]
    assert missing == []
