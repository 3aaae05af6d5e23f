"""Verification: playing a journal's missions again from their actions gives the same records."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from hashlib import sha256
from math import isclose
from pathlib import Path
from typing import Any

import msgspec

from game.coach.instructions.phrasebook_file import phrasebook_of
from game.coach.spec import assumed_of, build_coach
from game.errors import AnaError
from game.journal.history import MissionHistory, building_of, read_history
from game.journal.journal_error import JournalError
from game.journal.reader import (
    Difference,
    Entry,
    Transcript,
    first_discontinuity,
    parse_journal,
    read_file,
)
from game.journal.records import RELEASES, RULES_VERSION, RunRecord
from game.session.playing import CoachBuilder, assemble, preset_of
from game.session.run import MissionRun
from game.world.events import Acted, LevelAsked

TOLERANCE = 1e-9
"""Real numbers may differ by this much, absolutely or relatively; all else must be equal."""

NOTHING = "nothing"
"""Stands for a missing record in a `Difference`."""


@dataclass(frozen=True)
class Verification:
    """The outcome: how much was recomputed, and the first difference, if there is one."""

    source: str
    missions: int
    records: int
    torn_bytes: int
    difference: Difference | None

    @property
    def reproduced(self) -> bool:
        return self.difference is None


def verify(path: Path, *, build: CoachBuilder = build_coach) -> Verification:
    """Verify the journal at `path`. Raises JournalError if it is not one."""
    return verify_transcript(parse_journal(read_file(path), str(path)), build=build)


def verify_transcript(transcript: Transcript, *, build: CoachBuilder = build_coach) -> Verification:
    """Verify a journal whose lines were each read, but not yet compared with each other."""
    history = read_history(transcript)
    played = history.missions
    differences = (
        first_discontinuity(transcript.entries),
        next((_stray(entry) for entry in history.strays), None),
        next((found for mission in played if (found := _first(mission, build))), None),
    )
    return Verification(
        transcript.source,
        len(played),
        sum(len(mission.happened) for mission in played),
        transcript.torn_bytes,
        _first_of(*differences),
    )


def verify_files(
    paths: Iterable[Path],
    echo: Callable[[str], object],
    *,
    build: CoachBuilder = build_coach,
) -> int:
    """Verify the journals one by one, and report on each in one line.

    Returns 0 if all reproduce, 1 if one differs, 2 if one is not a journal.
    """
    status = 0
    for path in paths:
        try:
            outcome = verify(path, build=build)
        except JournalError as error:
            echo(str(error))
            status = 2
            continue
        echo(_told(outcome))
        if not outcome.reproduced:
            status = max(status, 1)
    return status


def _told(outcome: Verification) -> str:
    if outcome.difference is not None:
        return f"{outcome.source}: differs: {outcome.difference}"
    number = f"{outcome.missions} mission{'' if outcome.missions == 1 else 's'}"
    torn = f" (an unfinished last line of {outcome.torn_bytes} bytes is ignored)"
    return (
        f"{outcome.source}: {number}, {outcome.records} records reproduced"
        f"{torn if outcome.torn_bytes else ''}"
    )


def _first_of(*differences: Difference | None) -> Difference | None:
    return min(filter(None, differences), key=lambda found: found.line, default=None)


def _stray(entry: Entry) -> Difference:
    return Difference(entry.line, "type", type_of(entry.record), NOTHING)


def _first(mission: MissionHistory, build: CoachBuilder) -> Difference | None:
    return _unplayable(mission) or _replayed(mission, build)


def _unplayable(mission: MissionHistory) -> Difference | None:
    """The field of `mission_started` that makes an identical replay impossible, if any."""
    started = mission.started
    sha256_of_text = sha256(started.building_text.encode()).hexdigest()
    if started.rules_version != RULES_VERSION:
        release = RELEASES.get(started.rules_version, "another version")
        wanted = f"{RULES_VERSION}; {release} verifies these"
        return Difference(mission.line, "rules_version", str(started.rules_version), wanted)
    must_agree: tuple[tuple[str, Any, Any], ...] = (
        ("building_sha256", started.building_sha256, sha256_of_text),
        ("preset", started.preset, preset_of(started.coach)),
        ("assumed", started.assumed, assumed_of(started.coach)),
    )
    for field, recorded, expected in must_agree:
        if recorded != expected:
            return next(_differing(mission.line, field, recorded, expected))
    return None


def _replayed(mission: MissionHistory, build: CoachBuilder) -> Difference | None:
    started = mission.started
    again: list[RunRecord] = []
    try:
        building = building_of(started)
        phrases = phrasebook_of(started.instructions_text)
        run = assemble(
            building, started.settings, started.coach, started.seed, again.extend,
            phrases=phrases, build=build,
        )  # fmt: skip
    except (AnaError, ValueError) as error:
        return Difference(mission.line, "mission_started", str(error), "a mission to play")
    refused = _play(run, mission)
    return _first_of(refused, _compared(mission, again))


def _play(run: MissionRun, mission: MissionHistory) -> Difference | None:
    """Play the mission's actions; returns the first that cannot be carried out, if any."""
    run.begin()
    line = mission.line
    try:
        for happening in mission.happened:
            line, record = happening
            if isinstance(record, Acted):
                run.act(record.action, record.at_ms, record.pressed_ms)
            elif isinstance(record, LevelAsked):
                run.ask_level(record.want, record.at_ms)
        run.advance(mission.until_ms)
    except ValueError as error:
        return Difference(line, type_of(record), str(error), "what can be carried out")
    return None


