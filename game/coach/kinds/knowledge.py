"""`knowledge`: holds, room by room, what this rescuer knows, and says whatever is expected to bring
them to the goal soonest."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from math import inf

from game.coach.acts import ChoiceReason, CoachRecord, KnowledgeJudged, Level, LevelChanged
from game.coach.api import Briefing
from game.coach.cycle import Alpha
from game.coach.guide import Guide, Occasion
from game.coach.instructions import Pose, Scene
from game.coach.knowledge.assumed import ASSUMED, Assumed, QuizMark
from game.coach.knowledge.learner import KnowledgeLearner
from game.coach.knowledge.times import LED, Habits, LegTimes
from game.coach.levels import granted, preferring
from game.coach.model import Component, HumanModel, KnownRooms, Reward
from game.world.events import LevelWish
from game.world.geometry import Cell

DECIMALS = 6
"""Expected times are compared rounded, so that the last bit of exp() decides nothing."""


@dataclass(frozen=True)
class DecisionPoint:
    """Where and when a level is to be chosen."""

    occasion: Occasion
    scene: Scene
    pose: Pose
    goal: str


@dataclass(frozen=True)
class LevelChoice:
    """The state of the coach: the level in force and the rescuer's `preference` (as in
    `LevelState`); with a `point`, a level that is to be reconsidered there. `expected_ms` and `why`
    are what the choice was made by."""

    level: Level
    preference: int = 0
    point: DecisionPoint | None = None
    expected_ms: Mapping[Level, float] = field(default_factory=dict)
    why: ChoiceReason = "soonest"

    def asked(self, want: LevelWish) -> LevelChoice:
        """The state after the rescuer has asked for other words."""
        return replace(self, preference=preferring(self.preference, want))


class SoonestLevel:
    """The influence process: from what is known, the level with the least expected time."""

    def __init__(self, assumed: Assumed, times: LegTimes, habits: Habits) -> None:
        self._assumed = assumed
        self._times = times
        self._habits = habits

    def act(self, state: LevelChoice, model: HumanModel, alpha: Alpha) -> LevelChoice:
        known, point = model.belief.known, state.point
        if Component.BELIEF not in alpha or known is None or point is None:
            return state
        led_ms = self._led(point, known)
        match point.occasion:
            case "lost":
                level = Level.C1 if state.level is Level.C2 else self._liked(led_ms, state)
                return replace(state, level=level, expected_ms=led_ms, why="lost")
            case "step":
                return self._in_doubt(state, point, known, led_ms)
            case _:
                return self._soonest(state, point, model, known, led_ms)

    def _soonest(
        self,
        state: LevelChoice,
        point: DecisionPoint,
        model: HumanModel,
        known: KnownRooms,
        led_ms: dict[Level, float],
    ) -> LevelChoice:
        """The level by which the goal is reached soonest; the one in force if that is as good. A
        request is granted, and counts like time from then on."""
        expected_ms = dict(led_ms)
        at_c3 = self._by_name(point, model, known, min(led_ms.values()))
        if at_c3 is not None:
            expected_ms[Level.C3] = at_c3
        best = self._liked(expected_ms, state)
        if point.occasion == "simpler" or point.occasion == "shorter":
            level = granted(point.occasion, state.level, best)
            return replace(state, level=level, expected_ms=expected_ms, why="asked")
        in_force_ms = expected_ms.get(state.level, inf) + self._dislike_ms(state.level, state)
        best_ms = expected_ms[best] + self._dislike_ms(best, state)
        gain_ms = round(in_force_ms - best_ms, DECIMALS)
        if best is state.level or gain_ms <= self._assumed.switch_gain_ms:
            why: ChoiceReason = "soonest" if best is state.level else "stays"
            return replace(state, expected_ms=expected_ms, why=why)
        return replace(state, level=best, expected_ms=expected_ms, why="soonest")

    def _dislike_ms(self, level: Level, state: LevelChoice) -> float:
        """What the rescuer's preference adds to the expected time of `level`."""
        return state.preference * self._assumed.asked_ms * (level - Level.C1)

    def _liked(self, expected_ms: Mapping[Level, float], state: LevelChoice) -> Level:
        """The level with the least expected time, preference included; the lower of two equal."""
        return min(
            expected_ms,
            key=lambda it: (round(expected_ms[it] + self._dislike_ms(it, state), DECIMALS), it),
        )

    def _in_doubt(
        self,
        state: LevelChoice,
        point: DecisionPoint,
        known: KnownRooms,
        led_ms: dict[Level, float],
    ) -> LevelChoice:
        """In mid-leg at C3: whether to help somebody who may not know the way, now or later."""
        assumed, room = self._assumed, point.scene.room(point.goal)
        assert room is not None
        chance, best_ms = known.by_room[room.name], min(led_ms.values())
        rest_ms = self._times.walk(point.scene, point.pose, point.goal)
        unknown_ms = min(rest_ms + self._habits.search_ms, best_ms + assumed.later_ms)
        stay_ms = chance * rest_ms + (1 - chance) * unknown_ms
        if round(stay_ms - best_ms, DECIMALS) <= assumed.help_gain_ms:
            return state
        return replace(
            state,
            level=self._liked(led_ms, state),
            expected_ms={**led_ms, Level.C3: stay_ms},
            why="looks_lost",
        )

    def _led(self, point: DecisionPoint, known: KnownRooms) -> dict[Level, float]:
        scene, pose, goal = point.scene, point.pose, point.goal
        return {level: self._times.led(scene, pose, goal, level, known.share) for level in LED}

    def _by_name(
        self, point: DecisionPoint, model: HumanModel, known: KnownRooms, led_ms: float
    ) -> float | None:
        """Expected time at C3; None where the goal lies in no room. Not knowing the room costs the
        lesser of searching for it and of being led once it shows."""
        assumed, scene, pose = self._assumed, point.scene, point.pose
        room = scene.room(point.goal)
        if room is None:
            return None
        known_ms = self._times.known(scene, pose, point.goal)
        if scene.building.room_at(pose.cell) is room:
            return known_ms
        chance = known.by_room[room.name]
        if room.name not in model.belief.state.rooms:
            chance = hopeful(chance, known.share_sd, assumed.optimism)
        shown_ms = led_ms + self._times.reading(5) + assumed.show_ms
        unknown_ms = min(known_ms + self._habits.search_ms, shown_ms)
        return chance * known_ms + (1 - chance) * unknown_ms


