"""Reading a journal: strict, except about what a crash leaves; any beginning of one is readable."""

import json
from pathlib import Path
from typing import Any

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from game.journal.journal_error import JournalError
from game.journal.reader import Difference, first_discontinuity, parse_journal, read_journal
from game.journal.records import SCHEMA_VERSION, PhaseStarted, Resumed, SessionStarted
from game.journal.upgrades import UPGRADES
from game.journal.writer import Journal
from game.session.verification import verify_transcript
from tests.session.toy import SETTINGS, opening, played, toy, transcript, write

MISSION = played(until_ms=9_000)
LINES = MISSION.splitlines(keepends=True)


def resumed_after(data: bytes, folder: Path) -> bytes:
    """`data` with a second segment after it."""
    path = write(folder, data)
    journal = Journal.resume(path, None)
    journal.append(PhaseStarted(left_ms=None, continued=True))
    journal.close()
    return path.read_bytes()


def edited(line: int, **fields: Any) -> bytes:
    """The mission with fields of one line (from 1) changed."""
    lines = list(LINES)
    lines[line - 1] = json.dumps(json.loads(lines[line - 1]) | fields).encode() + b"\n"
    return b"".join(lines)


def test_every_record_is_read_as_it_was_written() -> None:
    read = transcript(MISSION)
    assert len(read.entries) == len(LINES)
    assert [entry.line for entry in read.entries] == list(range(1, len(LINES) + 1))
    assert [entry.envelope.seq for entry in read.entries] == list(range(len(LINES)))
    assert read.started == opening()
    assert read.torn_bytes == 0


@given(cut=st.integers(0, len(MISSION)))
@example(cut=len(MISSION) - 1)
@example(cut=len(LINES[0]))
@example(cut=len(LINES[0]) - 1)
def test_any_beginning_of_a_journal_is_readable_and_can_be_resumed(
    tmp_path_factory: pytest.TempPathFactory, cut: int
) -> None:
    data = MISSION[:cut]
    whole = data.count(b"\n")
    if whole == 0:
        with pytest.raises(JournalError, match="has no records"):
            transcript(data)
        return
    read = transcript(data)
    assert read.entries == transcript(MISSION).entries[:whole]
    assert read.torn_bytes == cut - (data.rindex(b"\n") + 1)
    assert verify_transcript(read, build=toy).reproduced
    path = write(tmp_path_factory.mktemp("cut"), data)
    after = resumed_after(data, path.parent)
    again = read_journal(path)
    assert after.startswith(data)
    *before, resumed, last = again.entries
    assert isinstance(resumed.record, Resumed)
    if MISSION[cut : cut + 1] == b"\n":
        assert tuple(before) == transcript(MISSION).entries[: whole + 1], "only its newline lacked"
        assert resumed.record.torn_bytes == 0
    else:
        assert tuple(before) == read.entries
        assert resumed.record.torn_bytes == read.torn_bytes
    assert last.record == PhaseStarted(left_ms=None, continued=True)
    assert verify_transcript(again, build=toy).reproduced


def test_any_beginning_of_a_resumed_journal_is_readable_too(tmp_path: Path) -> None:
    data = resumed_after(MISSION[:-40], tmp_path)
    whole = transcript(data).entries
    for cut in (*range(len(LINES[0]), len(data), 31), *range(len(data) - 700, len(data) + 1)):
        read = transcript(data[:cut])
        assert read.entries == whole[: len(read.entries)]
        assert first_discontinuity(read.entries) is None
        if cut % 97 == 0:
            twice = transcript(resumed_after(data[:cut], tmp_path))
            assert twice.entries[: len(read.entries)] == read.entries
            assert isinstance(twice.entries[len(read.entries)].record, Resumed)


@pytest.mark.parametrize("data", [b"", b"\n", b"seq,segment\n0,0\n", b"\x00" * 64, b"{}", b"[1]"])
def test_a_file_that_is_not_a_journal_is_refused(data: bytes) -> None:
    with pytest.raises(JournalError, match="journal"):
        transcript(data)


def test_an_unreadable_line_is_named() -> None:
    damaged = [*LINES[:5], b'{"seq":5,' + b"\n", *LINES[5:]]
    with pytest.raises(JournalError, match=r"^journal\.jsonl, line 6: this is not a record"):
        transcript(b"".join(damaged))


def test_an_unreadable_last_line_is_a_crash_only_if_it_is_the_beginning_of_one() -> None:
    assert transcript(MISSION + b'{"seq":99,"segm\n').torn_bytes == 15
    with pytest.raises(JournalError, match=f"line {len(LINES) + 1}"):
        transcript(MISSION + b'{"seq"::99}\n')


