"""The learning process of `knowledge`: which rooms are known, from walks at C3, and the
person's habits."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

from game.coach.acts import Level
from game.coach.api import Briefing
from game.coach.bar import OnBar
from game.coach.cycle import Alpha
from game.coach.instructions import Pose, Scene
from game.coach.knowledge.assumed import Assumed, QuizMark
from game.coach.knowledge.rooms import RoomKnowledge, RoomWalk, StepChances
from game.coach.knowledge.times import LED, Habits, LegTimes, first_words
from game.coach.model import Component, HumanModel, Learned
from game.world.events import Acted, Action, LevelWish, MissionEvent, Outcome, TreatmentStarted
from game.world.geometry import Cell
from game.world.observation import Observation


@dataclass
class _OpenLeg:
    """A leg as it was planned at `at_ms`: with `level`, expected to take `plain_ms` without the
    factor of the level, and `known_ms` at C3 for somebody who knows the way. `changed` is whether
    another level came in between, `unknown` P(the room was not known) by the walks of the leg."""

    goal: str
    at_ms: int
    level: Level
    plain_ms: float
    known_ms: float
    changed: bool = False
    unknown: float | None = None


class KnowledgeLearner:
    """Takes in every event with the instruction that was on the bar.

    Only walks after "Go to r", and only until the name of r is in view, say anything about what is
    known: led at C1 or C2 people do equally well whatever they know (paper 5.1.3: pi(C1, b) =
    pi(C1)). `habits` and `times` hold how fast this person is.
    """

    alpha: Alpha = frozenset({Component.BELIEF})

    def __init__(
        self,
        briefing: Briefing,
        assumed: Assumed,
        quiz: Mapping[str, QuizMark] | None = None,
    ) -> None:
        building = briefing.building
        places = {room.name: room.label for room in building.rooms}
        self.rooms = RoomKnowledge(assumed, places, quiz)
        self.habits = Habits(assumed)
        self.times = LegTimes(assumed, self.habits)
        self._assumed = assumed
        self._turns_need_a_key = briefing.settings.controls == "turn"
        self._steps = StepChances.of(building.terrain, places, assumed.rationality)
        self._walk: RoomWalk | None = None
        self._leg: _OpenLeg | None = None
        self._shown: OnBar | None = None
        self._unread = False
        self._in_view: frozenset[str] = frozenset()
        self._before: tuple[Action, int] | None = None

    @property
    def doubt(self) -> float | None:
        """P(known) of the room that the rescuer is walking to by its name, until the name is in
        view; None where there is no such walk."""
        walk = self._walk
        return None if walk is None or walk.room in self._in_view else self._known(walk)

    def see(self, observation: Observation) -> None:
        """Take note of the names that are in view."""
        self._in_view = frozenset(room.name for room in observation.rooms)
        self.rooms.see(self._in_view)

    def observe(self, event: MissionEvent, observation: Observation, shown: OnBar | None) -> None:
        self.see(observation)
        if shown is None:
            return
        self._on_bar(shown)
        match event:
            case Acted():
                self._acted(event, shown)
            case TreatmentStarted(victim=victim, at_ms=at_ms):
                self._arrived(victim, at_ms)

    def learned(self, model: HumanModel) -> Learned:
        known, walk = self.rooms.estimate(), self._walk
        if walk is not None:
            known = replace(known, by_room={**known.by_room, walk.room: self._known(walk)})
        return {Component.BELIEF: replace(model.belief, known=known)}

    # --- legs ------------------------------------------------------------------------------------

    def set_out(self, at_ms: int, scene: Scene, pose: Pose, goal: str, level: Level) -> None:
        """A leg to `goal` begins, at `level`."""
        known_ms = self.times.known(scene, pose, goal)
        if level in LED:
            plain_ms = self.times.led_plain(scene, pose, goal, level, self.rooms.share)
        else:
            plain_ms = self.times.known_plain(scene, pose, goal)
        self._leg = _OpenLeg(goal, at_ms, level, plain_ms, known_ms)

    def goal_given_up(self) -> None:
        """The walk to the last goal is over."""
        self._settle()
        self._leg = None

    def changed(self, at_ms: int, rest_ms: float) -> None:
        """Another level is spoken from here on, where somebody who knows the way would need
        `rest_ms` more. A search that is broken off would have gone on: it has no memory."""
        leg, walk = self._leg, self._walk
        if leg is None:
            return
        if walk is not None and leg.level is Level.C3 and not leg.changed:
            spent_ms = at_ms - leg.at_ms + rest_ms - leg.known_ms
            self.habits.searched(spent_ms, 1 - self._known(walk), found=False)
        leg.changed = True

    def lost(self, shown: OnBar) -> None:
        """The rescuer has not come nearer for too long, perhaps without any action at all."""
        self._on_bar(shown)
        if self._walk is not None:
            self._walk.add(-self._assumed.lost_evidence)

    def asked(self, want: LevelWish) -> None:
        """The rescuer asked for other words: whoever looks for a room asks for simpler ones."""
        if self._walk is not None and self._walk.room not in self._in_view:
            evidence = self._assumed.asked_evidence
            self._walk.add(-evidence if want == "simpler" else evidence)

    def _arrived(self, victim: str, at_ms: int) -> None:
        self._settle()
        leg, self._leg = self._leg, None
        if leg is None or leg.changed or victim != leg.goal:
            return
        ms = at_ms - leg.at_ms
        if leg.level in LED:
            self.habits.took(leg.level, ms, leg.plain_ms)
        elif leg.unknown is not None:
            self.habits.took(leg.level, ms, leg.plain_ms, 1 - leg.unknown)
            self.habits.searched(ms - leg.known_ms, leg.unknown, found=True)

    # --- walks -----------------------------------------------------------------------------------

    def _on_bar(self, shown: OnBar) -> None:
        """Take note of new words; the walk goes on where they name the same room."""
        if self._shown is not None and self._shown.number == shown.number:
            return
        self._shown, self._unread = shown, shown.reason != "restated"
        instruction = shown.instruction
        action, room = instruction.tuples[0]
        if instruction.shown_level is not Level.C3 or action != "Goto":
            self._settle()
        elif self._walk is None or self._walk.room != room:
            self._settle()
            start = instruction.start.cell
            self._walk = RoomWalk(self._assumed, self._steps, room, start, self.rooms.seen)

    def _settle(self) -> None:
        """What the walk has said is kept."""
        walk, self._walk = self._walk, None
        if walk is None:
            return
        if self._leg is not None:
            self._leg.unknown = max(self._leg.unknown or 0.0, 1 - self._known(walk))
        self.rooms.add(walk.room, walk.evidence, seen=walk.seen)

    def _known(self, walk: RoomWalk) -> float:
        return self.rooms.known(walk.room, walk=walk.evidence, seen=walk.seen)

    def _acted(self, event: Acted, shown: OnBar) -> None:
        moved = event.outcome is Outcome.MOVED
        if self._unread and event.action is not Action.TRIAGE:
            self._read(event.at_ms - shown.at_ms, shown)
            self._before = None
        if moved:
            self._moved(event, event.position)
        elif event.action is Action.TRIAGE:
            self._before = None

    def _read(self, ms: int, shown: OnBar) -> None:
        self._unread = False
        if ms > 0:
            words = first_words(
                shown.instruction, shown.notice, turns_need_a_key=self._turns_need_a_key
            )
            self.habits.answered(ms, self.times.usual_reading(words))

    def _moved(self, event: Acted, position: Cell) -> None:
        """A step; one with the same key as the step before tells the pace."""
        ratio = None
        if self._before is not None and self._before[0] is event.action:
            ms = event.at_ms - self._before[1]
            self.habits.stepped(ms)
            ratio = ms / self.habits.step_ms
        self._before = event.action, event.at_ms
        walk = self._walk
        if walk is not None and walk.room not in self._in_view:
            walk.moved(position, self.rooms.seen)
            if ratio is not None:
                walk.paced(ratio)
