"""Which coach plays a mission, as a value that a journal keeps and a command line gives."""

from __future__ import annotations

from typing import Any

import msgspec

from game.coach.acts import Level
from game.coach.api import Briefing, Coach
from game.coach.knowledge.assumed import ASSUMED, Assumed, QuizMark
from game.coach.own import SEPARATOR, own_coach, source_hash
from game.coach.presets import PRESETS, preset
from game.coach.registry import KINDS, Choice
from game.coach.yoke import Yoke
from game.errors import AnaError, choose_from

OWN = "own"
DEFAULT_LEVEL = Level.C2
DEFAULT_PRESET = "floodfill"

_GIVE: dict[Choice, str] = {
    "level": "give a level",
    "preset": "give a preset",
    "quiz": "give the answers of a label quiz",
    "yoke": "give the levels of a finished mission",
}
_OPTIONS: dict[Choice, str] = {
    "level": "--level",
    "preset": "--preset",
    "quiz": "--coach",
    "yoke": "--levels-of",
}
_NEEDED: dict[Choice, tuple[str, str]] = {
    "quiz": ("the answers of a label quiz", "It plays in studies alone; here give knowledge."),
    "yoke": ("a finished mission to repeat", "Give its journal with --levels-of."),
}


class CoachSpec(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A coach: `kind` is one of `KINDS`, with what may be chosen about it; or `own`, the class in
    `source` (`FILE.py:CLASS`), whose file has the SHA-256 `sha256`. `quiz` is how the rescuer
    labelled each room beforehand, and `yoke` the levels to be repeated.

    Raises ValueError, naming the field, where one is missing, unknown or of no use to the kind.
    """

    kind: str
    level: Level | None = None
    preset: str | None = None
    quiz: dict[str, QuizMark] | None = None
    yoke: Yoke | None = None
    source: str | None = None
    sha256: str | None = None

    def __post_init__(self) -> None:
        own = self.kind == OWN
        if not own and self.kind not in KINDS:
            raise ValueError(f"coach field kind must be one of {', '.join((*KINDS, OWN))}")
        if (self.source is not None, self.sha256 is not None) != (own, own):
            raise ValueError("coach fields source and sha256 belong to the kind own alone")
        choices = () if own else KINDS[self.kind].choices
        for field in _GIVE:
            given = getattr(self, field) is not None
            if given and field not in choices:
                instead = "; " + ", ".join(map(_GIVE.__getitem__, choices)) if choices else ""
                raise ValueError(f"coach field {field}: {self.kind} has none{instead}")
            if field in choices and not given:
                raise ValueError(f"coach field {field}: {self.kind} needs one")
        if self.preset is not None and self.preset not in PRESETS:
            raise ValueError(f"coach field preset must be one of {', '.join(PRESETS)}")


def parse_coach(
    kind: str,
    level: int | None = None,
    preset: str | None = None,
    quiz: dict[str, QuizMark] | None = None,
    yoke: Yoke | None = None,
) -> CoachSpec:
    """The coach that these names mean, with the usual level or preset where none is given.

    Raises AnaError, with the nearest right name, for an unknown name, for something given that the
    coach does not have, and for a quiz or a yoke that it needs. `FILE.py:CLASS` means a coach of
    one's own.
    """
    if SEPARATOR in kind:
        return CoachSpec(OWN, source=kind, sha256=source_hash(kind))
    if kind not in KINDS:
        raise _unknown("coach", kind, tuple(KINDS))
    choices = KINDS[kind].choices
    given: dict[Choice, Any] = {"level": level, "preset": preset, "quiz": quiz, "yoke": yoke}
    for field, value in given.items():
        if value is not None and field not in choices:
            with_it = " or ".join(name for name in KINDS if field in KINDS[name].choices)
            option = _OPTIONS[field]
            raise AnaError(
                f"the coach {kind} has no {field} to choose",
                place=option,
                hint=f"Leave {option} out, or give --coach {with_it} with it.",
            )
        if value is None and field in choices and field in _NEEDED:
            needed, hint = _NEEDED[field]
            raise AnaError(f"the coach {kind} needs {needed}", place="--coach", hint=hint)
    if preset is not None and preset not in PRESETS:
        raise _unknown("preset", preset, tuple(PRESETS))
    if level is not None and level not in tuple(Level):
        raise AnaError(f"there is no level {level}", place="--level", hint="Give 1, 2 or 3.")
    return CoachSpec(
        kind,
        level=Level(level or DEFAULT_LEVEL) if "level" in choices else None,
        preset=(preset or DEFAULT_PRESET) if "preset" in choices else None,
        quiz=quiz,
        yoke=yoke,
    )


def coach_given(kind: str, **offered: Any) -> CoachSpec:
    """The coach `kind` with whatever it takes of what is offered: `level`, `preset`, `quiz`,
    `yoke`. Raises AnaError as `parse_coach` does."""
    choices = KINDS[kind].choices if kind in KINDS else ()
    return parse_coach(kind, **{name: it for name, it in offered.items() if name in choices})


def build_coach(spec: CoachSpec, briefing: Briefing) -> Coach:
    """A new coach for one mission, which knows the briefing and the spec and nothing else.

    Raises AnaError where a coach of one's own cannot be loaded, or the levels to be repeated are
    those of another building.
    """
    if spec.source is not None and spec.sha256 is not None:
        return own_coach(spec.source, spec.sha256, briefing)
    chosen: dict[Choice, Any] = {"level": spec.level, "quiz": spec.quiz, "yoke": spec.yoke}
    if spec.preset is not None:
        chosen["preset"] = preset(spec.preset)
    kind = KINDS[spec.kind]
    return kind.build(briefing, {field: chosen[field] for field in kind.choices})


def assumed_of(spec: CoachSpec) -> Assumed | None:
    """The numbers by which the coach judges knowledge; None for a coach that does not."""
    judges = spec.kind in KINDS and KINDS[spec.kind].panel == "knowledge"
    by_belief = spec.preset is not None and preset(spec.preset).judges == "belief"
    return ASSUMED if judges or by_belief else None


def _unknown(what: str, name: str, names: tuple[str, ...]) -> AnaError:
    return AnaError(
        f"there is no {what} '{name}'", place=f"--{what}", hint=choose_from(name, names)
    )
