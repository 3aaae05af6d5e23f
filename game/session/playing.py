"""Beginning and ending a mission together with its journal."""

from __future__ import annotations

from collections.abc import Callable
from datetime import UTC, datetime
from pathlib import Path
from secrets import token_hex
from typing import Literal

from msgspec import structs

from game.coach.api import Briefing, Coach
from game.coach.instructions.phrasebook import Phrasebook
from game.coach.instructions.phrasebook_file import english, text_to_keep
from game.coach.presets import Preset, preset
from game.coach.spec import CoachSpec, assumed_of, build_coach
from game.journal.clock import Clock, SystemClock, VirtualClock
from game.journal.folders import JOURNAL
from game.journal.records import (
    PERSON,
    RULES_VERSION,
    MissionAbandoned,
    MissionStarted,
    SessionEnded,
    SessionStarted,
    Terminal,
)
from game.journal.writer import Journal, versions
from game.session.run import MissionRun, Recorder
from game.world.building import Building
from game.world.mission import Mission
from game.world.settings import MissionSettings
from game.world.variant import USUAL, Variant

CoachBuilder = Callable[[CoachSpec, Briefing], Coach]
"""Builds a coach from its description; pass another to play with a coach of your own."""


def open_free_play(
    settings: MissionSettings,
    seed: int,
    log_dir: Path,
    terminal: Terminal | None,
    *,
    rescuer: str = PERSON,
    clock: Clock | None = None,
) -> Journal:
    """A journal of free play in a new folder of `log_dir`, without a mission yet.

    Raises JournalError if it cannot be written.
    """
    clock = clock or SystemClock()
    began = datetime.fromtimestamp(clock.read().utc_ms / 1000, UTC)
    session = f"{began:%Y%m%dT%H%M%SZ}-{token_hex(3)}"
    opening = _free_play(session, settings, seed, terminal, rescuer)
    return Journal.create(log_dir / session / JOURNAL, opening, clock)


def start_free_play(
    building: Building,
    settings: MissionSettings,
    spec: CoachSpec,
    seed: int,
    log_dir: Path,
    terminal: Terminal | None,
    *,
    rescuer: str = PERSON,
    clock: Clock | None = None,
    build: CoachBuilder = build_coach,
    variant: Variant = USUAL,
    memorised_ms: int = 0,
) -> tuple[MissionRun, Journal]:
    """Begin a mission at 0 ms, with its journal in a new folder of `log_dir`. The map with names
    was shown for `memorised_ms` before.

    Raises JournalError if the journal cannot be written.
    """
    journal = open_free_play(settings, seed, log_dir, terminal, rescuer=rescuer, clock=clock)
    run = begin_mission(
        journal,
        building,
        settings,
        spec,
        seed,
        build=build,
        variant=variant,
        memorised_ms=memorised_ms,
    )
    return run, journal


def start_in_memory(
    building: Building,
    settings: MissionSettings,
    spec: CoachSpec,
    seed: int,
    *,
    rescuer: str,
    path: Path | None = None,
    clock: Clock | None = None,
    build: CoachBuilder = build_coach,
) -> tuple[MissionRun, Journal]:
    """The same for a simulated rescuer; closing the journal writes it to `path` (None: nowhere).

    `clock` is the virtual clock that drives the rescuer; without one, it stays at 0.
    """
    opening = _free_play("simulated", settings, seed, None, rescuer)
    journal = Journal.buffered(path, opening, clock or VirtualClock())
    return begin_mission(journal, building, settings, spec, seed, build=build), journal


def begin_mission(
    journal: Journal,
    building: Building,
    settings: MissionSettings,
    spec: CoachSpec,
    seed: int,
    *,
    phrases: Phrasebook | None = None,
    build: CoachBuilder = build_coach,
    variant: Variant = USUAL,
    memorised_ms: int = 0,
) -> MissionRun:
    """Begin a mission at 0 ms in a journal that is already open. The coach speaks by `phrases`
    (None: the shipped English).

    Outside a study the records belong to the phase `mission`; in a study, to the journal's phase.
    """
    if journal.phase == "session":
        journal.enter("mission")
    run = assemble(building, settings, spec, seed, journal.extend, phrases=phrases, build=build)
    started = mission_started(building, settings, spec, seed, variant, phrases)
    journal.append(structs.replace(started, memorised_ms=memorised_ms))
    run.begin()
    return run


def mission_started(
    building: Building,
    settings: MissionSettings,
    spec: CoachSpec,
    seed: int,
    variant: Variant = USUAL,
    phrases: Phrasebook | None = None,
) -> MissionStarted:
    """The record of everything that determines a mission, except the actions."""
    return MissionStarted(
        building=building.name,
        building_text=building.text,
        building_sha256=building.hash,
        coach=spec,
        preset=preset_of(spec),
        settings=settings,
        seed=seed,
        rules_version=RULES_VERSION,
        assumed=assumed_of(spec),
        variant=variant,
        instructions_text=text_to_keep(phrases),
    )


def preset_of(spec: CoachSpec) -> Preset | None:
    """The coach's whole preset; None for a coach without one."""
    return None if spec.preset is None else preset(spec.preset)


def assemble(
    building: Building,
    settings: MissionSettings,
    spec: CoachSpec,
    seed: int,
    record: Recorder,
    *,
    phrases: Phrasebook | None = None,
    build: CoachBuilder = build_coach,
) -> MissionRun:
    """A mission with its coach, not yet begun; `record` receives everything that happens."""
    coach = build(spec, Briefing(building, settings, seed, phrases or english()))
    return MissionRun(Mission(building, settings), coach, record)


def leave_mission(
    run: MissionRun,
    journal: Journal,
    now_ms: int,
    reason: Literal["quit", "leg_done"] = "quit",
) -> None:
    """Run the mission to `now_ms`, and abandon it there if it has not ended."""
    run.advance(now_ms)
    if not run.ended:
        journal.append(MissionAbandoned(now_ms, reason))


def end_free_play(run: MissionRun, journal: Journal, now_ms: int) -> None:
    """Leave the mission, and end and close its journal."""
    leave_mission(run, journal, now_ms)
    journal.enter("session")
    journal.append(SessionEnded("finished" if run.ended else "quit"))
    journal.close()


def _free_play(
    session: str, settings: MissionSettings, seed: int, terminal: Terminal | None, rescuer: str
) -> SessionStarted:
    return SessionStarted(
        session=session,
        mode="free_play",
        simulated=rescuer != PERSON,
        rescuer=rescuer,
        participant="",
        versions=versions(terminal),
        settings=settings,
        seed=seed,
        terminal=terminal,
    )
