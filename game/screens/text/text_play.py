"""`ana play --text`: a mission from the lines of one stream to another."""

from __future__ import annotations

import os
import signal
import sys
from collections.abc import Iterable, Iterator
from contextlib import suppress
from pathlib import Path
from types import FrameType
from typing import TextIO

from game.coach.spec import CoachSpec
from game.journal.history import MissionHistory, building_of, read_history
from game.journal.reader import read_journal
from game.journal.sink import FileSink
from game.journal.writer import Journal
from game.screens.text.phrases import clock_words
from game.screens.text.surroundings import rooms_of
from game.screens.text.text_mission import HeardEvents, TextMission
from game.session.playing import start_free_play
from game.world.building import Building, Severity
from game.world.settings import MissionSettings
from game.world.variant import USUAL, Variant

STATUS_INTERRUPTED = 130
_LEAVE = "Leave the mission? Type quit again to leave, or anything else to stay."


def play_text(
    building: Building,
    settings: MissionSettings,
    spec: CoachSpec,
    seed: int,
    log_dir: Path,
    lines: Iterable[str],
    out: TextIO,
    *,
    memorise_ms: int = 0,
    variant: Variant = USUAL,
    about: str = "",
) -> int:
    """Play a mission by `lines`, telling it to `out`; the exit status. The end of the lines, or an
    interrupt, leaves the mission. With `memorise_ms` it is first told where the rooms are; `about`
    says what sets the mission apart.

    Raises JournalError if the journal cannot be written.
    """
    run, journal = start_free_play(
        building, settings, spec, seed, log_dir, None,
        build=HeardEvents.build, memorised_ms=memorise_ms, variant=variant,
    )  # fmt: skip
    assert isinstance(run.coach, HeardEvents)
    mission = TextMission(run, run.coach, journal, lambda line: print(line, file=out, flush=True))
    _record_signals(journal)
    status = 0
    try:
        before = [f"{about}."] if about else []
        for line in (*before, *(rooms_of(building) if memorise_ms else ())):
            print(line, file=out, flush=True)
        mission.begin()
        _take_all(mission, lines, out)
    except KeyboardInterrupt:
        status = STATUS_INTERRUPTED
    except BrokenPipeError:
        mission.end()
        raise
    mission.end()
    for line in _outcome(journal):
        print(line, file=out, flush=True)
    return status


def typed_lines() -> Iterator[str]:
    """What is typed, line by line, with a prompt where somebody types."""
    if not sys.stdin.isatty():
        yield from sys.stdin
        return
    with suppress(ImportError):
        import readline  # noqa: F401
    with suppress(EOFError):
        while True:
            yield input("> ")


def _take_all(mission: TextMission, lines: Iterable[str], out: TextIO) -> None:
    asked = False
    for line in lines:
        wants = line.strip().lower() in ("q", "quit", "leave", "exit")
        if wants and not asked:
            print(_LEAVE, file=out, flush=True)
            asked = True
            continue
        if asked and not wants:
            print("You stay.", file=out, flush=True)
        asked = False
        mission.take(line)
        if mission.over:
            return


def _record_signals(journal: Journal) -> None:
    """A hang-up or a request to end is recorded; everything else is written already."""

    def note(number: int, _frame: FrameType | None) -> None:
        with suppress(Exception):
            journal.interrupt(signal.Signals(number).name)
        os._exit(128 + number)

    with suppress(ValueError):
        for number in (signal.SIGHUP, signal.SIGTERM):
            signal.signal(number, note)


def _outcome(journal: Journal) -> Iterator[str]:
    assert isinstance(journal.sink, FileSink)
    path = journal.sink.path
    yield from outcome(read_history(read_journal(path)).missions[-1])
    yield f"Journal: {path}"


def outcome(played: MissionHistory) -> Iterator[str]:
    """What a mission came to, in sentences."""
    building = building_of(played.started)
    rules = played.started.settings
    sites = {site.id: site for site in building.victims}
    saved = [sites[victim] for victim, (fate, _) in played.fates.items() if fate == "rescued"]
    reds = sum(site.severity is Severity.RED for site in saved)
    over = "The mission is over."
    if played.end == "abandoned":
        over = f"You left after {clock_words(played.until_ms)}."
    points = sum(rules.points(site.severity) for site in saved)
    told = f", {points} points" if rules.show_score else ""
    yield (
        f"{over} {len(saved)} of {len(sites)} rescued: {reds} red, {len(saved) - reds} blue{told}."
    )
    for victim, (fate, at_ms) in sorted(played.fates.items(), key=lambda it: it[1][1]):
        if fate == "rescued":
            room = building.room_of(sites[victim])
            where = room.name if room is not None else "hallway"
            yield f"{clock_words(at_ms)}: a {sites[victim].severity} victim, {where}."
