"""The coaches that come with `ana`: what each is, what it takes, and what the replay shows of it.

To add one, write its module in `game/coach/kinds` and a line here.
"""

from __future__ import annotations

from collections.abc import Mapping
from importlib import import_module
from types import MappingProxyType
from typing import Any, Literal, NamedTuple

from game.coach.api import Briefing, Coach

Choice = Literal["level", "preset", "quiz", "yoke"]
"""What may be chosen about a coach: a field of `CoachSpec`, and a keyword of its class."""

Panel = Literal["level", "posterior", "knowledge"]
"""What the panel beside a mission shows of a coach: its level and goal, and P(g*), or what it holds
the rescuer to know, as well."""


class CoachKind(NamedTuple):
    """A kind of coach. `target` is `module:name`; it is called with the briefing and what
    may be chosen, and imported only then, so that the game opens without waiting for it."""

    name: str
    summary: str
    target: str
    choices: tuple[Choice, ...]
    panel: Panel

    def build(self, briefing: Briefing, chosen: Mapping[Choice, Any]) -> Coach:
        """A new coach of this kind for one mission."""
        module, _, name = self.target.partition(":")
        made: Coach = getattr(import_module(module), name)(briefing, **dict(chosen))
        return made


_KINDS = (
    CoachKind("ana", "adapts its level", "game.coach.kinds.ana:ana", ("preset",), "posterior"),
    CoachKind(
        "static", "keeps one level", "game.coach.kinds.static:StaticCoach", ("level",), "level"
    ),
    CoachKind(
        "pace", "keeps one level, learns the pace", "game.coach.kinds.pace:PaceCoach", ("level",),
        "level",
    ),
    CoachKind(
        "knowledge", "adapts to the rooms you know", "game.coach.kinds.knowledge:KnowledgeCoach",
        (), "knowledge",
    ),
    CoachKind(
        "knowledge+quiz", "the same, told how the quiz went",
        "game.coach.kinds.knowledge:KnowledgeCoach", ("quiz",), "knowledge",
    ),
    CoachKind(
        "yoked", "repeats the levels of another mission", "game.coach.kinds.yoked:YokedCoach",
        ("yoke",), "level",
    ),
)  # fmt: skip
KINDS = MappingProxyType({kind.name: kind for kind in _KINDS})
