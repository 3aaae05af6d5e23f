from __future__ import annotations

from functools import cache
from itertools import permutations
from pathlib import Path
from random import Random

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from game.world import load_building
from game.world.building import Building, Severity, VictimSite
from game.world.floodfill import Floodfills
from game.world.geometry import Cell
from game.world.route import (
    PASSING_BY_MOVES,
    SPARE_MOVES,
    WEIGHTS,
    Route,
    RoutePlanner,
)
from game.world.settings import MissionSettings

SETTINGS = MissionSettings()
PACE = SETTINGS.pace_ms
SHIPPED = ("foundry", "harbour", "practice")
REFERENCE = Path(__file__).resolve().parents[1] / "reference"


@cache
def world(name: str) -> tuple[Building, Floodfills, RoutePlanner]:
    building = load_building(name)
    floodfills = Floodfills(building.plan)
    return building, floodfills, RoutePlanner(floodfills, SETTINGS, sites(building))


def sites(building: Building) -> dict[str, VictimSite]:
    return {site.id: site for site in building.victims}


def moves_to(name: str, position: Cell, victim: str) -> int:
    """Moves until a victim is in reach."""
    building, floodfills, _ = world(name)
    return max(0, floodfills.distance(position, sites(building)[victim].cell) - 1)


def due_ms(site: VictimSite) -> int:
    red = site.severity is Severity.RED
    return SETTINGS.reds_expire_ms if red else SETTINGS.duration_ms


def follow(name: str, choose: str) -> list[VictimSite]:
    """Whom a rescuer who makes no mistake saves, led by the route or to the nearest victim."""
    building, floodfills, planner = world(name)
    plan, waiting = building.plan, sites(building)
    position, at_ms, route, saved = building.start, 0, Route((), (), 0, ()), []
    while waiting:
        if choose == "route":
            route = planner.plan(position, at_ms, waiting, ms_per_move=PACE, before=route.order)
            if not route.order:
                break
            goal = route.order[0]
        else:
            goal = min(waiting, key=lambda v: floodfills.distance(position, waiting[v].cell))
        field, here = floodfills.to(waiting[goal].cell), plan.index(position)
        while field[here] > 1:
            here = min(plan.neighbours[here], key=field.__getitem__)
            at_ms += PACE
        position, site = plan.cell(here), waiting.pop(goal)
        done_ms = at_ms + PACE + SETTINGS.treatment_ms(site.severity)
        if done_ms <= due_ms(site):
            at_ms = done_ms
            saved.append(site)
        if at_ms >= SETTINGS.reds_expire_ms:
            waiting = {v: s for v, s in waiting.items() if s.severity is Severity.BLUE}
    return saved


@st.composite
def situations(draw: st.DrawFn) -> tuple[str, Cell, int, list[str]]:
    name = draw(st.sampled_from(SHIPPED))
    building = world(name)[0]
    floor = [cell for room in building.rooms for cell in room.cells]
    waiting = draw(st.lists(st.sampled_from(sorted(sites(building))), unique=True))
    return name, draw(st.sampled_from(floor)), draw(st.integers(0, 239_000)), waiting


@given(situations())
def test_a_route_holds_every_victim_once_and_is_in_time(
    situation: tuple[str, Cell, int, list[str]],
) -> None:
    name, position, at_ms, waiting = situation
    building, _, planner = world(name)
    route = planner.plan(position, at_ms, waiting, ms_per_move=PACE)
    assert sorted(route.order + route.left_out) == sorted(waiting)
    assert list(route.rescue_ms) == sorted(route.rescue_ms)
    of = sites(building)
    for victim, done_ms in zip(route.order, route.rescue_ms, strict=True):
        spare_ms = SPARE_MOVES * PACE if of[victim].severity is Severity.RED else 0
        assert at_ms < done_ms <= due_ms(of[victim]) - spare_ms
    assert route.worth == sum(WEIGHTS[of[victim].severity] for victim in route.order)
    if planner.reaches_all(position, at_ms, waiting, ms_per_move=PACE):
        assert not route.left_out


