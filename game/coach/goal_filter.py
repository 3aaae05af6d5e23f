"""Goal inference as a walk goes on: the numbers of `goal_posterior` at microseconds a step."""

from __future__ import annotations

from collections import deque
from collections.abc import Collection, Mapping
from math import inf
from operator import add, sub

from game.coach.goals import UNIT, Likelihood, log_factor, posterior, step_pattern
from game.world.floodfill import UNREACHABLE, Floodfills
from game.world.geometry import Cell

Step = tuple[int, ...]
"""The log factors of one move for every goal, in the order of the goals."""


class StepTable:
    """The log factors of every move in one building for a set of goals, each when first made."""

    def __init__(
        self,
        floodfills: Floodfills,
        goals: Mapping[str, Cell],
        *,
        likelihood: Likelihood,
        beta: float,
    ) -> None:
        self.goals = tuple(goals)
        self._plan = floodfills.plan
        self._fields = tuple(floodfills.to(cell) for cell in goals.values())
        self._likelihood: Likelihood = likelihood
        self._beta = beta
        self._steps: dict[tuple[Cell, Cell], Step] = {}

    def step(self, start: Cell, end: Cell) -> Step:
        """The move from `start` to `end`. Raises ValueError where there is no such move."""
        step = self._steps.get((start, end))
        if step is None:
            step = self._steps[start, end] = self._new_step(start, end)
        return step

    def reachable(self, cell: Cell) -> tuple[bool, ...]:
        """Which goals can be reached from `cell`."""
        index = self._plan.index(cell)
        return tuple(field[index] != UNREACHABLE for field in self._fields)

    def _new_step(self, start: Cell, end: Cell) -> Step:
        plan = self._plan
        here, there = plan.index(start), plan.index(end)
        if end not in plan or there not in plan.neighbours[here]:
            raise ValueError(f"there is no move from {start} to {end}")
        patterns = (step_pattern(plan, field, here, there) for field in self._fields)
        return tuple(log_factor(p, self._likelihood, self._beta) for p in patterns)


class GoalFilter:
    """P(goal | the moves in the window), kept up to date move by move.

    The window begins with `restart` and holds the last `window_moves` moves, or all of them. The
    sums of every goal are kept whether or not it is still one: `posterior` is asked for the goals
    that are, so a victim rescued or expired in mid-window leaves numerator and denominator for
    the whole window. Equals `goal_posterior` on the window's path to the last bit.
    """

    def __init__(self, table: StepTable, position: Cell, window_moves: int | None) -> None:
        self._table = table
        self._window_moves = window_moves
        self.restart(position)

    @property
    def moves(self) -> int:
        """How many moves the window holds."""
        return len(self._window)

    def restart(self, position: Cell) -> None:
        """Begin an empty window at `position`: a goal has been set."""
        self._position = position
        self._reachable = self._table.reachable(position)
        self._window: deque[Step] = deque()
        self._sums = [0] * len(self._reachable)

    def moved(self, position: Cell, granted: Collection[str] = ()) -> None:
        """The walker is at `position` now; a pause changes nothing. For the goals `granted` the
        move counts as one that came nearer, at the factor 1 of `cost_difference`.

        Raises ValueError when that is not beside where it was.
        """
        if position == self._position:
            return
        step = self._table.step(self._position, position)
        if granted:
            step = tuple(
                0 if goal in granted else factor
                for goal, factor in zip(self._table.goals, step, strict=True)
            )
        self._position = position
        self._window.append(step)
        if self._window_moves is None or len(self._window) <= self._window_moves:
            self._sums = list(map(add, self._sums, step))
        else:
            gone = self._window.popleft()
            self._sums = list(map(sub, map(add, self._sums, step), gone))

    def posterior(self, goals: Collection[str], prior: Mapping[str, float]) -> dict[str, float]:
        """P(goal | window) over `goals`, which are some of the table's; in the table's order.

        Raises ValueError as `goal_posterior` does.
        """
        logs = {
            goal: UNIT * total if reachable else -inf
            for goal, total, reachable in zip(
                self._table.goals, self._sums, self._reachable, strict=True
            )
            if goal in goals
        }
        return posterior(logs, prior)
