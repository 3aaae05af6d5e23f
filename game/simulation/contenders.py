"""The coaches that can be compared, as they are named on a command line."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TypeVar

import msgspec

from game.coach.api import Briefing, Coach
from game.coach.kinds.ana import Ana
from game.coach.kinds.knowledge import KnowledgeCoach
from game.coach.knowledge.assumed import ASSUMED, Assumed, QuizMark
from game.coach.own import SEPARATOR
from game.coach.presets import FLOODFILL, PRESETS, Preset
from game.coach.registry import KINDS
from game.coach.spec import CoachSpec, build_coach, parse_coach
from game.errors import AnaError, choose_from, did_you_mean

Quiz = dict[str, QuizMark]
"""How a person labelled the rooms, by their true names."""

TRUTH = "truth"
"""A coach who is told what the person truly knows: what the best estimate could be worth."""
TOLD = msgspec.structs.replace(
    ASSUMED, quiz_right=(0.999, 0.001), quiz_wrong=(0.001, 0.999), quiz_blank=(0.001, 0.999)
)
UNMOVED = msgspec.structs.replace(FLOODFILL, agreement=1_000_000, lowers_when_lost=False)
"""A static coach who listens: it evaluates the walk as `ana` does, and never changes its level.
So the comparison also shows what P(g* | path) can tell at each level."""
NAMED = ("ana:PRESET", "static:LEVEL", "knowledge:NUMBER=VALUE", "FILE.py:CLASS")


@dataclass(frozen=True)
class Contender:
    """A coach as it is named on the command line. `spec` is None for those that no journal could
    describe: they are told something about the person (`knowledge+quiz` and `truth`), or are made
    with other numbers (`knowledge` by `assumed`, `ana` by `rule`)."""

    name: str
    spec: CoachSpec | None
    assumed: Assumed = ASSUMED
    rule: Preset | None = None

    def build(self, briefing: Briefing, known: Mapping[str, bool], quiz: Quiz) -> Coach:
        """A new coach for a mission of somebody who knows these rooms and labelled them so."""
        if self.spec is not None:
            return build_coach(self.spec, briefing)
        if self.rule is not None:
            return Ana(briefing, self.rule)
        if self.name == TRUTH:
            truth: Quiz = {name: "right" if knows else "blank" for name, knows in known.items()}
            return KnowledgeCoach(briefing, truth, TOLD)
        told = quiz if self.name == "knowledge+quiz" else None
        return KnowledgeCoach(briefing, told, self.assumed)


def contender(name: str) -> Contender:
    """The coach called `name`. Raises AnaError with the names there are."""
    if name in (TRUTH, "knowledge+quiz"):
        return Contender(name, None)
    kind, colon, choice = name.partition(SEPARATOR)
    if colon and kind == "static" and choice.isdigit():
        level = parse_coach(kind, int(choice)).level
        return Contender(name, None, rule=msgspec.structs.replace(UNMOVED, first_level=level))
    if colon and kind == "knowledge":
        return Contender(name, None, _changed(name, ASSUMED, choice))
    if colon and kind == "ana":
        preset, changes, numbers = choice.partition(";")
        if changes:
            spec = parse_coach(kind, preset=preset)
            return Contender(name, None, rule=_changed(name, PRESETS[spec.preset or ""], numbers))
        return Contender(name, parse_coach(kind, preset=choice))
    known = [it for it in KINDS if "yoke" not in KINDS[it].choices]
    if not colon and name not in known:
        hint = choose_from(name, (*known, TRUTH, *NAMED))
        raise AnaError(f"there is no coach '{name}' to compare", place="--coaches", hint=hint)
    return Contender(name, parse_coach(name))


_Numbers = TypeVar("_Numbers", Assumed, Preset)


def _changed(name: str, before: _Numbers, changes: str) -> _Numbers:
    """`before` with each NUMBER=VALUE of `changes`, parted by semicolons."""
    numbers = msgspec.structs.asdict(before)
    for change in changes.split(";"):
        number, _, value = change.partition("=")
        if not isinstance(numbers.get(number), float):
            hint = did_you_mean(
                number, [it for it, now in numbers.items() if isinstance(now, float)]
            )
            raise AnaError(f"there is no number '{number}' to change", place=name, hint=hint)
        try:
            numbers[number] = float(value)
        except ValueError as error:
            hint = "Write a number, and a semicolon between two changes."
            raise AnaError(f"{number} cannot be '{value}'", place=name, hint=hint) from error
    try:
        return type(before)(**numbers)
    except ValueError as error:
        raise AnaError(str(error), place=name) from error
