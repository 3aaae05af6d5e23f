"""Reading journals: typed and strict, tolerating only what a crash can leave behind.

A line counts if it ends in a newline. Anything after the last newline is ignored, and its length
is reported. A line that is not JSON is accepted right before `resumed`, which follows a crash, and
at the very end if it is the beginning of a line, which a crash while resuming leaves.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any, NamedTuple

import msgspec

from game.journal.journal_error import JournalError, cannot_read
from game.journal.records import SCHEMA_VERSION, Envelope, Record, Resumed, SessionStarted
from game.journal.upgrades import UPGRADES, Upgrade, upgraded


@dataclass(frozen=True, slots=True)
class Entry:
    """One record of a journal, with its line number (from 1)."""

    line: int
    envelope: Envelope
    record: Record


@dataclass(frozen=True)
class Transcript:
    """A journal as read. `torn_bytes` is the length of an unfinished last line, normally 0."""

    source: str
    entries: tuple[Entry, ...]
    torn_bytes: int

    @property
    def started(self) -> SessionStarted:
        first = self.entries[0].record
        assert isinstance(first, SessionStarted)
        return first


@dataclass(frozen=True)
class Difference:
    """The first place where a journal is not as it should be: a field, or a whole record."""

    line: int
    field: str
    recorded: Any
    expected: Any

    def __str__(self) -> str:
        return (
            f"line {self.line}: {self.field} is {_shown(self.recorded)}, "
            f"but should be {_shown(self.expected)}"
        )


def read_journal(path: Path) -> Transcript:
    """The journal at `path`, of this schema or an earlier one.

    Raises JournalError, with the line, if the file is not a journal, was written by a newer game,
    or has lost or gained lines.
    """
    transcript = parse_journal(read_file(path), str(path))
    gap = first_discontinuity(transcript.entries)
    if gap is not None:
        raise JournalError(
            f"the journal was changed after it was written: {gap}",
            place=str(path),
            hint="Use the original file.",
        )
    return transcript


def read_file(path: Path) -> bytes:
    """The bytes of the journal at `path`. Raises JournalError."""
    try:
        return path.read_bytes()
    except OSError as error:
        raise cannot_read(path, error) from error


def parse_journal(
    data: bytes, source: str, upgrades: Mapping[int, Upgrade] = UPGRADES
) -> Transcript:
    """The journal in `data`, with each record checked on its own. Raises JournalError."""
    *lines, tail = data.split(b"\n")
    entries: list[Entry] = []
    broken: list[_Broken] = []
    parser = _Parser(source, upgrades)
    for number, line in enumerate(lines, start=1):
        parsed = parser.parse(number, line)
        if isinstance(parsed, _Broken):
            broken.append(parsed)
            continue
        if broken and not isinstance(parsed.record, Resumed):
            raise parser.refusal(broken[0])
        broken.clear()
        entries.append(parsed)
    for cut in broken:
        if not cut.beginning:
            raise parser.refusal(cut)
    if not entries:
        raise JournalError("this is not a journal: it has no records", place=source, hint=_HINT)
    return Transcript(source, tuple(entries), sum(cut.length for cut in broken) + len(tail))


def first_discontinuity(entries: Sequence[Entry]) -> Difference | None:
    """The first place where `seq`, `segment`, `t_ms` or the opening record breaks the sequence."""
    return next(_discontinuities(entries), None)


def _discontinuities(entries: Sequence[Entry]) -> Iterator[Difference]:
    seq, segment, t_ms = -1, 0, 0
    for entry in entries:
        envelope, opens = entry.envelope, isinstance(entry.record, Resumed)
        if isinstance(entry.record, SessionStarted) is not (seq == -1):
            opening = SessionStarted.__struct_config__.tag
            is_type = entry.record.__struct_config__.tag
            expected = opening if seq == -1 else f"anything but {opening}"
            yield Difference(entry.line, "type", is_type, expected)
        if envelope.seq != seq + 1:
            yield Difference(entry.line, "seq", envelope.seq, seq + 1)
        if envelope.segment != segment + opens:
            yield Difference(entry.line, "segment", envelope.segment, segment + opens)
        if envelope.t_ms < (0 if opens else t_ms):
            yield Difference(entry.line, "t_ms", envelope.t_ms, f"at least {t_ms}")
        seq, segment, t_ms = envelope.seq, envelope.segment, envelope.t_ms


_HINT = "Give a journal.jsonl written by ana."


class _Schema(msgspec.Struct):
    schema: int


class _Head(msgspec.Struct):
    """What every schema version has: a type, and in a segment's opening record its schema."""

    type: str
    versions: _Schema | None = None


@dataclass(frozen=True)
class _Broken:
    """A line that is not JSON; `beginning` is true if it may have been cut short. Every record
    ends in a brace."""

    line: int
    length: int
    beginning: bool
    reason: str


class _Decoders(NamedTuple):
    """Decoders for the type and schema of a line, its envelope and its record."""

    head: msgspec.json.Decoder[_Head]
    envelope: msgspec.json.Decoder[Envelope]
    record: msgspec.json.Decoder[Record]


@cache
def _decoders() -> _Decoders:
    """Made when a journal is first read, so that the start of a mission does not wait for them."""
    return _Decoders(
        msgspec.json.Decoder(_Head),
        msgspec.json.Decoder(Envelope),
        msgspec.json.Decoder(Record),
    )


class _Parser:
    """Reads line after line; segments may differ in their schema."""

    def __init__(self, source: str, upgrades: Mapping[int, Upgrade]) -> None:
        self._source = source
        self._upgrades = upgrades
        self._schema: int | None = None
        self._decode = _decoders()

    def parse(self, number: int, line: bytes) -> Entry | _Broken:
        try:
            head = self._decode.head.decode(line)
            if head.versions is not None:
                self._schema = self._known(head.versions.schema, number)
            if self._schema is None:
                raise self._error(number, "a journal begins with session_started", _HINT)
            if self._schema == SCHEMA_VERSION:
                decode = self._decode
                return Entry(number, decode.envelope.decode(line), decode.record.decode(line))
            fields = upgraded(msgspec.json.decode(line), self._schema, self._upgrades)
            old: Record = msgspec.convert(fields, Record)
            return Entry(number, msgspec.convert(fields, Envelope), old)
        except msgspec.ValidationError as error:
            reason = f"this is not a record of schema {self._schema or SCHEMA_VERSION} ({error})"
            raise self._error(number, reason, _HINT) from error
        except (msgspec.DecodeError, UnicodeDecodeError) as error:
            beginning = not line.endswith(b"}") or "truncated" in str(error)
            return _Broken(number, len(line), beginning, str(error))

    def refusal(self, broken: _Broken) -> JournalError:
        return self._error(broken.line, f"this is not a record ({broken.reason})", _HINT)

    def _known(self, schema: int, number: int) -> int:
        if schema > SCHEMA_VERSION:
            raise self._error(
                number,
                f"the journal has schema {schema}, and this version reads schemas up to "
                f"{SCHEMA_VERSION}",
                "Install the version of ana that wrote it.",
            )
        if any(version not in self._upgrades for version in range(schema, SCHEMA_VERSION)):
            raise self._error(number, f"there is no schema {schema}", _HINT)
        return schema

    def _error(self, number: int, message: str, hint: str) -> JournalError:
        return JournalError(message, place=f"{self._source}, line {number}", hint=hint)


def _shown(value: Any) -> str:
    text = value if isinstance(value, str) else msgspec.json.encode(value).decode()
    return text if len(text) <= 200 else f"{text[:199]}…"
