"""What a simulated rescuer who follows every word reaches in the same mission."""

from __future__ import annotations

from functools import lru_cache

from game.coach.spec import CoachSpec
from game.errors import AnaError
from game.rescuers.catalogue import LITERAL, character
from game.rescuers.driver import drive
from game.session.playing import start_in_memory
from game.world.building import Building
from game.world.settings import MissionSettings


@lru_cache(maxsize=32)
def literal_rescues(
    building: Building, rules: MissionSettings, spec: CoachSpec, seed: int
) -> int | None:
    """How many a literal reader rescues; None where the coach cannot be built here. Takes a second
    or two the first time."""
    try:
        run, _ = start_in_memory(building, rules, spec, seed, rescuer=LITERAL)
    except AnaError:
        return None
    drive(run, character(LITERAL).make(building, rules, seed))
    return run.mission.rescued
