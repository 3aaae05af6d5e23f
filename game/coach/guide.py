"""The dispatcher that all built-in coaches share: what happened goes to what leads (`lead`), to
what stands on the bar (`bar`) and to the adaptive cycle (`cycle`); a coach fills in the hooks."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Sequence
from typing import Generic, Literal, TypeVar

from game.coach.acts import (
    CoachRecord,
    GoalReason,
    GoalSet,
    InstructionIssued,
    IssueReason,
    Level,
    LostNoticed,
    NothingLeft,
)
from game.coach.api import Briefing
from game.coach.bar import Bar
from game.coach.belief import Belief, belief_change
from game.coach.cycle import AdaptiveCycle, InfluenceProcess, LearningProcess
from game.coach.instructions import Pose, correction
from game.coach.instructions.phrasebook import NoticeName
from game.coach.lead import Lead
from game.coach.model import HumanModel
from game.world.events import (
    Acted,
    Action,
    Expired,
    LevelAsked,
    LevelWish,
    MissionEvent,
    Outcome,
    Rescued,
    TreatmentBroken,
    TreatmentStarted,
)
from game.world.geometry import Cell
from game.world.observation import Guidance, Observation

_NOTICES: dict[GoalReason, NoticeName] = {
    "expired": "too_late",
    "too_late": "too_late",
    "strayed": "another_first",
}
"""What is said of a goal that is given up before its victim was treated."""

State = TypeVar("State")
Occasion = Literal["goal", "step", "completed", "misstep", "lost", "time"] | LevelWish
"""When a coach may choose: a goal has been set; the rescuer has moved; an instruction has been
carried out; a misstep was made; the rescuer has not come nearer for too long; the time that the
coach asked for has come; the rescuer has asked for `simpler` or `shorter` words."""


class Guide(ABC, Generic[State]):
    """A coach that leads from victim to victim along a route, by an adaptive cycle.

    A subclass gives the two processes and the state that the influence process acts on, says which
    level that state means, and may override the other hooks. `lead`, `bar`, `cycle` and `state`
    are there for its use.
    """

    def __init__(
        self,
        briefing: Briefing,
        learning: LearningProcess,
        influence: InfluenceProcess[State, State],
        state: State,
    ) -> None:
        self.briefing = briefing
        self.lead = Lead(briefing)
        self.bar = Bar()
        self.cycle = AdaptiveCycle(
            HumanModel.of(briefing.building, briefing.settings), learning, influence
        )
        self.state = state
        self._treated: str | None = None
        self._meant: str | None = None

    # --- the hooks -------------------------------------------------------------------------------

    @property
    @abstractmethod
    def level(self) -> Level:
        """The level in force."""

    @property
    def ms_per_move(self) -> int:
        """How long a move is taken to last when a route is planned."""
        return self.briefing.settings.pace_ms

    @property
    def next_choice_ms(self) -> int | None:
        """When `choose` is to be called for the occasion `time`; None for never."""
        return None

    def choose(self, occasion: Occasion, at_ms: int, pose: Pose, goal: str) -> list[CoachRecord]:
        """Called on every occasion, before an instruction is issued: set `state` so that `level`
        is what should be spoken from here on, and return what the journal should keep of it."""
        return []

    def goal_set(self, goal: str, position: Cell) -> None:
        """The rescuer, who stands at `position`, is led to `goal` from now on."""

    def goal_ended(self, at_ms: int, *, rescued: bool) -> list[CoachRecord]:
        """The goal is given up, or (`rescued`) a rescue has ended it."""
        return []

    # --- the surface of a coach ------------------------------------------------------------------

    @property
    def guidance(self) -> Guidance:
        return self.bar.guidance

    def begin(self, observation: Observation) -> list[CoachRecord]:
        before = self.cycle.model.belief.state
        self.cycle.begin(observation)
        pose = Pose(observation.position, observation.heading)
        return [*self._belief_since(before, 0), *self._set_goal(0, pose, "start")]

    def on_event(self, event: MissionEvent, observation: Observation) -> list[CoachRecord]:
        before = self.cycle.model.belief.state
        self.cycle.observe(event, observation, self.bar.shown)
        records = self._belief_since(before, event.at_ms)
        pose = Pose(observation.position, observation.heading)
        match event:
            case Acted():
                records += self._acted(event, observation)
            case TreatmentStarted(victim=victim):
                records += self._treating(event.at_ms, pose, victim, observation)
            case TreatmentBroken():
                records += self._broken(event.at_ms, pose)
            case Rescued(victim=victim):
                records += self._rescued(event.at_ms, pose, victim)
            case Expired(victim=victim):
                records += self._expired(event.at_ms, pose, victim)
            case LevelAsked(want=want):
                if self.bar.shown is not None:
                    records += self._choose(want, event.at_ms, pose)
                    records += self._follow_level(event.at_ms, pose)
        return records

    @property
    def next_evaluation_ms(self) -> int | None:
        if self.bar.shown is None:
            return None
        times = (self.next_choice_ms, self.bar.lost_at_ms)
        return min((at_ms for at_ms in times if at_ms is not None), default=None)

    def evaluate(self, at_ms: int, observation: Observation) -> list[CoachRecord]:
        pose = Pose(observation.position, observation.heading)
        records: list[CoachRecord] = []
        if self.next_choice_ms == at_ms:
            records += [*self._choose("time", at_ms, pose), *self._follow_level(at_ms, pose)]
        if self.bar.lost_at_ms == at_ms:
            records += self._lost(at_ms, pose)
        return records

    def _belief_since(self, before: Belief, at_ms: int) -> list[CoachRecord]:
        change = belief_change(before, self.cycle.model.belief.state, at_ms)
        return [] if change is None else [change]

    # --- what happened ---------------------------------------------------------------------------

    def _acted(self, event: Acted, observation: Observation) -> list[CoachRecord]:
        at_ms, pose = event.at_ms, Pose(event.position, event.heading)
        if self.bar.shown is None:
            return []
        moved = event.outcome is Outcome.MOVED
        records = self._choose("step", at_ms, pose) if moved else []
        if not self.bar.open:
            return records
        if self.lead.hopeless(self.lead.goal, pose.cell, at_ms):
            return records + self._give_up(at_ms, pose, "too_late")
        if event.action is Action.TRIAGE:
            return records + self._follow_level(at_ms, pose)
        taken_down = self.bar.walked(at_ms, self.lead.walked(pose.cell), observation)
        if taken_down is not None:
            records.append(taken_down)
        if self.bar.reached(pose):
            records += self._completed(at_ms, pose)
            return records + self._issue(at_ms, pose, "completed")
        if self.bar.misstep:
            return records + self._misstep(at_ms, pose)
        if self.bar.astray:
            return records + self._issue(at_ms, pose, "restated")
        if self.bar.misleads(self.lead.scene, pose, observation):
            return records + self._issue(at_ms, pose, "off_path")
        if taken_down is not None and self.bar.strict:
            return records + self._issue(at_ms, pose, "heeded")
        return records + self._follow_level(at_ms, pose)

    def _misstep(self, at_ms: int, pose: Pose) -> list[CoachRecord]:
        assert self.bar.shown is not None
        told = self.bar.shown.instruction
        records = self.bar.correct(at_ms) + self._choose("misstep", at_ms, pose)
        better = self.lead.better_route(at_ms, pose.cell, self.ms_per_move)
        if better is not None:
            return records + self._give_up(at_ms, pose, "strayed", better)
        if not self.bar.may_notice:
            return records + self._issue(at_ms, pose, "restated")
        notice = correction(self.lead.scene, told, pose) or "wrong_way"
        return records + self._issue(at_ms, pose, "misstep", notice)

    def _lost(self, at_ms: int, pose: Pose) -> list[CoachRecord]:
        """Help a rescuer who does not come nearer: say the way again from here, at a level that
        the coach may change first."""
        assert self.bar.shown is not None
        by = self.bar.lost_by
        records: list[CoachRecord] = [LostNoticed(at_ms, self.bar.shown.number, by)]
        records += self._choose("lost", at_ms, pose)
        return records + self._issue(at_ms, pose, "lost", by)

    def _treating(
        self, at_ms: int, pose: Pose, victim: str, observation: Observation
    ) -> list[CoachRecord]:
        self._treated = victim
        if self.bar.shown is None:
            return []
        if self.bar.asks_for(self.lead.scene, victim, observation):
            self._meant = victim
            return self._completed(at_ms, pose)
        return self.bar.treated_other(at_ms, victim)

    def _broken(self, at_ms: int, pose: Pose) -> list[CoachRecord]:
        self._treated = self._meant = None
        carried_out = self.bar.shown is not None and not self.bar.open
        return self._issue(at_ms, pose, "resumed") if carried_out else []

    def _rescued(self, at_ms: int, pose: Pose, victim: str) -> list[CoachRecord]:
        self.lead.gone(victim, expired=False)
        self._treated = None
        if self.bar.shown is None:
            return []
        return self._give_up(at_ms, pose, "rescued" if victim == self._meant else "other_rescued")

    def _expired(self, at_ms: int, pose: Pose, victim: str) -> list[CoachRecord]:
        self.lead.gone(victim, expired=True)
        if self.bar.shown is None or victim != self.lead.goal:
            return []
        return self._give_up(at_ms, pose, "expired")

    # --- goals and instructions ------------------------------------------------------------------

    def _give_up(
        self, at_ms: int, pose: Pose, reason: GoalReason, route: Sequence[str] | None = None
    ) -> list[CoachRecord]:
        rescued = reason in ("rescued", "other_rescued")
        return [
            *self.goal_ended(at_ms, rescued=rescued),
            *self._set_goal(at_ms, pose, reason, route),
        ]

    def _set_goal(
        self, at_ms: int, pose: Pose, reason: GoalReason, route: Sequence[str] | None = None
    ) -> list[CoachRecord]:
        self._meant = None
        if not self.lead.set_out(at_ms, pose.cell, self.ms_per_move, route):
            self.bar.close(self.lead.farewell)
            return [NothingLeft(at_ms, self.lead.farewell)]
        goal, room = self.lead.goal, self.lead.room
        self.goal_set(goal, pose.cell)
        records: list[CoachRecord] = [
            GoalSet(at_ms, goal, room.name if room else None, self.lead.route, reason)
        ]
        records += self._choose("goal", at_ms, pose)
        records += self._issue(at_ms, pose, "goal", _NOTICES.get(reason))
        if goal == self._treated:
            self._meant = goal
            records += self._completed(at_ms, pose)
        return records

    def _choose(self, occasion: Occasion, at_ms: int, pose: Pose) -> list[CoachRecord]:
        return self.choose(occasion, at_ms, pose, self.lead.goal)

    def _issue(
        self, at_ms: int, pose: Pose, reason: IssueReason, notice: NoticeName | None = None
    ) -> list[CoachRecord]:
        words = "" if notice is None else self.briefing.phrases.notices[notice]
        return [self._put_up(at_ms, pose, reason, words)]

    def _put_up(
        self, at_ms: int, pose: Pose, reason: IssueReason, notice: str
    ) -> InstructionIssued:
        lead = self.lead
        return self.bar.issue(at_ms, lead.scene, pose, lead.goal, self.level, reason, notice)

    def _completed(self, at_ms: int, pose: Pose) -> list[CoachRecord]:
        return [self.bar.complete(at_ms), *self._choose("completed", at_ms, pose)]

    def _follow_level(self, at_ms: int, pose: Pose) -> list[CoachRecord]:
        """A new level replaces at once what has not been carried out; a notice that cannot have
        been read yet stays."""
        shown = self.bar.shown
        if shown is None or not self.bar.open or shown.instruction.level is self.level:
            return []
        return [self._put_up(at_ms, pose, "level", self.bar.unread_notice(at_ms))]
