"""How long a leg will take this rescuer at each level, and what is learned of their habits.

A leg runs from where the rescuer stands to the treatment of the goal. At C1 and C2 the rescuer is
led along a course; at C3 the way is known or has to be looked for. Times are milliseconds.
"""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass
from math import exp, log
from statistics import median
from typing import NamedTuple

from game.coach.acts import Level
from game.coach.instructions import Instruction, Pose, Scene, instruct
from game.coach.instructions.course import MOST_INSTRUCTIONS
from game.coach.instructions.reading import words
from game.coach.knowledge.assumed import Assumed

LED = (Level.C1, Level.C2)
"""The levels at which the rescuer is led all the way, whatever they know."""

FIRST_STEPS, LAST_STEPS = 12, 40
"""The usual step is the median of the last `LAST_STEPS`; `FIRST_STEPS` assumed ones fade."""


@dataclass(frozen=True)
class Estimate:
    """A normal belief about a number."""

    mean: float
    precision: float

    @classmethod
    def around(cls, mean: float, sd: float) -> Estimate:
        return cls(mean, 1 / sd**2)

    def after(self, value: float, noise_sd: float, weight: float = 1.0) -> Estimate:
        """The belief once `value` has been observed, with noise; less is learned by `weight`."""
        gained = weight / noise_sd**2
        precision = self.precision + gained
        return Estimate((self.mean * self.precision + value * gained) / precision, precision)

    def at_most(self, precision: float) -> Estimate:
        return Estimate(self.mean, min(self.precision, precision))


class Habits:
    """This person's habits: how fast they step, read and think, and search for a room."""

    def __init__(self, assumed: Assumed) -> None:
        self._assumed = assumed
        self._steps = deque([assumed.step_ms] * FIRST_STEPS, maxlen=LAST_STEPS)
        self._slowness = Estimate.around(0.0, assumed.slowness_sd)
        means = zip(Level, assumed.factor_means, strict=True)
        self._factors = {level: Estimate.around(mean, assumed.factor_sd) for level, mean in means}
        self._finds = assumed.search_finds
        self._searched_ms = assumed.search_finds * assumed.search_ms

    @property
    def step_ms(self) -> float:
        """How long a step takes."""
        return median(self._steps)

    @property
    def slowness(self) -> float:
        """How many times as long as assumed this person reads and thinks."""
        return exp(self._slowness.mean)

    @property
    def search_ms(self) -> float:
        """By how much finding a room that is not known takes longer than walking to one that is.

        A search has no memory: its duration is exponential, the belief about the rate a gamma. So
        it is the time of all searches over the number of those that ended; one that was broken off
        adds only time.
        """
        return self._searched_ms / self._finds

    def factor(self, level: Level) -> float:
        """How many times as long as expected the legs of a level take."""
        return exp(self._factors[level].mean)

    def stepped(self, ms: int) -> None:
        """A step took so long."""
        self._steps.append(ms)

    def answered(self, ms: int, expected_ms: float) -> None:
        """The first key after new words came after `ms`; `expected_ms` at usual slowness."""
        assumed = self._assumed
        ratio = _clipped(log(ms / expected_ms), 1.5)
        learned = self._slowness.after(ratio, assumed.slowness_noise)
        self._slowness = learned.at_most(assumed.slowness_most / assumed.slowness_noise**2)

    def took(self, level: Level, ms: int, expected_ms: float, weight: float = 1.0) -> None:
        """A leg at `level` took `ms`; `expected_ms` without the factor of the level."""
        ratio = _clipped(log(ms / expected_ms), 1.0)
        self._factors[level] = self._factors[level].after(ratio, self._assumed.factor_noise, weight)

    def searched(self, ms: float, weight: float, *, found: bool) -> None:
        """A search took `ms` longer than walking there, and was `found` or broken off; `weight`:
        P(the room was not known)."""
        self._searched_ms += weight * max(0.0, min(self._assumed.search_most_ms, ms))
        self._finds += weight * found


class _Sentence(NamedTuple):
    """`steps` are walked while carrying it out; `counted` is the number to count to."""

    words: int
    steps: float
    turns: bool
    counted: int


class _Part(NamedTuple):
    """An instruction of a course, without its place."""

    sentences: tuple[_Sentence, ...]
    shown_level: Level
    end: Pose | None


