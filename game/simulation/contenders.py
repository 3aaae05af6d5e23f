"""The coaches that can be compared, as they are named on a command line."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import msgspec

from game.coach.acts import Level
from game.coach.api import Briefing, Coach
from game.coach.kinds.ana import Ana
from game.coach.kinds.knowledge import KnowledgeCoach
from game.coach.knowledge.assumed import ASSUMED, QuizMark
from game.coach.own import SEPARATOR
from game.coach.presets import FLOODFILL
from game.coach.registry import KINDS
from game.coach.spec import CoachSpec, build_coach, parse_coach
from game.errors import AnaError, choose_from

Quiz = dict[str, QuizMark]
"""How a person labelled the rooms, by their true names."""

TRUTH = "truth"
"""A coach who is told what the person truly knows: what the best estimate could be worth."""
TOLD = msgspec.structs.replace(
    ASSUMED, quiz_right=(0.999, 0.001), quiz_wrong=(0.001, 0.999), quiz_blank=(0.001, 0.999)
)
LISTENING = "listening"
"""A coach who keeps one level and evaluates the walk all the same, as `ana` does: what P(g* | path)
can tell at that level."""
UNMOVED = msgspec.structs.replace(FLOODFILL, agreement=1_000_000, lowers_when_lost=False)
NAMED = ("ana:PRESET", "static:LEVEL", "FILE.py:CLASS")


@dataclass(frozen=True)
class Contender:
    """A coach as it is named on the command line. `spec` is None for those that are told something
    about the person (`knowledge+quiz` and `truth`), and for `listening:LEVEL`."""

    name: str
    spec: CoachSpec | None

    def build(self, briefing: Briefing, known: Mapping[str, bool], quiz: Quiz) -> Coach:
        """A new coach for a mission of somebody who knows these rooms and labelled them so."""
        if self.spec is not None:
            return build_coach(self.spec, briefing)
        kind, _, level = self.name.partition(SEPARATOR)
        if kind == LISTENING:
            return Ana(briefing, msgspec.structs.replace(UNMOVED, first_level=Level(int(level))))
        if self.name == TRUTH:
            truth: Quiz = {name: "right" if knows else "blank" for name, knows in known.items()}
            return KnowledgeCoach(briefing, truth, TOLD)
        return KnowledgeCoach(briefing, quiz)


def contender(name: str) -> Contender:
    """The coach called `name`. Raises AnaError with the names there are."""
    if name in (TRUTH, "knowledge+quiz"):
        return Contender(name, None)
    kind, colon, choice = name.partition(SEPARATOR)
    if colon and kind == "static" and choice.isdigit():
        return Contender(name, parse_coach(kind, int(choice)))
    if colon and kind == LISTENING and choice in ("1", "2", "3"):
        return Contender(name, None)
    if colon and kind == "ana":
        return Contender(name, parse_coach(kind, preset=choice))
    known = [it for it in KINDS if "yoke" not in KINDS[it].choices]
    if not colon and name not in known:
        hint = choose_from(name, (*known, TRUTH, *NAMED))
        raise AnaError(f"there is no coach '{name}' to compare", place="--coaches", hint=hint)
    return Contender(name, parse_coach(name))