@given(situations(), st.integers(0, 99))
def test_the_route_followed_so_far_is_never_lost(
    situation: tuple[str, Cell, int, list[str]], seed: int
) -> None:
    name, position, at_ms, waiting = situation
    planner = world(name)[2]
    before = Random(seed).sample(waiting, len(waiting))
    kept = planner.along(before, position, at_ms, ms_per_move=PACE)
    found = planner.plan(position, at_ms, waiting, ms_per_move=PACE, before=before)
    assert found.worth >= kept.worth
    assert not kept.saves(found, PASSING_BY_MOVES * PACE + 1)


@given(situations())
def test_few_victims_are_ordered_as_well_as_by_trying_all_orders(
    situation: tuple[str, Cell, int, list[str]],
) -> None:
    name, position, at_ms, waiting = situation
    planner, few = world(name)[2], waiting[:4]
    found = planner.plan(position, at_ms, few, ms_per_move=PACE)
    tried = (planner.along(o, position, at_ms, ms_per_move=PACE) for o in permutations(few))
    assert found.worth == max(route.worth for route in tried)


@given(situations())
def test_nobody_is_led_past_a_victim_for_a_step_or_two(
    situation: tuple[str, Cell, int, list[str]],
) -> None:
    name, position, at_ms, waiting = situation
    planner = world(name)[2]
    route = planner.plan(position, at_ms, waiting, ms_per_move=PACE)
    assume(route.order)
    nearest = min(route.order, key=lambda victim: moves_to(name, position, victim))
    others = [victim for victim in route.order if victim != nearest]
    near_first = planner.along([nearest, *others], position, at_ms, ms_per_move=PACE)
    if route.order[0] != nearest and near_first.worth == route.worth:
        assert near_first.rescue_ms[-1] > route.rescue_ms[-1] + PASSING_BY_MOVES * PACE


def test_the_same_question_has_the_same_answer() -> None:
    building, floodfills, planner = world("foundry")
    asked = []
    for _ in range(2):
        other = RoutePlanner(floodfills, SETTINGS, sites(building), seed=3)
        asked += [
            other.plan(building.start, 0, sites(building), ms_per_move=PACE) for _ in range(2)
        ]
    assert len(set(asked)) == 1
    assert planner.plan(building.start, 9_000, sites(building), ms_per_move=PACE) != asked[0]


def test_a_red_victim_who_cannot_be_reached_in_time_is_left_out() -> None:
    building, _, planner = world("foundry")
    reds = [site.id for site in building.victims if site.severity is Severity.RED]
    route = planner.plan(building.start, 115_000, sites(building), ms_per_move=PACE)
    assert set(reds) <= set(route.left_out)
    assert route.order


def test_a_slower_walker_is_planned_for_fewer_rescues() -> None:
    building, _, planner = world("harbour")
    quick, slow = (
        planner.plan(building.start, 0, sites(building), ms_per_move=ms) for ms in (PACE, 2 * PACE)
    )
    assert len(slow.order) < len(quick.order)
    assert slow.worth < quick.worth


@pytest.mark.parametrize("name", ["foundry", "harbour"])
def test_a_plan_is_kept_to_by_a_perfect_follower(name: str) -> None:
    building, _, planner = world(name)
    planned = planner.plan(building.start, 0, sites(building), ms_per_move=PACE)
    assert abs(len(follow(name, "route")) - len(planned.order)) <= 1


@pytest.mark.parametrize("name", ["foundry", "harbour"])
def test_the_route_saves_more_than_going_to_the_nearest(name: str) -> None:
    routed, nearest = follow(name, "route"), follow(name, "nearest")
    worth = [sum(WEIGHTS[site.severity] for site in saved) for saved in (routed, nearest)]
    assert worth[0] > worth[1]
    assert all(site in routed for site in world(name)[0].victims if site.severity is Severity.RED)


@pytest.mark.slow
def test_on_imported_grids_the_route_saves_more_on_average() -> None:
    routed = nearest = 0
    for grid in ("annexe", "terraces"):
        name = str(REFERENCE / f"{grid}.csv")
        routed += len(follow(name, "route"))
        nearest += len(follow(name, "nearest"))
    assert routed > nearest