def _compared(mission: MissionHistory, again: Sequence[RunRecord]) -> Difference | None:
    """The first record that differs from the one recomputed in its place."""
    line = mission.line
    for place, (line, recorded) in enumerate(mission.happened):
        expected = again[place] if place < len(again) else None
        if recorded != expected and (found := _difference(line, recorded, expected)):
            return found
    if mission.end != "cut" and len(again) > len(mission.happened):
        return Difference(line + 1, "type", NOTHING, type_of(again[len(mission.happened)]))
    if mission.end == "dropped":
        return Difference(line + 1, "type", NOTHING, "mission_ended or mission_abandoned")
    return None


def _difference(line: int, recorded: RunRecord, expected: RunRecord | None) -> Difference | None:
    wanted = NOTHING if expected is None else type_of(expected)
    if type_of(recorded) != wanted:
        return Difference(line, "type", type_of(recorded), wanted)
    return next(_differing(line, type_of(recorded), recorded, expected), None)


def _differing(line: int, field: str, recorded: Any, expected: Any) -> Iterator[Difference]:
    """Every field, named by its path, in which two records or values differ."""
    for path, old, new in _leaves(msgspec.to_builtins(recorded), msgspec.to_builtins(expected)):
        yield Difference(line, ".".join((field, *path)), old, new)


def _leaves(old: Any, new: Any) -> Iterator[tuple[tuple[str, ...], Any, Any]]:
    """The places where two plain JSON values differ, with their paths."""
    if isinstance(old, float) and isinstance(new, float):
        if not isclose(old, new, rel_tol=TOLERANCE, abs_tol=TOLERANCE):
            yield (), old, new
        return
    if isinstance(old, dict) and isinstance(new, dict):
        pairs = [(str(key), old.get(key, NOTHING), new.get(key, NOTHING)) for key in old | new]
    elif isinstance(old, list | tuple) and isinstance(new, list | tuple) and len(old) == len(new):
        pairs = [(str(place), *both) for place, both in enumerate(zip(old, new, strict=True))]
    else:
        pairs = []
        if old != new:
            yield (), old, new
    for key, before, after in pairs:
        for path, *values in _leaves(before, after):
            yield (key, *path), *values


def type_of(record: msgspec.Struct) -> str:
    """The `type` a record is written with."""
    return str(record.__struct_config__.tag)
