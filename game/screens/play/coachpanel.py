"""What the coach believes: P(g*) against its thresholds, or which rooms the rescuer knows and how
long the leg will take; the level, and b^HR."""

from __future__ import annotations

from collections.abc import Sequence
from typing import ClassVar

from game.coach.acts import ChoiceReason, CoachRecord, KnowledgeJudged, PosteriorEvaluated
from game.coach.api import Briefing, Coach
from game.coach.listening import ListenedCoach
from game.coach.registry import KINDS
from game.coach.spec import CoachSpec, build_coach
from game.journal.thoughts import Thoughts
from game.screens.widgets.canvas import BLANK, Canvas, Row, Run, beside
from game.screens.widgets.minimap import Pin
from game.world.building import Building, VictimSite
from game.world.events import MissionEvent
from game.world.geometry import Cell
from game.world.observation import Observation
from game.world.picture import VICTIM_SIGNS

_STEPS = (0.05, 0.2, 0.4, 0.7)
"""Where the colour of a victim's posterior changes."""
_KNOWN = (0.2, 0.4, 0.6, 0.8)
"""The same for a room by P(known)."""
LISTED = 5
"""So many victims are listed, the most likely first."""
_WHY: dict[ChoiceReason, str] = {
    "soonest": "expected to be soonest",
    "stays": "another gains too little",
    "looks_lost": "seems not to know the way",
    "lost": "has not come nearer",
    "asked": "you asked for it",
}
BAR_COLUMNS = 12
"""The longest bar of an expected time."""


class OverheardCoach(ListenedCoach):
    """A coach whose records are kept as `thoughts`, for a panel beside a live mission."""

    def __init__(self, coach: Coach, spec: CoachSpec) -> None:
        super().__init__(coach)
        self.spec = spec
        self.thoughts = Thoughts()

    @classmethod
    def build(cls, spec: CoachSpec, briefing: Briefing) -> OverheardCoach:
        return cls(build_coach(spec, briefing), spec)

    def begin(self, observation: Observation) -> list[CoachRecord]:
        return self._heard(super().begin(observation))

    def on_event(self, event: MissionEvent, observation: Observation) -> list[CoachRecord]:
        return self._heard(super().on_event(event, observation))

    def evaluate(self, at_ms: int, observation: Observation) -> list[CoachRecord]:
        return self._heard(super().evaluate(at_ms, observation))

    def _heard(self, records: list[CoachRecord]) -> list[CoachRecord]:
        for record in records:
            self.thoughts = self.thoughts.after(record)
        return records


def coach_pins(thoughts: Thoughts, building: Building) -> dict[Cell, Pin]:
    """On the map, as tenths: how likely the rescuer knows each room, or walks to each victim."""
    if thoughts.judged is not None:
        known = thoughts.judged.known
        return {
            room.label: _pin(known[room.name], _KNOWN)
            for room in building.rooms
            if room.name in known
        }
    if thoughts.evaluation is None:
        return {}
    pins = {}
    for victim in building.victims:
        chance = thoughts.evaluation.posterior.get(victim.id)
        if chance is not None:
            pins[victim.cell] = _pin(chance, _STEPS)
    return pins


def _pin(chance: float, steps: Sequence[float]) -> Pin:
    step = sum(chance >= limit for limit in steps)
    return str(min(9, int(10 * chance))), f"likely-{step}"


def coach_rows(
    thoughts: Thoughts, building: Building, columns: int, *, infers: bool = True
) -> list[Row]:
    """The panel, `columns` wide: two blocks side by side where there is room. `infers` is whether
    the coach asks where the rescuer is walking to."""
    if thoughts.judged is not None:
        left = [*_level(thoughts, building), *_knows(thoughts.judged)]
        if columns < 48:
            return [*left, *_expected(thoughts.judged)]
        return beside(left, _expected(thoughts.judged), 27)
    if not infers:
        level, goal = _level(thoughts, building)
        return [level, goal, (("does not judge the walk", "quiet"),), *_belief(thoughts)]
    left = [*_level(thoughts, building), *_comprehension(thoughts), *_belief(thoughts)]
    if columns < 48:
        return [*left, BLANK, *_listed(thoughts, building, columns)]
    half = 27
    return beside(left, _listed(thoughts, building, columns - half), half)


def _level(thoughts: Thoughts, building: Building) -> list[Row]:
    if thoughts.level is None:
        return [(("The coach has not spoken", "quiet"),), BLANK]
    level: list[Run] = [(f" C{int(thoughts.level)} ", "badge")]
    issued = thoughts.instruction
    if issued is not None and issued.fallback:
        level.append((f" shown as C{int(issued.shown_level)}", "quiet"))
    victims = {victim.id: victim for victim in building.victims}
    goal: Row = (("no goal", "quiet"),)
    if thoughts.goal is not None:
        goal = (("→ ", "quiet"), *_named(victims[thoughts.goal], building, 22))
    return [tuple(level), goal]