class LegTimes:
    """Expected times from a pose to the treatment of a goal, for a person with these `habits`.

    The parts of courses are kept as long as goal and scene are the same: only the habits change
    meanwhile.
    """

    def __init__(self, assumed: Assumed, habits: Habits) -> None:
        self._assumed = assumed
        self._habits = habits
        self._scene: Scene | None = None
        self._goal = ""
        self._parts: dict[tuple[Level, Pose], _Part] = {}

    def led(self, scene: Scene, pose: Pose, goal: str, level: Level, share: float) -> float:
        """For somebody who is led at C1 or C2 and knows the `share` of the rooms."""
        return self.led_plain(scene, pose, goal, level, share) * self._habits.factor(level)

    def led_plain(self, scene: Scene, pose: Pose, goal: str, level: Level, share: float) -> float:
        """The same without the factor of the level."""
        total, at = 0.0, pose
        for _ in range(MOST_INSTRUCTIONS):
            part = self._part(scene, at, goal, level)
            total += self._carried_out(part, 1 - share)
            if part.end is None or part.end == at:
                return total
            at = part.end
        return total

    def known(self, scene: Scene, pose: Pose, goal: str) -> float:
        """At C3 for somebody who knows the way."""
        return self.known_plain(scene, pose, goal) * self._habits.factor(Level.C3)

    def known_plain(self, scene: Scene, pose: Pose, goal: str) -> float:
        """The same without the factor of the level."""
        room = scene.room(goal)
        inside = room is not None and scene.building.room_at(pose.cell) is room
        reading = self.reading(4 if inside else 5)
        return self.walk(scene, pose, goal) + reading + self._assumed.look_ms

    def walk(self, scene: Scene, pose: Pose, goal: str) -> float:
        """The rest of the way at C3 for somebody who knows it and has read."""
        distance = scene.floodfills.distance(pose.cell, scene.victim(goal).cell)
        return max(0, distance - 1) * self._habits.step_ms * self._assumed.detour

    def reading(self, words: int) -> float:
        """To read so many words."""
        return self._habits.slowness * self.usual_reading(words)

    def usual_reading(self, words: int) -> float:
        """The same at usual slowness."""
        return self._assumed.react_ms + self._assumed.word_ms * words

    def _carried_out(self, part: _Part, unknowing: float) -> float:
        """To read and carry out an instruction: the next sentence is read while walking."""
        assumed, slowness, step_ms = self._assumed, self._habits.slowness, self._habits.step_ms
        read, done = assumed.react_ms * slowness, 0.0
        for sentence in part.sentences:
            read += assumed.word_ms * slowness * sentence.words
            done = max(done, read)
            if part.shown_level is Level.C2:
                done += assumed.interpret_ms * slowness * unknowing
            if sentence.turns:
                done += assumed.slip_c1 * assumed.slip_c1_ms * (part.shown_level is Level.C1)
            elif sentence.steps:
                done += sentence.steps * step_ms + assumed.turn_ms
            always, unknown = assumed.miscount
            done += (always + unknown * unknowing) * sentence.counted * assumed.miscount_ms
        return done

    def _part(self, scene: Scene, pose: Pose, goal: str, level: Level) -> _Part:
        if scene is not self._scene or goal != self._goal:
            self._scene, self._goal, self._parts = scene, goal, {}
        key = level, pose
        if key not in self._parts:
            self._parts[key] = _part(instruct(scene, pose, goal, level))
        return self._parts[key]


def first_words(instruction: Instruction, notice: str, *, turns_need_a_key: bool) -> int:
    """How many words are read before the first key: as far as the first sentence that needs one."""
    read = words(notice)
    for (action, _), sentence in zip(instruction.tuples, instruction.sentences, strict=True):
        read += words(sentence)
        if action != "Turn" or turns_need_a_key:
            break
    return read


def _part(instruction: Instruction) -> _Part:
    actions = [action for action, _ in instruction.tuples]
    walks = [action not in ("Turn", "Stop", "Utilize") for action in actions]
    steps = (len(instruction.path) - 1) / max(1, sum(walks))
    counts = instruction.shown_level is Level.C2
    sentences = tuple(
        _Sentence(words(it), steps * walking, action == "Turn", _number(thing) if counts else 0)
        for (action, thing), it, walking in zip(
            instruction.tuples, instruction.sentences, walks, strict=True
        )
    )
    end = None if instruction.treats else instruction.end
    return _Part(sentences, instruction.shown_level, end)


def _number(thing: str) -> int:
    first = thing.split()[0]
    return int(first) if first.isdigit() else 0


def _clipped(value: float, limit: float) -> float:
    return max(-limit, min(limit, value))
