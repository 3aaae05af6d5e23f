"""Whose levels a yoked instructor repeats: those of another mission in the same building."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from msgspec.structs import replace

from game.coach.acts import Level
from game.coach.yoke import LevelFrom, Yoke
from game.errors import AnaError
from game.journal.folders import JOURNAL, SESSIONS
from game.journal.records import StudyMode
from game.session.yoking import yoke_of
from game.study.chance import digest
from game.study.instructors import Instructor
from game.world.building import Building

NOBODY = "nobody"
"""The session of levels that nobody was told: C2 from beginning to end."""


def donated(
    folder: Path,
    modes: Iterable[StudyMode],
    participant: str,
    building: Building,
    instructor: Instructor,
    seed: int,
) -> Yoke:
    """The levels of a finished mission in `building`, led by `instructor`, of another participant
    of the study in `folder`, in the first of the `modes` that has one.

    Which one is drawn by the seed. The session is not named: its participant may withdraw. Where
    nobody has finished such a mission yet, the level is C2 throughout.
    """
    for mode in modes:
        homes = [it for it in (folder / SESSIONS / mode).glob("*/") if it.name != participant]
        for home in sorted(homes, key=lambda it: digest(seed, "donor", building.hash, it.name)):
            try:
                found = yoke_of(home / JOURNAL, building, instructor.kind)
            except AnaError:
                continue
            return replace(found, session=digest(seed, found.session).hex()[:12])
    return Yoke(NOBODY, building.hash, None, (LevelFrom(0, Level.C2),))
