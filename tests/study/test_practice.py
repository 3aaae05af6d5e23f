"""Practice: every level equally often, in random order, each leg a mission of its own."""

from __future__ import annotations

from collections import Counter

from hypothesis import given
from hypothesis import strategies as st

from game.coach.acts import Level
from game.study.protocol.practice import LEGS, leg_building, leg_start, practice_legs
from game.world import load_building
from game.world.geometry import Heading
from game.world.reading import parse_building

BUILDING = load_building("practice")


@given(st.integers(0, 2**32 - 1))
def test_levels_come_in_pairs_each_opened_by_a_lesson(seed: int) -> None:
    planned = practice_legs(BUILDING, seed)
    assert Counter(leg.level for leg in planned) == dict.fromkeys(Level, 2)
    assert [leg.opens_kind for leg in planned] == [True, False] * 3
    assert all(planned[n].level is planned[n + 1].level for n in range(0, LEGS, 2))
    assert len({leg.victim.id for leg in planned}) == LEGS


def test_the_order_of_levels_is_drawn() -> None:
    orders = Counter(
        tuple(leg.level for leg in practice_legs(BUILDING, seed))[::2] for seed in range(300)
    )
    assert len(orders) == 6
    assert min(orders.values()) > 25


@given(st.integers(0, 100), st.integers(0, LEGS - 1), st.sampled_from(Heading))
def test_a_leg_is_a_building_that_can_be_written_and_read(
    seed: int, number: int, heading: Heading
) -> None:
    planned = practice_legs(BUILDING, seed)
    leg = planned[number]
    start, _ = leg_start(BUILDING, planned[:number], None)
    building = leg_building(BUILDING, leg, start, heading)
    assert parse_building(building.text) == building
    assert [site.cell for site in building.victims] == [leg.victim.cell]
    assert building.rooms == BUILDING.rooms


def test_a_leg_begins_where_the_rescuer_stands_if_that_is_floor() -> None:
    planned = practice_legs(BUILDING, 1)
    floor, door = (3, 4), BUILDING.doors[0].cells[0]
    assert leg_start(BUILDING, planned[:1], (floor, Heading.WEST)) == (floor, Heading.WEST)
    there, _ = leg_start(BUILDING, planned[:1], (door, Heading.WEST))
    assert there == planned[0].victim.cell
    assert leg_start(BUILDING, (), None) == (BUILDING.start, BUILDING.start_heading)