class KnowledgeCoach(Guide[LevelChoice]):
    """Chooses at each goal, at the end of each instruction and after a misstep; while the rescuer
    walks to a room by its name, and does not seem to know it, at each step; for one who is lost."""

    def __init__(
        self,
        briefing: Briefing,
        quiz: Mapping[str, QuizMark] | None = None,
        assumed: Assumed = ASSUMED,
    ) -> None:
        self._learner = learner = KnowledgeLearner(briefing, assumed, quiz)
        influence = SoonestLevel(assumed, learner.times, learner.habits)
        super().__init__(briefing, learner, influence, LevelChoice(assumed.first_level))
        self.cycle.model = replace(self.cycle.model, reward=Reward(assumed.rationality))
        self._assumed = assumed

    @property
    def level(self) -> Level:
        return self.state.level

    def goal_set(self, goal: str, position: Cell) -> None:
        self._learner.goal_given_up()

    def choose(self, occasion: Occasion, at_ms: int, pose: Pose, goal: str) -> list[CoachRecord]:
        if not self._may_choose(occasion):
            return []
        match occasion:
            case "lost" if self.bar.shown is not None:
                self._learner.lost(self.bar.shown)
            case "simpler" | "shorter":
                self._learner.asked(occasion)
                self.state = self.state.asked(occasion)
        scene, before = self.lead.scene, self.state.level
        model = self.cycle.evaluate()
        point = DecisionPoint(occasion, scene, pose, goal)
        self.state = self.cycle.adapt(replace(self.state, point=point))
        if occasion == "goal":
            self._learner.set_out(at_ms, scene, pose, goal, self.level)
        elif self.level is before:
            return []
        else:
            self._learner.changed(at_ms, self._learner.times.walk(scene, pose, goal))
        records: list[CoachRecord] = [judged(at_ms, self.state, model)]
        if self.level is not before and self.bar.shown is not None:
            records.append(LevelChanged(at_ms, before, self.level))
        return records

    def _may_choose(self, occasion: Occasion) -> bool:
        match occasion:
            case "goal" | "misstep" | "simpler" | "shorter":
                return True
            case "completed":
                return self.bar.shown is not None and not self.bar.shown.instruction.treats
            case "lost":
                return self.level is not Level.C1
            case "step":
                doubt = self._learner.doubt if self.level is Level.C3 and self.bar.open else None
                return doubt is not None and doubt <= self._assumed.doubt_below
        return False


def hopeful(chance: float, share_sd: float, optimism: float) -> float:
    """P(known) with a bonus for what is uncertain: what C3 would teach is worth something."""
    return min(0.98, chance + optimism * share_sd * 4 * chance * (1 - chance))


def judged(at_ms: int, choice: LevelChoice, model: HumanModel) -> KnowledgeJudged:
    """What the journal keeps of a choice."""
    known, point = model.belief.known, choice.point
    assert known is not None and point is not None
    room = point.scene.room(point.goal)
    return KnowledgeJudged(
        at_ms,
        goal=point.goal,
        room=room.name if room else None,
        known=dict(known.by_room),
        share=known.share,
        expected_ms={level.name: ms for level, ms in choice.expected_ms.items()},
        chosen=choice.level,
        why=choice.why,
    )