@pytest.mark.parametrize(
    ("fields", "complaint"),
    [
        ({"type": "dreamt"}, "Invalid value 'dreamt'"),
        ({"seq": "four"}, r"Expected `int`, got `str` - at `\$.seq`"),
        ({"phase": "lunch break"}, "matching regex"),
        ({"utc": "yesterday"}, "utc"),
        ({"outcome": "flew"}, "Invalid enum value 'flew'"),
        ({"position": [1]}, "position"),
    ],
)
def test_a_record_of_another_form_is_refused(fields: dict[str, Any], complaint: str) -> None:
    with pytest.raises(JournalError, match=rf"line 5: this is not a record.*{complaint}"):
        transcript(edited(5, **fields))


REFUSAL = rf"has schema {SCHEMA_VERSION + 1}.*up to {SCHEMA_VERSION}.*Install the version of ana"


def test_a_journal_of_a_newer_game_is_refused_with_a_hint() -> None:
    versions = json.loads(LINES[0])["versions"] | {"schema": SCHEMA_VERSION + 1}
    newer = edited(1, versions=versions, novelty=1, mode="unheard of")
    with pytest.raises(JournalError, match=REFUSAL):
        transcript(newer)


def test_a_journal_of_an_unknown_schema_is_refused() -> None:
    versions = json.loads(LINES[0])["versions"] | {"schema": 0}
    with pytest.raises(JournalError, match="there is no schema 0"):
        transcript(edited(1, versions=versions))


def as_of_old(line: bytes) -> dict[str, Any]:
    """The line in an imagined schema 0, which has `time` for `at_ms`."""
    fields: dict[str, Any] = json.loads(line)
    if "versions" in fields:
        fields["versions"]["schema"] = 0
    if "at_ms" in fields:
        fields["time"] = fields.pop("at_ms") / 1000
    return fields


def to_schema_1(fields: dict[str, Any]) -> dict[str, Any]:
    rest = {name: value for name, value in fields.items() if name != "time"}
    return rest | {"at_ms": round(fields["time"] * 1000)} if "time" in fields else rest


def test_an_earlier_schema_is_read_through_its_upgrade(tmp_path: Path) -> None:
    old = b"".join(json.dumps(as_of_old(line)).encode() + b"\n" for line in LINES)
    read = parse_journal(old, "old", {0: to_schema_1, **UPGRADES})
    assert read.entries[1:] == transcript(MISSION).entries[1:]
    assert isinstance(read.entries[0].record, SessionStarted)
    assert read.entries[0].record.versions.schema == 0
    both = parse_journal(old + resumed_lines(tmp_path), "both", {0: to_schema_1, **UPGRADES})
    assert isinstance(both.entries[-1].record, PhaseStarted), "a later segment has its own schema"


def resumed_lines(folder: Path) -> bytes:
    return resumed_after(MISSION, folder)[len(MISSION) :]


def without(line: int) -> bytes:
    return b"".join(LINES[: line - 1] + LINES[line:])


@pytest.mark.parametrize(
    ("data", "gap"),
    [
        (without(4), Difference(4, "seq", 4, 3)),
        (edited(6, segment=1), Difference(6, "segment", 1, 0)),
        (edited(4, t_ms=9), None),
        (edited(3, t_ms=-1), Difference(3, "t_ms", -1, "at least 0")),
        (MISSION + LINES[0], Difference(len(LINES) + 1, "type", "session_started", None)),
    ],
)
def test_lost_and_gained_lines_are_noticed(
    tmp_path: Path, data: bytes, gap: Difference | None
) -> None:
    found = first_discontinuity(transcript(data).entries)
    path = write(tmp_path, data)
    if gap is None:
        assert found is None
        read_journal(path)
        return
    assert found is not None
    assert (found.line, found.field, found.recorded) == (gap.line, gap.field, gap.recorded)
    with pytest.raises(JournalError, match=f"changed after it was written: line {gap.line}"):
        read_journal(path)


def test_a_missing_journal_is_named(tmp_path: Path) -> None:
    for path in (tmp_path / "none.jsonl", tmp_path):
        with pytest.raises(JournalError, match="cannot be read"):
            read_journal(path)


def test_the_settings_are_checked_on_reading() -> None:
    settings = json.loads(LINES[0])["settings"] | {"moves_per_second": 0}
    assert SETTINGS.moves_per_second == 5
    with pytest.raises(JournalError, match=r"line 1: .*moves_per_second must be between"):
        transcript(edited(1, settings=settings))
