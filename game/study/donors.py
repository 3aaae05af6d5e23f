"""Whose levels a yoked instructor repeats: those of another mission in the same building."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
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
    memorise_ms: int,
    seed: int,
) -> Yoke:
    """The levels of a finished mission in `building`, led by `instructor`, of another participant
    of the study in `folder`.

    Whoever memorised the building for as long comes before all others, and then the first of the
    `modes` that has one; which one is drawn by the seed. The session is not named: its participant
    may withdraw. Where nobody has finished such a mission yet, the level is C2 throughout.
    """
    found = list(_donors(folder, modes, participant, building, instructor, seed))
    for yoke in (*(it for it in found if it.memorise_ms == memorise_ms), *found):
        return replace(yoke, session=digest(seed, yoke.session).hex()[:12])
    return Yoke(NOBODY, building.hash, None, (LevelFrom(0, Level.C2),))


def without_donor(
    folder: Path, buildings: Sequence[Building], instructor: Instructor
) -> tuple[str, ...]:
    """The names of the buildings in which no pilot has finished a mission led by `instructor`."""
    return tuple(
        building.name
        for building in buildings
        if not any(_donors(folder, ("pilot",), "", building, instructor, 0))
    )


def _donors(
    folder: Path,
    modes: Iterable[StudyMode],
    participant: str,
    building: Building,
    instructor: Instructor,
    seed: int,
) -> Iterator[Yoke]:
    """What others than the participant could lend, mode by mode, in an order drawn by the seed."""
    for mode in modes:
        homes = [it for it in (folder / SESSIONS / mode).glob("*/") if it.name != participant]
        for home in sorted(homes, key=lambda it: digest(seed, "donor", building.hash, it.name)):
            try:
                yield yoke_of(home / JOURNAL, building, instructor.kind)
            except AnaError:
                continue
