"""What all coaches share: goals, instructions, missteps, corrections, and a bar that is never
stale. How a coach learns and adapts is left to its two processes (see `game.coach.coaches`)."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Sequence
from typing import Generic, Literal, TypeVar

from game.coach.acts import (
    CoachRecord,
    Disobeyed,
    GoalSet,
    InstructionCompleted,
    InstructionIssued,
    Level,
    Misstep,
    NothingLeft,
    NoticeTakenDown,
)
from game.coach.api import Briefing
from game.coach.belief import Belief, belief_change
from game.coach.compliance import NOTHING_ASKED, STRICT_LEVELS, fits, reached, track
from game.coach.cycle import AdaptiveCycle, InfluenceProcess, LearningProcess
from game.coach.instructions import Instruction, Pose, Scene, correction, instruct
from game.coach.instructions.notices import WRONG_WAY
from game.coach.model import HumanModel
from game.coach.route import RoutePlanner
from game.world.building import Severity, VictimSite
from game.world.events import (
    Acted,
    Action,
    Expired,
    MissionEvent,
    Outcome,
    Rescued,
    TreatmentBroken,
    TreatmentStarted,
)
from game.world.geometry import Cell
from game.world.observation import Guidance, Observation

_IssueReason = Literal["goal", "completed", "level", "off_path", "misstep", "heeded", "resumed"]
_GoalReason = Literal["start", "rescued", "expired", "too_late", "strayed", "other_rescued"]

ALL_SAFE = "All victims are safe."
NOBODY_IN_TIME = "No victim can be reached in time."
TOO_LATE = "It is too late for that victim."
ANOTHER_FIRST = "Another victim comes first now."
_NOTICES: dict[_GoalReason, str] = {
    "expired": TOO_LATE,
    "too_late": TOO_LATE,
    "strayed": ANOTHER_FIRST,
}
"""What is said of a goal that is given up before its victim was treated."""

STRAY_GAIN_MOVES = 5
"""After a misstep another goal is set only if it saves somebody more, or so many moves. Whoever has
strayed by less than half of that cannot gain as much, and the route is not planned anew."""

State = TypeVar("State")
Occasion = Literal["step", "instruction", "every"]
"""When a coach may evaluate and adapt: after a move; when an instruction has been completed or a
misstep made; when its time has come."""


class Guide(ABC, Generic[State]):
    """A coach that leads from victim to victim along a route, by an adaptive cycle.

    A subclass gives the two processes and the state the influence process acts on, says which
    level that state means, and may answer to the occasions below.
    """

    def __init__(
        self,
        briefing: Briefing,
        learning: LearningProcess,
        influence: InfluenceProcess[State, State],
        state: State,
    ) -> None:
        self._building, self._settings = briefing.building, briefing.settings
        self._floodfills = self._building.terrain.floodfills
        self._waiting = {site.id: site for site in self._building.victims}
        self._planner = RoutePlanner(
            self._floodfills, self._settings, self._waiting, seed=briefing.seed
        )
        model = HumanModel.of(self._building, self._settings, self._floodfills)
        self._cycle = AdaptiveCycle(model, learning, influence)
        self._state = state
        self._guidance = Guidance("")
        self._route: tuple[str, ...] = ()
        self._nearest = 0
        self._instruction: Instruction | None = None
        self._number = 0
        self._carried_out = False
        self._track: frozenset[Pose] = frozenset()
        self._compliance = NOTHING_ASKED
        self._treated_instead: set[str] = set()
        self._treated: str | None = None
        self._meant: str | None = None
        self._any_lost = False
        self._see_waiting()

    # --- what a coach of its own kind says -------------------------------------------------------

    @property
    @abstractmethod
    def level(self) -> Level:
        """The level in force."""

    @property
    def ms_per_move(self) -> int:
        """How long a move is taken to last when a route is planned."""
        return self._settings.pace_ms

    @property
    def next_evaluation_ms(self) -> int | None:
        return None

    def _goal_set(self, goal: str, position: Cell) -> None:
        """The rescuer is led to `goal` from now on."""

    def _goal_ended(self, at_ms: int, *, rescued: bool) -> list[CoachRecord]:
        """The goal is given up, or (`rescued`) a rescue ends it."""
        return []

    def _adapt(self, occasion: Occasion, at_ms: int) -> list[CoachRecord]:
        return []

    # --- the surface of a coach ------------------------------------------------------------------

    @property
    def guidance(self) -> Guidance:
        return self._guidance

    def begin(self, observation: Observation) -> list[CoachRecord]:
        before = self._cycle.model.belief.state
        self._cycle.begin(observation)
        pose = Pose(observation.position, observation.heading)
        return [*self._belief_since(before, 0), *self._set_goal(0, pose, "start")]

    def told(self, event: MissionEvent, observation: Observation) -> list[CoachRecord]:
        before = self._cycle.model.belief.state
        self._cycle.observe(event, observation)
        records = self._belief_since(before, event.at_ms)
        pose = Pose(observation.position, observation.heading)
        match event:
            case Acted():
                records += self._acted(event, observation)
            case TreatmentStarted(victim=victim):
                records += self._treating(event.at_ms, victim, observation)
            case TreatmentBroken():
                records += self._broken(event.at_ms, pose)
            case Rescued(victim=victim):
                records += self._rescued(event.at_ms, pose, victim)
            case Expired(victim=victim):
                records += self._expired(event.at_ms, pose, victim)
        return records

    def evaluate(self, at_ms: int, observation: Observation) -> list[CoachRecord]:
        if self._instruction is None:
            return []
        pose = Pose(observation.position, observation.heading)
        return [*self._adapt("every", at_ms), *self._follow_level(at_ms, pose)]

    def _belief_since(self, before: Belief, at_ms: int) -> list[CoachRecord]:
        change = belief_change(before, self._cycle.model.belief.state, at_ms)
        return [] if change is None else [change]

    # --- what happened ---------------------------------------------------------------------------

    def _acted(self, event: Acted, observation: Observation) -> list[CoachRecord]:
        instruction, at_ms = self._instruction, event.at_ms
        pose = Pose(event.position, event.heading)
        if instruction is None:
            return []
        records = self._adapt("step", at_ms) if event.outcome is Outcome.MOVED else []
        if self._carried_out:
            return records
        if self._hopeless(instruction.goal, pose.cell, at_ms):
            return records + self._give_up(at_ms, pose, "too_late")
        if event.action is Action.TRIAGE:
            return records + self._follow_level(at_ms, pose)
        distance = self._to_go(pose.cell, instruction.goal)
        self._nearest = min(self._nearest, distance)
        self._compliance = self._compliance.acted(distance)
        heeded = self._compliance.heeded and bool(self._guidance.notice)
        if heeded:
            self._guidance = Guidance(instruction.text)
            records.append(NoticeTakenDown(at_ms, self._number))
        if reached(instruction, pose):
            records += self._completed(at_ms)
            return records + self._issue(at_ms, pose, "completed")
        if self._compliance.misstep:
            return records + self._misstep(at_ms, pose, instruction)
        if self._misleads(instruction, pose, observation):
            return records + self._issue(at_ms, pose, "off_path")
        if heeded and instruction.shown_level in STRICT_LEVELS:
            return records + self._issue(at_ms, pose, "heeded")
        return records + self._follow_level(at_ms, pose)

    def _misleads(self, instruction: Instruction, pose: Pose, observation: Observation) -> bool:
        """Whether words that were meant for another pose no longer hold.

        Those of C3 hold anywhere, but for those within the goal's room, which do not name it. The
        approach to a victim that was found holds in its room. Whoever goes astray is left to turn
        back, until it is a misstep.
        """
        level = instruction.shown_level
        if level is Level.C3:
            return self._left_room(instruction, pose)
        if pose in self._track or self._compliance.rising:
            return False
        return level is Level.C1 or not self._approaching(observation)

    def _left_room(self, instruction: Instruction, pose: Pose) -> bool:
        """Whether the rescuer was told the rest in the goal's room, and is not there any more."""
        room_at = self._building.room_at
        room = room_at(instruction.start.cell)
        wanted = self._building.room_of(self._waiting[instruction.goal])
        return room is not None and room is wanted and room_at(pose.cell) is not room

    def _approaching(self, observation: Observation) -> bool:
        instruction, room_at = self._instruction, self._building.room_at
        if instruction is None or not instruction.treats:
            return False
        goal = self._waiting[instruction.goal].cell
        shown = (*observation.victims, *observation.remembered)
        found = any(victim.cell == goal for victim in shown)
        return found and room_at(observation.position) is room_at(goal)

    def _misstep(self, at_ms: int, pose: Pose, instruction: Instruction) -> list[CoachRecord]:
        compliance = self._compliance
        shown = instruction.shown_level
        records: list[CoachRecord] = [Misstep(at_ms, self._number, shown, compliance.excess)]
        if compliance.disobeys(at_ms):
            records.append(Disobeyed(at_ms, self._number, "repeat_misstep"))
        self._compliance = compliance.corrected(at_ms)
        records += self._adapt("instruction", at_ms)
        better = self._better_route(at_ms, pose.cell)
        if better is not None:
            return records + self._give_up(at_ms, pose, "strayed", better)
        notice = correction(self._scene, instruction, pose) or WRONG_WAY
        return records + self._issue(at_ms, pose, "misstep", notice)

    def _treating(self, at_ms: int, victim: str, observation: Observation) -> list[CoachRecord]:
        instruction, self._treated = self._instruction, victim
        if instruction is None:
            return []
        in_view = {seen.cell for seen in observation.victims}
        if fits(self._scene, instruction, victim, in_view):
            self._meant = victim
            return self._completed(at_ms)
        if victim in self._treated_instead:
            return []
        self._treated_instead.add(victim)
        return [Disobeyed(at_ms, self._number, "other_victim")]

    def _broken(self, at_ms: int, pose: Pose) -> list[CoachRecord]:
        self._treated = self._meant = None
        return self._issue(at_ms, pose, "resumed") if self._carried_out else []

    def _rescued(self, at_ms: int, pose: Pose, victim: str) -> list[CoachRecord]:
        del self._waiting[victim]
        self._treated = None
        self._see_waiting()
        if self._instruction is None:
            return []
        reason: _GoalReason = "rescued" if victim == self._meant else "other_rescued"
        return self._give_up(at_ms, pose, reason)

    def _expired(self, at_ms: int, pose: Pose, victim: str) -> list[CoachRecord]:
        del self._waiting[victim]
        self._any_lost = True
        self._see_waiting()
        if self._instruction is None or victim != self._instruction.goal:
            return []
        return self._give_up(at_ms, pose, "expired")

    # --- goals -----------------------------------------------------------------------------------

    def _give_up(
        self, at_ms: int, pose: Pose, reason: _GoalReason, route: Sequence[str] | None = None
    ) -> list[CoachRecord]:
        rescued = reason in ("rescued", "other_rescued")
        return [
            *self._goal_ended(at_ms, rescued=rescued),
            *self._set_goal(at_ms, pose, reason, route),
        ]

    def _set_goal(
        self, at_ms: int, pose: Pose, reason: _GoalReason, route: Sequence[str] | None = None
    ) -> list[CoachRecord]:
        self._meant = None
        self._route = tuple(route or self._planned(at_ms, pose.cell))
        if not self._route:
            self._instruction = None
            notice = NOBODY_IN_TIME if self._waiting or self._any_lost else ALL_SAFE
            self._guidance = Guidance("", notice)
            return [NothingLeft(at_ms, notice)]
        goal = self._route[0]
        self._nearest = self._to_go(pose.cell, goal)
        self._goal_set(goal, pose.cell)
        room = self._building.room_of(self._waiting[goal])
        name = room.name if room else None
        records: list[CoachRecord] = [GoalSet(at_ms, goal, name, self._route, reason)]
        records += self._issue(at_ms, pose, "goal", _NOTICES.get(reason, ""))
        if goal == self._treated:
            self._meant = goal
            records += self._completed(at_ms)
        return records

    def _planned(self, at_ms: int, position: Cell) -> Sequence[str]:
        """The best route; where it is empty, the nearest victim that is not beyond hope."""
        route = self._planner.plan(
            position, at_ms, self._waiting, ms_per_move=self.ms_per_move, before=self._route
        )
        if route.order:
            return route.order
        hopeful = [v for v in self._waiting if not self._hopeless(v, position, at_ms)]
        hopeful.sort(key=lambda v: self._to_go(position, v))
        return hopeful[:1]

    def _better_route(self, at_ms: int, position: Cell) -> Sequence[str] | None:
        """A route to another goal that is clearly better than to go on to this one."""
        distance = self._to_go(position, self._route[0])
        if 2 * (distance - self._nearest) < STRAY_GAIN_MOVES:
            return None
        self._nearest, pace = distance, self.ms_per_move
        best = self._planner.plan(
            position, at_ms, self._waiting, ms_per_move=pace, before=self._route
        )
        if not best.order or best.order[0] == self._route[0]:
            return None
        kept = self._planner.along(self._route, position, at_ms, ms_per_move=pace)
        return best.order if best.saves(kept, STRAY_GAIN_MOVES * pace) else None

    def _to_go(self, position: Cell, victim: str) -> int:
        """D of a waiting victim's cell, in cells."""
        return self._floodfills.distance(position, self._waiting[victim].cell)

    def _hopeless(self, victim: str, position: Cell, at_ms: int) -> bool:
        """Whether a red victim will expire before even the fastest keys could treat it."""
        site, settings = self._waiting[victim], self._settings
        if site.severity is Severity.BLUE:
            return False
        moves = max(0, self._to_go(position, victim) - 1)
        done_ms = at_ms + moves * settings.pace_ms + settings.treatment_ms(site.severity)
        return done_ms > settings.red_expiry_ms

    def _see_waiting(self) -> None:
        waiting: dict[str, VictimSite] = dict(self._waiting)
        self._scene = Scene(self._building, self._floodfills, waiting, self._settings)

    # --- instructions ----------------------------------------------------------------------------

    def _issue(
        self, at_ms: int, pose: Pose, reason: _IssueReason, notice: str = ""
    ) -> list[CoachRecord]:
        goal = self._route[0]
        instruction = instruct(self._scene, pose, goal, self.level)
        self._instruction = instruction
        self._number += 1
        self._carried_out = False
        self._track = track(instruction, self._settings.controls)
        distance = self._to_go(pose.cell, goal)
        self._compliance = self._compliance.issued(instruction.shown_level, distance)
        self._guidance = Guidance(instruction.text, notice)
        issued = InstructionIssued(
            at_ms,
            number=self._number,
            goal=goal,
            level=instruction.level,
            shown_level=instruction.shown_level,
            fallback=instruction.fallback,
            tuples=instruction.tuples,
            text=instruction.text,
            notice=notice,
            position=pose.cell,
            heading=pose.heading,
            end=instruction.end.cell,
            treats=instruction.treats,
            reason=reason,
        )
        return [issued]

    def _completed(self, at_ms: int) -> list[CoachRecord]:
        self._carried_out = True
        self._compliance = self._compliance.completed()
        return [InstructionCompleted(at_ms, self._number), *self._adapt("instruction", at_ms)]

    def _follow_level(self, at_ms: int, pose: Pose) -> list[CoachRecord]:
        """A new level replaces at once what has not been carried out."""
        instruction = self._instruction
        if instruction is None or self._carried_out or instruction.level is self.level:
            return []
        return self._issue(at_ms, pose, "level")
