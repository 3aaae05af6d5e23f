"""Goal inference: where is a walker headed (paper 5.2.1, equation 1; Baker et al., 2009)?

A move on a four-neighbour grid changes the cost-to-go D_g of a goal by exactly one. So all that a
move tells about a goal is its *pattern*: whether it came nearer, how many of the neighbours it
could have chosen are nearer and how many are farther, and whether it began close to the goal.
Each likelihood gives every pattern a log factor, held as a whole number of `UNIT`s. Sums of whole
numbers are exact in any order, so the incremental `game.coach.goal_filter`, which adds what enters
its window and subtracts what leaves it, gives the same numbers to the last bit.
"""

from __future__ import annotations

from collections.abc import Collection, Hashable, Iterable, Mapping, Sequence
from functools import cache
from itertools import pairwise
from math import exp, fsum, inf, isfinite, log
from typing import Any, Literal, NamedTuple, Protocol, TypeVar, get_args

from game.world.floodfill import UNREACHABLE, Floodfill, cost_to_go
from game.world.geometry import Cell
from game.world.plan import Plan, Tile

Likelihood = Literal["boltzmann", "cost_difference", "released"]
"""How probable a step is for a walker headed to a goal; see `log_factor`."""

Goal = TypeVar("Goal", bound=Hashable)
"""The identity of a goal: for the coach a victim's id."""

CLOSE_CELLS = 5
"""Within so many moves of the goal the `released` likelihood expects fewer errors."""
_ERROR, _ERROR_CLOSE = 0.3, 0.1

UNIT = 2.0**-52
"""The unit of log factors: fine enough that a thousand moves stay within 1e-12."""
MAX_BETA = 1e6


class Grid(Protocol):
    """Rows of truth values, as nested sequences or as a two-dimensional array."""

    def __len__(self) -> int: ...

    def __getitem__(self, row: int, /) -> Any: ...


class StepPattern(NamedTuple):
    """What one move looks like from one goal.

    `nearer_ways` and `farther_ways` count the walkable neighbours of the cell that was left;
    `close` tells whether that cell is within `CLOSE_CELLS` of the goal.
    """

    nearer: bool
    nearer_ways: int
    farther_ways: int
    close: bool


def goal_posterior(
    walkable: Grid,
    goals: Mapping[Goal, Sequence[int]],
    path: Sequence[Sequence[int]],
    *,
    likelihood: str = "boltzmann",
    beta: float = 1.0,
    prior: Mapping[Goal, float],
) -> dict[Goal, float]:
    """P(goal | path) for every goal, from scratch (paper, equation 1).

    `walkable`: height x width truth values. `goals`: id -> (x, y). `path`: cells (x, y), each
    equal to the one before (a pause, which tells nothing) or beside it. `likelihood`: see
    `log_factor`; `beta`: its rationality, in 1 / cells. `prior`: id -> probability of at least
    these goals; weights that do not sum to 1 are normalised.

    A goal that cannot be reached from the path has posterior 0. Raises ValueError when none is
    left, and for a grid, goal, path, likelihood, beta or prior that makes no sense.
    """
    plan = _plan_of(walkable)
    places = {goal: _floor_cell(plan, cell, f"goal {goal!r}") for goal, cell in goals.items()}
    cells = _checked_path(plan, path)
    factors = _checked_likelihood(likelihood), _checked_beta(beta)
    start = plan.index(cells[0])
    moves = [(plan.index(a), plan.index(b)) for a, b in pairwise(cells) if a != b]
    log_likelihoods = {}
    for goal, cell in places.items():
        floodfill = cost_to_go(plan, cell)
        if floodfill[start] == UNREACHABLE:
            log_likelihoods[goal] = -inf
        else:
            patterns = (step_pattern(plan, floodfill, *move) for move in moves)
            log_likelihoods[goal] = UNIT * sum(log_factor(p, *factors) for p in patterns)
    return posterior(log_likelihoods, prior)


def uniform_prior(goals: Iterable[Goal]) -> dict[Goal, float]:
    """The same probability for every goal. Raises ValueError when there is none."""
    names = list(goals)
    if not names:
        raise ValueError("a prior needs at least one goal")
    return dict.fromkeys(names, 1 / len(names))


def instructed_prior(
    goals: Iterable[Goal], members: Collection[Goal], mass: float
) -> dict[Goal, float]:
    """Probability `mass` split evenly over `members`, the rest evenly over the other goals.

    `members` are the instructed goal alone, or all goals in its room. Where there are no other
    goals the members share 1. Raises ValueError when a member is not a goal, when there is no
    member, or when `mass` is not a probability.
    """
    names = list(goals)
    instructed = set(members)
    if not instructed:
        raise ValueError("an instructed prior needs at least one member")
    if strangers := instructed.difference(names):
        raise ValueError(f"members that are not goals: {sorted(map(str, strangers))}")
    if not 0 <= mass <= 1:
        raise ValueError(f"mass must be between 0 and 1, not {mass}")
    others = len(names) - len(instructed)
    inside = (mass if others else 1) / len(instructed)
    outside = (1 - mass) / others if others else 0.0
    return {name: inside if name in instructed else outside for name in names}


