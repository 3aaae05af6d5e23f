"""Which rooms the rescuer knows: a belief by room, and what walks to a room say about it.

K_r, that the place of room r is known, is Bernoulli(theta) for each room, and the share theta of
rooms known is Beta: whoever has shown that they know some rooms probably knows others. A walk after
"Go to r" is evidence e_r = log P(walk | K_r) - log P(walk | not K_r).
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from math import exp, log, sqrt

from game.coach.knowledge.assumed import Assumed, QuizMark
from game.coach.model import KnownRooms
from game.coach.policy import steps_to
from game.world.floodfill import Floodfills
from game.world.geometry import Cell
from game.world.terrain import Terrain

MOST_LOG_ODDS = 30.0
"""Beyond this the last bits of exp() would decide."""


class RoomKnowledge:
    """P(known) of every room.

    What was said by walks that began before the name of the room had been in view counts towards
    the map that was memorised, and so towards the share; what was said by later ones counts for the
    room alone. A name in view is remembered with the chance `retention`.
    """

    def __init__(
        self,
        assumed: Assumed,
        rooms: Iterable[str],
        quiz: Mapping[str, QuizMark] | None = None,
    ) -> None:
        self._assumed = assumed
        points, (a, b) = assumed.share_points, assumed.share_prior
        self._shares = [(point + 0.5) / points for point in range(points)]
        self._log_prior = [(a - 1) * log(t) + (b - 1) * log(1 - t) for t in self._shares]
        self.memorised = dict.fromkeys(rooms, 0.0)
        if quiz is not None:
            for room, answer in quiz.items():
                self.memorised[room] = log_odds(assumed, answer)
        self.learned = dict.fromkeys(self.memorised, 0.0)
        self.seen: frozenset[str] = frozenset()
        self._weigh()

    def see(self, rooms: Iterable[str]) -> None:
        """These names have been in view."""
        self.seen = self.seen.union(rooms)

    def add(self, room: str, evidence: float, *, seen: bool) -> None:
        """Evidence, in log odds, that the room is known; `seen`: its name had been in view."""
        kind = self.learned if seen else self.memorised
        kind[room] += evidence
        if not seen:
            self._weigh()

    def known(self, room: str, *, walk: float = 0.0, seen: bool | None = None) -> float:
        """P(known), given also `walk`: evidence in log odds of a walk that goes on, which began
        when the name had (`seen`) been in view."""
        seen = room in self.seen if seen is None else seen
        odds = _odds(self.memorised[room] + (0.0 if seen else walk))
        chance = sum(
            weight * share * odds / (share * odds + 1 - share)
            for weight, share in zip(self._weights, self._shares, strict=True)
        )
        if seen:
            chance += (1 - chance) * self._assumed.retention
            odds = _odds(self.learned[room] + walk)
            chance = chance * odds / (chance * odds + 1 - chance)
        return chance

    def estimate(self) -> KnownRooms:
        """All that is held, without a walk that goes on."""
        by_room = {room: self.known(room) for room in self.memorised}
        return KnownRooms(by_room, self.share, self.share_sd)

    def _weigh(self) -> None:
        """The posterior of the share, and its mean and standard deviation."""
        odds = [_odds(evidence) for evidence in self.memorised.values() if evidence]
        logs = [
            prior + sum(log(share * o + 1 - share) for o in odds)
            for share, prior in zip(self._shares, self._log_prior, strict=True)
        ]
        most = max(logs)
        weights = [exp(value - most) for value in logs]
        total = sum(weights)
        self._weights = [weight / total for weight in weights]
        pairs = list(zip(self._weights, self._shares, strict=True))
        self.share = sum(weight * share for weight, share in pairs)
        variance = sum(weight * share * share for weight, share in pairs) - self.share**2
        self.share_sd = sqrt(max(0.0, variance))


Places = Mapping[str, Cell]
"""Where rooms are, by name: their label cells."""


class StepChances:
    """How well steps in one building fit a walk to a place, by the policy of the human model.

    Of two steps that lead equally near the one that was taken tells nothing about knowledge, so a
    step is judged by whether it came nearer: by the probability of all steps that would have.
    """

    def __init__(self, floodfills: Floodfills, places: Places, rationality: float) -> None:
        self.places = places
        self._floodfills = floodfills
        self._rationality = rationality
        self._nearer: dict[tuple[str, Cell], float] = {}

    @classmethod
    def of(cls, terrain: Terrain, places: Places, rationality: float) -> StepChances:
        """The one of a building, shared by all who ask."""
        key = "steps to rooms", tuple(places.items()), rationality
        return terrain.shared(key, lambda: cls(terrain.floodfills, places, rationality))

    def distance(self, room: str, cell: Cell) -> int:
        return self._floodfills.distance(cell, self.places[room])

    def likelihood(self, room: str, start: Cell, end: Cell) -> float:
        """P(a step from `start` comes nearer to `room`, as that to `end` does, or does not |
        the walker heads for it)."""
        nearer = self._chance_nearer(room, start)
        return nearer if self.distance(room, end) < self.distance(room, start) else 1 - nearer

    def _chance_nearer(self, room: str, start: Cell) -> float:
        chance = self._nearer.get((room, start))
        if chance is None:
            place = self.places[room]
            here = self._floodfills.distance(start, place)
            steps = steps_to(place, start, self._floodfills, self._rationality)
            chance = sum(
                share
                for way, share in steps.items()
                if self._floodfills.distance(way.from_cell(start), place) < here
            )
            self._nearer[room, start] = chance
        return chance


class RoomWalk:
    """A walk after "Go to r": that of somebody who heads for r, or of somebody who tries one place
    after another, as a hidden Markov filter over the places not yet seen, r among them.

    The hidden state is the place the searcher has in mind: at each step another one, near by rather
    than far, with the chance `retarget`. Whoever heads for r goes `astray` now and then. `seen` is
    whether the name of the room had been in view when the walk began.
    """

    def __init__(
        self, assumed: Assumed, steps: StepChances, room: str, start: Cell, seen: frozenset[str]
    ) -> None:
        self.room = room
        self.seen = room in seen
        self._assumed = assumed
        self._steps = steps
        self._position = start
        self._open = [name for name in steps.places if name == room or name not in seen]
        self._minds = self._guesses(start)
        self._said = 0.0
        self._astray = 0.0
        self._pace = WalkPace(assumed)

    @property
    def evidence(self) -> float:
        """e_r so far."""
        return self._limited(self._said + self._pace.evidence)

    def moved(self, position: Cell, seen: frozenset[str]) -> None:
        """The walker is at `position` now, and the names `seen` have been in view: searchers who
        had one of those in mind think of another place."""
        start, room = self._position, self.room
        if position == start:
            return
        guesses, change = self._guesses(start), self._assumed.retarget
        joint = {
            name: ((1 - change) * mind + change * guesses[name])
            * self._steps.likelihood(name, start, position)
            for name, mind in self._minds.items()
        }
        total = sum(joint.values())
        self.add(log(self._heading(self._steps.likelihood(room, start, position))) - log(total))
        self._position = position
        self._open = [name for name in self._open if name == room or name not in seen]
        left = {name: joint[name] / total for name in self._open}
        ruled_out = 1 - sum(left.values())
        again = self._guesses(position)
        self._minds = {name: mind + ruled_out * again[name] for name, mind in left.items()}

    def _heading(self, likelihood: float) -> float:
        """P(a step | the walker heads for the room), of which the policy alone would make
        `likelihood`: whoever is astray comes nearer with one step in two."""
        begins, ends = self._assumed.astray
        astray = self._astray * (1 - ends) + (1 - self._astray) * begins
        total = astray / 2 + (1 - astray) * likelihood
        self._astray = astray / 2 / total
        return total

    def paced(self, ratio: float) -> None:
        """A step took `ratio` times as long as this person's usual one."""
        self._pace.stepped(ratio)

    def add(self, evidence: float) -> None:
        """Take in evidence, in log odds, that the walker knows the way."""
        self._said = self._limited(self._said + evidence)

    def _limited(self, evidence: float) -> float:
        limit = self._assumed.walk_limit
        return max(-limit, min(limit, evidence))

    def _guesses(self, cell: Cell) -> dict[str, float]:
        """Where a searcher at `cell` thinks of looking."""
        reach = self._assumed.reach_cells
        weights = {name: exp(-self._steps.distance(name, cell) / reach) for name in self._open}
        total = sum(weights.values())
        return {name: weight / total for name, weight in weights.items()}