def _knows(judged: KnowledgeJudged) -> list[Row]:
    """What the rescuer is held to know, and why this level was chosen."""
    rows: list[Row] = []
    if judged.room is not None:
        chance = judged.known[judged.room]
        rows.append((("knows this room ", "quiet"), (f"{chance:.2f}", _pin(chance, _KNOWN)[1])))
    share: Row = (("knows of all ", "quiet"), (f"{judged.share:.2f}", "strong"))
    return [*rows, share, ((_WHY[judged.why], "quiet"),)]


def _expected(judged: KnowledgeJudged) -> list[Row]:
    """How long the leg is expected to take at each level, as bars; the chosen one stands out."""
    longest_ms = max(judged.expected_ms.values(), default=1.0)
    rows: list[Row] = [(("Expected time", "title"),)] if judged.expected_ms else []
    for name, ms in judged.expected_ms.items():
        style = "middle" if name == judged.chosen.name else "quiet"
        full = max(1, round(BAR_COLUMNS * ms / longest_ms))
        rows.append(((f"{name} {'█' * full} {ms / 1000:.0f} s", style),))
    return rows


def _comprehension(thoughts: Thoughts) -> list[Row]:
    """P(g*) as a bar with marks at the two thresholds."""
    evaluation = thoughts.evaluation
    if evaluation is None:
        return [(("has not judged the walk", "quiet"),), BLANK]
    verdict = "no evidence" if evaluation.verdict == "none" else evaluation.verdict
    return [
        (("P(g*) ", "quiet"), (f"{evaluation.comprehension:.2f}", _zone(evaluation)),
         (f"  {verdict}", "quiet")),
        gauge(evaluation, 23),
    ]  # fmt: skip


def gauge(evaluation: PosteriorEvaluated, columns: int) -> Row:
    """P(g*) from 0 to 1 as a bar, `┃` at each threshold."""
    full = round(columns * evaluation.comprehension)
    marks = {
        min(columns - 1, int(columns * limit))
        for limit in (evaluation.lower_below, evaluation.raise_above)
    }
    zone = _zone(evaluation)
    return tuple(
        ("┃", "mark") if at in marks else ("█", zone) if at < full else ("░", "faint")
        for at in range(columns)
    )


def _zone(evaluation: PosteriorEvaluated) -> str:
    if evaluation.comprehension < evaluation.lower_below:
        return "low"
    return "high" if evaluation.comprehension > evaluation.raise_above else "middle"


def _belief(thoughts: Thoughts) -> list[Row]:
    """b^HR in numbers: what the coach thinks the rescuer knows."""
    known = f"knows {_counted(len(thoughts.rooms_known), 'room')}"
    seen = _counted(len(thoughts.victims_known), "victim")
    rows: list[Row] = [((f"{known}, {seen}", "quiet"),)]
    if thoughts.ms_per_move is not None:
        rows.append(((f"{thoughts.ms_per_move / 1000:.2f} s a step", "quiet"),))
    else:
        missteps = _counted(thoughts.missteps, "misstep")
        rows.append(((f"{missteps}, {thoughts.disobeyed} not followed", "quiet"),))
    return rows


def _counted(number: int, thing: str) -> str:
    return f"{number} {thing}" if number == 1 else f"{number} {thing}s"


def _listed(thoughts: Thoughts, building: Building, columns: int) -> list[Row]:
    """The most likely goals of the rescuer, by the posterior."""
    rows: list[Row] = [(("Walking to", "title"),)]
    if thoughts.evaluation is None:
        return rows
    victims = {victim.id: victim for victim in building.victims}
    ranked = sorted(thoughts.evaluation.posterior.items(), key=lambda item: (-item[1], item[0]))
    for victim, chance in ranked[:LISTED]:
        step = sum(chance >= limit for limit in _STEPS)
        name = _named(victims[victim], building, columns - 5)
        rows.append(((f"{chance:4.2f} ", f"likely-{step}"), *name))
    return rows


def _named(victim: VictimSite, building: Building, columns: int) -> Sequence[Run]:
    room = building.room_of(victim)
    mark = (f"{VICTIM_SIGNS[victim.severity]} ", str(victim.severity))
    name = room.name if room is not None else "hallway"
    return mark, (name[: columns - 2], "strong")


class CoachPanel(Canvas):
    """Shows the coach's thoughts."""

    COMPONENT_CLASSES: ClassVar[set[str]] = {
        "badge", "quiet", "strong", "faint", "title", "mark", "low", "middle", "high", "red",
        "blue", *(f"likely-{step}" for step in range(len(_STEPS) + 1)),
    }  # fmt: skip

    def __init__(self, building: Building, spec: CoachSpec) -> None:
        super().__init__(id="coach")
        self._building = building
        kind = KINDS.get(spec.kind)
        self._infers = kind is None or kind.panel == "posterior"
        self._thoughts = Thoughts()

    def show(self, thoughts: Thoughts) -> None:
        """Draw these thoughts."""
        self._thoughts = thoughts
        columns = self.size.width
        self.draw(coach_rows(thoughts, self._building, columns, infers=self._infers))

    def on_resize(self) -> None:
        self.show(self._thoughts)
