"""The levels of a mission that somebody finished, for the coach `yoked`."""

from __future__ import annotations

from pathlib import Path

from game.coach.acts import InstructionIssued
from game.coach.yoke import LevelFrom, Yoke
from game.errors import AnaError
from game.journal.history import MissionHistory, read_history
from game.journal.reader import read_journal
from game.journal.records import Allocated
from game.world.building import Building


def yoke_of(path: Path, building: Building, kind: str | None = None) -> Yoke:
    """The levels of the last finished mission in `building` that the journal at `path` holds, led
    by a coach of this kind if one is given.

    Raises JournalError where that is no journal, AnaError where it holds no such mission.
    """
    transcript = read_journal(path)
    finished = [mission for mission in read_history(transcript).missions if mission.end == "ended"]
    here = [
        it
        for it in finished
        if it.started.building_sha256 == building.hash and kind in (None, it.started.coach.kind)
    ]
    if not here:
        played = sorted({mission.started.building for mission in finished})
        raise AnaError(
            f"no mission in {building.name} was finished in this journal",
            place=f"--levels-of {path}",
            hint=f"Give --building for {' or '.join(played)}." if played else "Give another.",
        )
    allocated = [e.record for e in transcript.entries if isinstance(e.record, Allocated)]
    return Yoke(
        transcript.started.session,
        building.hash,
        allocated[-1].memorise_ms if allocated else None,
        levels_of(here[-1]),
    )


def levels_of(mission: MissionHistory) -> tuple[LevelFrom, ...]:
    """The levels that were in force, each from when it was first spoken."""
    levels: list[LevelFrom] = []
    for _, record in mission.happened:
        before = levels[-1].level if levels else None
        if isinstance(record, InstructionIssued) and record.level is not before:
            levels.append(LevelFrom(record.at_ms, record.level))
    return tuple(levels)
