"""Which coach plays a mission, as a value that a journal keeps and a command line gives.

The coaches themselves are imported when one is built: the game opens without waiting for them.
"""

from __future__ import annotations

from difflib import get_close_matches
from typing import Literal, get_args

import msgspec

from game.coach.acts import Level
from game.coach.api import Briefing, Coach
from game.coach.own import SEPARATOR, own_coach, source_hash
from game.coach.presets import PRESETS, preset
from game.errors import AnaError

CoachKind = Literal["static", "ana", "pace", "own"]

DEFAULT_LEVEL = Level.C2
DEFAULT_PRESET = "calibrated"


class CoachSpec(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A coach: `ana` adapts its level as the preset says; `static` and `pace` keep theirs; `own`
    is the class in `source` (`FILE.py:CLASS`), whose file has the SHA-256 `sha256`.

    Raises ValueError, naming the field, where one is missing, unknown or of no use to the kind.
    """

    kind: CoachKind
    level: Level | None = None
    preset: str | None = None
    source: str | None = None
    sha256: str | None = None

    def __post_init__(self) -> None:
        own = self.kind == "own"
        if (self.source is not None, self.sha256 is not None) != (own, own):
            raise ValueError("coach fields source and sha256 go with the kind own, and only there")
        if own:
            if self.level is not None or self.preset is not None:
                raise ValueError(
                    "coach fields level and preset mean nothing to a coach of one's own"
                )
        elif self.kind == "ana":
            if self.level is not None:
                raise ValueError("coach field level: ana finds its own; give a preset instead")
            if self.preset not in PRESETS:
                raise ValueError(f"coach field preset must be one of {', '.join(PRESETS)}")
        else:
            if self.preset is not None:
                raise ValueError(f"coach field preset: {self.kind} has none; give a level instead")
            if self.level is None:
                raise ValueError(f"coach field level: {self.kind} needs one")


def parse_coach(kind: str, level: int | None = None, preset: str | None = None) -> CoachSpec:
    """The coach that these names mean, with the usual level or preset where none is given.

    Raises AnaError, with the nearest right name, for a name that is none, and for a level or a
    preset that the coach does not have. `FILE.py:CLASS` means a coach of one's own.
    """
    if SEPARATOR in kind:
        return CoachSpec("own", source=kind, sha256=source_hash(kind))
    kinds = {name: name for name in get_args(CoachKind) if name != "own"}
    if kind not in kinds:
        raise _unknown("coach", kind, tuple(kinds))
    if kind == "ana":
        if level is not None:
            mend = "Leave --level out, or give --coach static with it."
            raise AnaError("the coach ana finds the level itself", place="--level", mend=mend)
        chosen = DEFAULT_PRESET if preset is None else preset
        if chosen not in PRESETS:
            raise _unknown("preset", chosen, tuple(PRESETS))
        return CoachSpec("ana", preset=chosen)
    if preset is not None:
        mend = "Leave --preset out, or give --coach ana with it."
        raise AnaError(f"the coach {kind} has no presets", place="--preset", mend=mend)
    chosen_level = DEFAULT_LEVEL if level is None else level
    if chosen_level not in tuple(Level):
        raise AnaError(f"there is no level {level}", place="--level", mend="Give 1, 2 or 3.")
    return CoachSpec(kinds[kind], level=Level(chosen_level))


def build_coach(spec: CoachSpec, briefing: Briefing) -> Coach:
    """A new coach for one mission, which knows the briefing and nothing else.

    Raises AnaError where a coach of one's own cannot be loaded.
    """
    from game.coach.coaches import AdaptiveCoach, PaceCoach, StaticCoach

    if spec.source is not None and spec.sha256 is not None:
        return own_coach(spec.source, spec.sha256, briefing)
    if spec.preset is not None:
        return AdaptiveCoach(briefing, preset(spec.preset))
    assert spec.level is not None
    return (PaceCoach if spec.kind == "pace" else StaticCoach)(briefing, spec.level)


def _unknown(what: str, name: str, names: tuple[str, ...]) -> AnaError:
    near = get_close_matches(name.casefold(), names, n=1)
    choice = f"Did you mean {near[0]}? " if near else ""
    mend = f"{choice}There are {', '.join(names)}."
    return AnaError(f"there is no {what} '{name}'", place=f"--{what}", mend=mend)
