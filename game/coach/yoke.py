"""The levels of a mission that somebody finished, for a coach that repeats them."""

from __future__ import annotations

import msgspec

from game.coach.acts import Level


class LevelFrom(msgspec.Struct, frozen=True, array_like=True):
    """From `at_ms` of the mission on the coach spoke at `level`."""

    at_ms: int
    level: Level


class Yoke(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """The levels that were spoken, in order of time, in a mission of `session`, played in the
    building with the hash `building_sha256` by somebody who had memorised it for `memorise_ms`
    (None in free play). Raises ValueError where there are none."""

    session: str
    building_sha256: str
    memorise_ms: int | None
    levels: tuple[LevelFrom, ...]

    def __post_init__(self) -> None:
        if not self.levels:
            raise ValueError("yoke field levels must not be empty")

    def level_at(self, at_ms: int) -> Level:
        """The level in force at `at_ms`."""
        begun = [step.level for step in self.levels if step.at_ms <= at_ms]
        return begun[-1] if begun else self.levels[0].level
