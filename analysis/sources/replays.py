"""Each mission of a study as it went: path, levels, words and what the coach concluded, for a page
in which a point leads to the person."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from analysis.sources.absent import Plain
from analysis.sources.study_folder import mode_of
from game.journal.folders import journals
from game.journal.history import building_of
from game.journal.reader import Transcript, read_journal
from game.journal.records import MissionStarted, StudyMode
from game.tables.session_tables import Tables, session_tables

_PARTS = ("actions", "instructions", "levels", "posteriors", "victims")


@dataclass(frozen=True)
class Replays:
    """The missions and the buildings they are in, ready for JSON."""

    buildings: list[Plain]
    missions: list[dict[str, Plain]]


def read_replays(folder: Path, mode: StudyMode | None = None) -> Replays:
    """The missions in the journals of one mode of a study folder.

    Raises SourceError or JournalError naming the place.
    """
    places: dict[str, int] = {}
    buildings: list[Plain] = []
    missions: list[dict[str, Plain]] = []
    for path in journals(folder, mode_of(folder, mode)):
        transcript = read_journal(path)
        tables = session_tables(transcript)
        for number, started in _started(transcript):
            place = places.setdefault(started.building_text, len(places))
            building = building_of(started)
            if place == len(buildings):
                buildings.append(_building(building))
            mission = _mission(tables, number, building)
            if mission is not None:
                mission |= {"building": place, "judged": _judged(transcript, number)}
                missions.append(mission)
    return Replays(buildings, missions)


def _started(transcript: Transcript) -> Iterable[tuple[int, MissionStarted]]:
    """How the last mission of each round began."""
    found: dict[int, MissionStarted] = {}
    for entry in transcript.entries:
        if isinstance(entry.record, MissionStarted) and entry.envelope.round:
            found[entry.envelope.round] = entry.record
    return found.items()


def _judged(transcript: Transcript, number: int) -> Plain:
    """What a coach that keeps one held to be the share of rooms known: [time, share]."""
    found: list[Plain] = []
    for entry in transcript.entries:
        record: Any = entry.record
        if (
            entry.envelope.round == number
            and type(record).__struct_config__.tag == "knowledge_judged"
        ):
            found.append([record.at_ms, round(record.share, 4)])
    return found


def _building(building: Any) -> dict[str, Plain]:
    return {
        "name": building.name,
        "width": building.plan.width,
        "height": building.plan.height,
        "tiles": "".join(map(str, building.plan.tiles)),
        "rooms": [[room.name, *room.label] for room in building.rooms],
    }


def _mission(tables: Tables, number: int, building: Any) -> dict[str, Plain] | None:
    row = next((row for row in tables.rounds if row.round == number), None)
    if row is None or not row.counts:
        return None
    every: Mapping[str, Iterable[Any]] = {name: tables.table(name) for name in _PARTS}
    own = {name: [one for one in rows if one.round == number] for name, rows in every.items()}
    sites = {site.id: site for site in building.victims}
    levels = own["levels"]
    return {
        "participant": row.participant,
        "round": number,
        "adaptivity": row.adaptivity,
        "start": list(building.start),
        "duration": levels[-1].until_ms if levels else 0,
        "path": [[step.at_ms, step.x, step.y] for step in _steps(own["actions"], building.start)],
        "levels": [[span.from_ms, str(span.level)] for span in levels],
        "words": [[one.at_ms, one.text] for one in own["instructions"]],
        "known": [[one.at_ms, round(one.comprehension, 4)] for one in own["posteriors"]],
        "victims": [
            [str(one.severity), *sites[one.victim].cell, str(one.fate), one.fate_ms]
            for one in own["victims"]
        ],
    }


def _steps(actions: Iterable[Any], start: tuple[int, int]) -> Iterable[Any]:
    """The actions that changed the place."""
    at = tuple(start)
    for action in actions:
        if (action.x, action.y) != at:
            at = (action.x, action.y)
            yield action
