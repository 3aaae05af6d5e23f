from __future__ import annotations

import json
from collections.abc import Iterator
from math import exp
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from game.coach.goals import goal_posterior, instructed_prior, uniform_prior
from game.world.floodfill import cost_to_go
from game.world.plan import Plan

VECTORS = Path(__file__).resolve().parents[1] / "reference" / "goal_inference.json"
HALL = [[False] * 7, [False, True, True, True, True, True, False], [False] * 7]


def _vector_cases() -> Iterator[Any]:
    for case in json.loads(VECTORS.read_text())["cases"]:
        for n, expected in enumerate(case["expected"]):
            yield pytest.param(case, expected, id=f"{case['name']}-{n}")


def _prior(case: dict[str, Any], expected: dict[str, Any], goals: Any) -> dict[str, float]:
    same_room = [g for g in goals if case["rooms"][g] == case["rooms"][case["gstar"]]]
    members = same_room if expected["aggregate"] == "room" else [case["gstar"]]
    match expected["prior"]:
        case "uniform":
            return uniform_prior(goals)
        case "instructed":
            return instructed_prior(goals, members, expected["prior_param"])
        case _:
            start = tuple(case["path"][0])
            grid = case["grid"]
            tiles = bytes(c == "#" for row in grid for c in row)
            plan = Plan(len(grid[0]), len(grid), tiles)
            to = {g: cost_to_go(plan, (x, y))[plan.index(start)] for g, (x, y) in goals.items()}
            return {g: exp(-d / expected["prior_param"]) for g, d in to.items()}


@pytest.mark.parametrize(("case", "expected"), list(_vector_cases()))
def test_worked_cases(case: dict[str, Any], expected: dict[str, Any]) -> None:
    goals = {g: case["goals"][g] for g in case["active"]}
    walkable = np.array([[c != "#" for c in row] for row in case["grid"]])
    result = goal_posterior(
        walkable,
        goals,
        case["path"],
        likelihood=expected["likelihood"],
        beta=expected["beta"],
        prior=_prior(case, expected, goals),
    )
    assert result == pytest.approx(expected["posterior"], abs=1e-9)
    nested = [list(map(bool, row)) for row in walkable]
    assert result == goal_posterior(
        nested,
        goals,
        case["path"],
        likelihood=expected["likelihood"],
        beta=expected["beta"],
        prior=_prior(case, expected, goals),
    )


def test_released_step_by_hand() -> None:
    # In a hall both ways are open; the goals are 4 and 2 cells away, all within 5: e = 0.1.
    result = goal_posterior(
        HALL,
        {"left": (1, 1), "right": (5, 1)},
        [(3, 1), (4, 1)],
        likelihood="released",
        prior=uniform_prior(["left", "right"]),
    )
    assert result == pytest.approx({"left": 0.1, "right": 0.9}, abs=1e-12)


def test_released_expects_more_errors_far_from_the_goal() -> None:
    hall = [[True] * 20]
    result = goal_posterior(
        hall,
        {"near": (3, 0), "far": (14, 0)},
        [(8, 0), (9, 0)],
        likelihood="released",
        prior={"near": 0.5, "far": 0.5},
    )
    assert result == pytest.approx({"near": 0.1 / 0.8, "far": 0.7 / 0.8}, abs=1e-12)


def test_unreachable_goal_has_no_part() -> None:
    grid = [[True, True, False, True]]
    goals = {"here": (1, 0), "beyond": (3, 0)}
    prior = {"here": 0.1, "beyond": 0.9}
    assert goal_posterior(grid, goals, [(0, 0)], prior=prior) == {"here": 1.0, "beyond": 0.0}
    with pytest.raises(ValueError, match="no goal is left"):
        goal_posterior(grid, {"beyond": (3, 0)}, [(0, 0)], prior={"beyond": 1.0})


def test_large_beta_does_not_overflow() -> None:
    result = goal_posterior(
        HALL,
        {"left": (1, 1), "right": (5, 1)},
        [(3, 1), (4, 1)],
        beta=1e4,
        prior=uniform_prior(["left", "right"]),
    )
    assert result == {"left": 0.0, "right": 1.0}


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"path": []}, "at least the cell"),
        ({"path": [(0, 0)]}, r"path\[0\] at \(0, 0\) is in a wall"),
        ({"path": [(1, 1), (3, 1)]}, "jumps"),
        ({"path": [(1, 1), (9, 1)]}, "outside"),
        ({"path": [(-1, 1)]}, "outside"),
        ({"goals": {"left": (0, 0)}}, "goal 'left' at .* is in a wall"),
        ({"goals": {}}, "no goal is left"),
        ({"goals": {"new": (1, 1)}}, "no probability for goal 'new'"),
        ({"prior": {"left": -0.1, "right": 1.1}}, "at least 0"),
        ({"prior": {"left": 0.0, "right": 0.0}}, "no goal is left"),
        ({"likelihood": "guess"}, "likelihood"),
        ({"beta": -1.0}, "beta"),
        ({"beta": float("nan")}, "beta"),
        ({"walkable": []}, "no cells"),
        ({"walkable": [[True, True], [True]]}, "row 1"),
    ],
)
def test_bad_input_is_named(change: dict[str, Any], message: str) -> None:
    arguments: dict[str, Any] = {
        "walkable": HALL,
        "goals": {"left": (1, 1), "right": (5, 1)},
        "path": [(3, 1), (4, 1)],
        "prior": {"left": 0.5, "right": 0.5},
    }
    arguments |= change
    with pytest.raises(ValueError, match=message):
        goal_posterior(arguments.pop("walkable"), **arguments)


def test_priors() -> None:
    assert uniform_prior("abcd") == dict.fromkeys("abcd", 0.25)
    shared = instructed_prior("abcd", ["a", "b"], 0.5)
    assert shared == {"a": 0.25, "b": 0.25, "c": 0.25, "d": 0.25}
    assert instructed_prior("abc", ["a"], 0.8) == pytest.approx({"a": 0.8, "b": 0.1, "c": 0.1})
    assert instructed_prior("ab", ["a", "b"], 0.2) == {"a": 0.5, "b": 0.5}


@pytest.mark.parametrize(
    ("members", "mass", "message"),
    [([], 0.5, "at least one"), (["z"], 0.5, r"\['z'\]"), (["a"], 1.5, "mass")],
)
def test_bad_instructed_prior(members: list[str], mass: float, message: str) -> None:
    with pytest.raises(ValueError, match=message):
        instructed_prior("abc", members, mass)
    with pytest.raises(ValueError, match="at least one goal"):
        uniform_prior([])


@given(
    steps=st.lists(st.sampled_from([-1, 0, 1]), max_size=30),
    beta=st.floats(0, 5),
    likelihood=st.sampled_from(["boltzmann", "cost_difference", "released"]),
)
def test_posterior_is_a_distribution_that_ignores_pauses(
    steps: list[int], beta: float, likelihood: str
) -> None:
    cells = [3]
    for step in steps:
        cells.append(min(5, max(1, cells[-1] + step)))
    path = [(x, 1) for x in cells]
    without_pauses = [cell for i, cell in enumerate(path) if i == 0 or cell != path[i - 1]]
    goals = {"left": (1, 1), "middle": (3, 1), "right": (5, 1)}

    def infer(path: list[tuple[int, int]]) -> dict[str, float]:
        prior = uniform_prior(goals)
        return goal_posterior(HALL, goals, path, likelihood=likelihood, beta=beta, prior=prior)

    assert sum(infer(path).values()) == pytest.approx(1, abs=1e-12)
    assert infer(path) == infer(without_pauses)
