from __future__ import annotations

from itertools import pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st

from game.coach.goal_filter import GoalFilter, StepTable
from game.coach.goals import Likelihood, goal_posterior, uniform_prior
from game.world.floodfill import Floodfills
from game.world.geometry import Cell
from game.world.plan import Plan

ROWS = (
    "###########",
    "#...#.....#",
    "#...#..#..#",
    "#.......#.#",
    "#...#..#..#",
    "###.#####.#",
    "#........#.",
)
PLAN = Plan(len(ROWS[0]), len(ROWS), bytes(c == "#" for row in ROWS for c in row))
WALKABLE = [[c != "#" for c in row] for row in ROWS]
GOALS: dict[str, Cell] = {"a": (1, 1), "b": (5, 1), "c": (9, 3), "d": (1, 6), "e": (10, 6)}
FLOODFILLS = Floodfills(PLAN)


def _walk(choices: list[int]) -> list[Cell]:
    """A walk from the middle; a choice past the ways that are open is a pause."""
    path = [(3, 3)]
    for choice in choices:
        ways = PLAN.neighbours[PLAN.index(path[-1])]
        path.append(PLAN.cell(ways[choice]) if choice < len(ways) else path[-1])
    return path


def _window(path: list[Cell], window_moves: int | None) -> list[Cell]:
    moves = [path[0], *(b for a, b in pairwise(path) if a != b)]
    return moves if window_moves is None else moves[-window_moves - 1 :]


@given(
    choices=st.lists(st.integers(0, 4), max_size=60),
    window_moves=st.one_of(st.none(), st.integers(1, 20)),
    likelihood=st.sampled_from(["boltzmann", "cost_difference", "released"]),
    beta=st.sampled_from([0.0, 0.3, 1.0, 2.5]),
    waiting=st.sets(st.sampled_from("abcd"), min_size=1),
)
def test_incremental_equals_from_scratch_to_the_last_bit(
    choices: list[int],
    window_moves: int | None,
    likelihood: Likelihood,
    beta: float,
    waiting: set[str],
) -> None:
    path = _walk(choices)
    table = StepTable(FLOODFILLS, GOALS, likelihood=likelihood, beta=beta)
    running = GoalFilter(table, path[0], window_moves)
    for cell in path[1:]:
        running.moved(cell)
    window = _window(path, window_moves)
    goals = {g: GOALS[g] for g in GOALS if g in waiting}
    prior = uniform_prior(goals)
    scratch = goal_posterior(WALKABLE, goals, window, likelihood=likelihood, beta=beta, prior=prior)
    assert running.posterior(goals, prior) == scratch
    assert running.moves == len(window) - 1


def _filter() -> GoalFilter:
    table = StepTable(FLOODFILLS, GOALS, likelihood="boltzmann", beta=1)
    return GoalFilter(table, (3, 3), window_moves=None)


def test_restart_forgets_the_walk() -> None:
    running = _filter()
    running.moved((4, 3))
    running.restart((4, 3))
    assert running.moves == 0
    assert running.posterior("abcd", uniform_prior("abcd")) == uniform_prior("abcd")


def test_an_unreachable_goal_has_no_part() -> None:
    running = _filter()
    assert running.posterior("ae", uniform_prior("ae")) == {"a": 1.0, "e": 0.0}
    with pytest.raises(ValueError, match="no goal is left"):
        running.posterior("e", {"e": 1.0})


@pytest.mark.parametrize("cell", [(9, 3), (3, 5), (-1, 4), (14, 2)])
def test_a_jump_is_refused(cell: Cell) -> None:
    with pytest.raises(ValueError, match="no move from"):
        _filter().moved(cell)