class WalkPace:
    """What the pace of a walk says: people who search step more slowly than they usually do.

    The steps of a walk are alike, so that each says less than the one before. Its pace, the
    logarithm of how many times as long as usual a step takes, is normal with `pace_mean` and
    `pace_sd`, for somebody who knows the way and for somebody who searches, and a step varies about
    it by `pace_noise`; the evidence is that of the mean of all steps.
    """

    def __init__(self, assumed: Assumed) -> None:
        self._assumed = assumed
        self._steps = 0
        self._total = 0.0

    def stepped(self, ratio: float) -> None:
        """A step took `ratio` times as long as this person's usual one."""
        limit = self._assumed.pace_limit
        self._steps += 1
        self._total += max(-limit, min(limit, log(ratio)))

    @property
    def evidence(self) -> float:
        """In log odds, that the walker knows the way."""
        if not self._steps:
            return 0.0
        pace, noise = self._total / self._steps, self._assumed.pace_noise**2 / self._steps
        known, unknown = (
            -((pace - mean) ** 2) / (2 * (sd**2 + noise)) - log(sd**2 + noise) / 2
            for mean, sd in zip(self._assumed.pace_mean, self._assumed.pace_sd, strict=True)
        )
        return known - unknown


def log_odds(assumed: Assumed, answer: QuizMark) -> float:
    """What an answer in the label quiz says about the room, in log odds."""
    known, unknown = {
        "right": assumed.quiz_right,
        "wrong": assumed.quiz_wrong,
        "blank": assumed.quiz_blank,
    }[answer]
    return log(known / unknown)


def _odds(evidence: float) -> float:
    return exp(max(-MOST_LOG_ODDS, min(MOST_LOG_ODDS, evidence)))
