"""The missions in a journal: what began each, what happened in it, and how it came to its end."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Literal, NamedTuple

from game.journal.reader import Entry, Transcript
from game.journal.records import MissionAbandoned, MissionStarted, Resumed, RunRecord, SessionEnded
from game.world.events import MissionEnded


class Happening(NamedTuple):
    """A mission event or coach record, and the line it stands in."""

    line: int
    record: RunRecord


@dataclass
class RecordedMission:
    """One mission as its journal has it.

    `end` is `ended`, `abandoned` (its player left it at `until_ms`), `cut` (its process ended;
    what fell due by then may be missing) or `dropped` (the session went on without either, which
    no game does). `until_ms` is the mission time up to which it runs.
    """

    line: int
    started: MissionStarted
    happened: list[Happening] = field(default_factory=list)
    end: Literal["ended", "abandoned", "cut", "dropped"] = "cut"
    until_ms: int = 0


def missions(transcript: Transcript) -> tuple[RecordedMission, ...]:
    """The missions of a journal, in order."""
    return _sorted_out(transcript.entries)[0]


def strays(transcript: Transcript) -> tuple[Entry, ...]:
    """Mission events and coach records that stand outside every mission; there should be none."""
    return _sorted_out(transcript.entries)[1]


def _sorted_out(
    entries: Sequence[Entry],
) -> tuple[tuple[RecordedMission, ...], tuple[Entry, ...]]:
    found: list[RecordedMission] = []
    outside: list[Entry] = []
    current: RecordedMission | None = None
    for entry in entries:
        record = entry.record
        if isinstance(record, MissionStarted):
            _drop(current)
            current = RecordedMission(entry.line, record)
            found.append(current)
        elif isinstance(record, RunRecord):
            if current is None:
                outside.append(entry)
                continue
            current.happened.append(Happening(entry.line, record))
            current.until_ms = max(current.until_ms, record.at_ms)
            if isinstance(record, MissionEnded):
                current.end = "ended"
        elif isinstance(record, MissionAbandoned) and current is not None:
            current.end, current.until_ms = "abandoned", record.at_ms
            current = None
        elif isinstance(record, SessionEnded):
            _drop(current)
            current = None
        elif isinstance(record, Resumed):
            current = None
    return tuple(found), tuple(outside)


def _drop(mission: RecordedMission | None) -> None:
    if mission is not None and mission.end == "cut":
        mission.end = "dropped"