def step_pattern(plan: Plan, floodfill: Floodfill, start: int, end: int) -> StepPattern:
    """The pattern of the move from index `start` to index `end` for the floodfill's goal."""
    here = floodfill[start]
    ways = plan.neighbours[start]
    nearer_ways = sum(floodfill[way] < here for way in ways)
    close = here <= CLOSE_CELLS
    return StepPattern(floodfill[end] < here, nearer_ways, len(ways) - nearer_ways, close)


@cache
def log_factor(pattern: StepPattern, likelihood: Likelihood, beta: float) -> int:
    """The logarithm of what one move contributes to P(path | goal), in `UNIT`s.

    boltzmann: exp(-beta D(end)) over its sum for all neighbours of the start.
    cost_difference: exp(beta (D(start) - 1 - D(end))), so that a path's product is
    exp(beta (D(first) - moves - D(last))).
    released: as the public code of the study did it: 1 - e for a move that does not raise D and
    else e, over the sum for all neighbours, with e = 0.3 or close to the goal 0.1; no beta.
    """
    return round(_log_factor(pattern, likelihood, beta) / UNIT)


def _log_factor(pattern: StepPattern, likelihood: Likelihood, beta: float) -> float:
    nearer, nearer_ways, farther_ways, close = pattern
    match likelihood:
        case "boltzmann":
            if nearer_ways == 0:
                return -log(farther_ways)
            norm = log(nearer_ways + farther_ways * exp(-2 * beta))
            return -norm if nearer else -2 * beta - norm
        case "cost_difference":
            return 0.0 if nearer else -2 * beta
        case "released":
            error = _ERROR_CLOSE if close else _ERROR
            norm = nearer_ways * (1 - error) + farther_ways * error
            return log((1 - error if nearer else error) / norm)


def posterior(
    log_likelihoods: Mapping[Goal, float], prior: Mapping[Goal, float]
) -> dict[Goal, float]:
    """Bayes' rule over the goals of `log_likelihoods` (-inf: the goal is impossible).

    Raises ValueError when the prior lacks a goal or holds something that is not a probability, and
    when no goal is left.
    """
    logs = {}
    for goal, value in log_likelihoods.items():
        if goal not in prior:
            raise ValueError(f"the prior has no probability for goal {goal!r}")
        weight = prior[goal]
        if not (isfinite(weight) and weight >= 0):
            raise ValueError(f"the prior of goal {goal!r} must be at least 0, not {weight}")
        logs[goal] = value + log(weight) if weight else -inf
    highest = max(logs.values(), default=-inf)
    if highest == -inf:
        raise ValueError("no goal is left that the path can reach and the prior allows")
    weights = {goal: exp(value - highest) for goal, value in logs.items()}
    total = fsum(weights.values())
    return {goal: weight / total for goal, weight in weights.items()}


def _plan_of(walkable: Grid) -> Plan:
    rows = [[bool(value) for value in walkable[y]] for y in range(len(walkable))]
    if not rows or not rows[0]:
        raise ValueError("walkable has no cells")
    width = len(rows[0])
    for y, row in enumerate(rows):
        if len(row) != width:
            raise ValueError(f"row {y} of walkable has {len(row)} cells, not {width}")
    return Plan(width, len(rows), bytes(Tile.FLOOR if v else Tile.WALL for r in rows for v in r))


def _floor_cell(plan: Plan, cell: Sequence[int], what: str) -> Cell:
    x, y = cell
    place = int(x), int(y)
    if place not in plan:
        raise ValueError(f"{what} at {place} is outside the {plan.width} x {plan.height} grid")
    if not plan.walkable(place):
        raise ValueError(f"{what} at {place} is in a wall")
    return place


def _checked_path(plan: Plan, path: Sequence[Sequence[int]]) -> list[Cell]:
    cells = [_floor_cell(plan, cell, f"path[{i}]") for i, cell in enumerate(path)]
    if not cells:
        raise ValueError("a path needs at least the cell where it begins")
    for i, ((x, y), (to_x, to_y)) in enumerate(pairwise(cells)):
        if abs(x - to_x) + abs(y - to_y) > 1:
            raise ValueError(f"the path jumps from {(x, y)} to {(to_x, to_y)} at path[{i + 1}]")
    return cells


def _checked_likelihood(likelihood: str) -> Likelihood:
    for known in get_args(Likelihood):
        if likelihood == known:
            return known  # type: ignore[no-any-return]
    raise ValueError(f"likelihood must be one of {get_args(Likelihood)}, not {likelihood!r}")


def _checked_beta(beta: float) -> float:
    if not 0 <= beta <= MAX_BETA:
        raise ValueError(f"beta must lie between 0 and {MAX_BETA:g}, not {beta}")
    return float(beta)
