"""The best way to a goal through the graph of the executions in `landmarks`.

Every move on a way ends nearer to the goal than it began. Words and detours are weighed against
each other; ways are found once for a goal and kept while the same victims wait.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

from game.coach.instructions.landmarks import Landmarks, Move
from game.coach.instructions.legs import BY_EFFORT
from game.coach.instructions.scene import Scene
from game.coach.instructions.vocabulary import VICTIM_AT_C2, Tuples
from game.world.building import Severity
from game.world.geometry import Cell, Heading

MOST_DETOUR = 2
"""How many steps away from the goal an instruction may contain; three would look like a misstep."""

TUPLE_COST, DETOUR_COST, COUNT_COST = 6, 4, 1
"""What a tuple, a step away from the goal, and each door or intersection beyond the first weigh."""

SILENCE_COST, STEP_COST = 40, 1
"""What it weighs to be at a loss for words, and then each step to the goal: where no way can be
told to its end, it is told as far as this is worth it."""

Alike = frozenset[Cell]
"""Where the waiting victims of the goal's colour lie."""

TURNS: tuple[Tuples, ...] = ((), (("Turn", "right"),), (("Turn", "Around"),), (("Turn", "left"),))
"""How to say a turn of so many quarters to the right."""

MOST_KEPT = 64
"""The ways to so many goals are kept for a building before all are forgotten."""


class Stage(NamedTuple):
    """The first part of the best way from somewhere: what to say, and the move that it makes.

    Without words there is nothing to say at this level; with words and no move it is the approach,
    and the end. `cost` is that of the whole way.
    """

    cost: int
    said: Tuples
    move: Move | None


class WaysToGoal:
    """The best ways to one goal, from anywhere, while the same victims of its colour wait."""

    def __init__(self, goal: Cell, severity: Severity, alike: Alike, landmarks: Landmarks) -> None:
        self._landmarks = landmarks
        self._plan = landmarks.building.plan
        self._goal = goal
        self._floodfills = landmarks.building.terrain.floodfills
        self._distances = self._floodfills.to(goal)
        self._alike = alike
        self._victim = VICTIM_AT_C2[severity]
        self._near_goal = landmarks.lookouts(goal)
        self._lookouts = 0
        for victim in self._alike:
            self._lookouts |= landmarks.lookouts(victim)
        self._views: dict[int, tuple[Cell, ...]] = {}
        self._stages: dict[tuple[int, Heading], Stage] = {}

    def stage(self, cell: int, facing: Heading) -> Stage:
        """The first stage of the best way from here."""
        key = cell, facing
        stage = self._stages.get(key)
        if stage is None:
            stage = self._stages[key] = self._find(cell, facing)
        return stage

    def detour(self, cell: int, move: Move | None) -> int:
        """How many of a move's steps lead away from the goal; the approach has none."""
        if move is None:
            return 0
        nearer = self._distances[cell] - self._distances[move.end]
        return (move.steps - nearer) // 2

    def _find(self, cell: int, facing: Heading) -> Stage:
        if self._can_approach(cell):
            return Stage(TUPLE_COST, (("ApproachAndSave", self._victim),), None)
        distances = self._distances
        here = distances[cell]
        best = Stage(SILENCE_COST + STEP_COST * here, (), None)
        for turned, move in self._moves(cell, facing):
            nearer = here - distances[move.end]
            if nearer <= 0:
                continue
            detour = (move.steps - nearer) // 2
            cost = TUPLE_COST * (len(turned) + 1)
            cost += DETOUR_COST * detour + COUNT_COST * (move.counted - 1)
            if detour > MOST_DETOUR or cost + TUPLE_COST >= best.cost:
                continue
            cost += self.stage(move.end, move.heading).cost
            if cost < best.cost:
                best = Stage(cost, (*turned, move.said), move)
        return best

    def _moves(self, cell: int, facing: Heading) -> Iterator[tuple[Tuples, Move]]:
        """Every move from here that begins nearer to the goal, with the turn it needs."""
        leave = self._landmarks.exit(cell)
        if leave is not None:
            yield (), leave
        for heading in BY_EFFORT[facing]:
            ahead = cell + self._landmarks.strides[heading]
            if self._distances[ahead] < self._distances[cell]:
                turned = TURNS[(heading - facing) % 4]
                look_out = self._until_seen(cell, heading)
                if look_out is not None:
                    yield turned, look_out
                for move in self._landmarks.moves(cell, heading):
                    yield turned, move

    def _can_approach(self, cell: int) -> bool:
        """Whether the goal is in view, and nearer than every other victim of its colour there."""
        if not self._near_goal >> cell & 1:
            return False
        seen = self._seen(cell)
        if self._goal not in seen:
            return False
        here, distance = self._plan.cell(cell), self._distances[cell]
        return all(
            self._floodfills.distance(here, other) > distance
            for other in seen
            if other != self._goal
        )

    def _until_seen(self, start: int, heading: Heading) -> Move | None:
        """`Proceed redvictim`: straight ahead until a victim of the goal's colour is in view. Made
        only in the goal's own room, where none is in view at the start, and the goal is at the
        end."""
        if not self._landmarks.share_room(start, self._goal) or self._seen(start):
            return None
        for steps in range(1, self._landmarks.clear(start, heading) + 1):
            cell = start + steps * self._landmarks.strides[heading]
            seen = self._seen(cell)
            if seen:
                found = Move(("Proceed", f"1 {self._victim}"), cell, cell, heading, steps)
                return found if self._goal in seen else None
        return None

    def _seen(self, cell: int) -> tuple[Cell, ...]:
        """The waiting victims of the goal's colour that are in view."""
        seen = self._views.get(cell)
        if seen is None:
            seen = self._views[cell] = self._look(cell)
        return seen

    def _look(self, cell: int) -> tuple[Cell, ...]:
        if not self._lookouts >> cell & 1:
            return ()
        field = self._landmarks.sight.field(self._plan.cell(cell))
        return tuple(victim for victim in self._alike if field >> self._plan.index(victim) & 1)


class WaysToGoals:
    """The best ways in one building, kept between instructions and missions."""

    def __init__(self, scene: Scene) -> None:
        self.landmarks = Landmarks(scene.building, scene.settings.sight_radius)
        self._ways: dict[tuple[Cell, Severity, Alike], WaysToGoal] = {}

    def to(self, scene: Scene, goal: str) -> WaysToGoal:
        """The ways to `goal` while the victims wait that wait now."""
        site = scene.victim(goal)
        alike = frozenset(
            other.cell for other in scene.waiting.values() if other.severity is site.severity
        )
        key = site.cell, site.severity, alike
        ways = self._ways.get(key)
        if ways is None:
            if len(self._ways) >= MOST_KEPT:
                self._ways.clear()
            ways = self._ways[key] = WaysToGoal(*key, self.landmarks)
        return ways


def ways_in(scene: Scene) -> WaysToGoals:
    """The ways in the scene's building."""
    key = "ways", scene.settings.sight_radius, scene.building.labels
    return scene.building.terrain.shared(key, lambda: WaysToGoals(scene))
