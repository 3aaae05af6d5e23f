"""Victims placed by a seed, and difficulties."""

from collections import Counter
from dataclasses import replace
from typing import get_args

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from game.world import load_building
from game.world.building import Building, Severity
from game.world.placing import placed_anew, reached_by_follower
from game.world.reading import parse_building
from game.world.settings import FREE_PLAY
from game.world.variant import DEMANDS, USUAL, Difficulty, Variant, varied, with_demands

NAMES = ("harbour", "foundry", "practice")


def kinds(building: Building) -> Counter[Severity]:
    return Counter(victim.severity for victim in building.victims)


def crowds(building: Building) -> list[int]:
    """How many victims each room with any has."""
    return sorted(Counter(building.room_of(victim) for victim in building.victims).values())


@settings(max_examples=15, deadline=None)
@given(st.sampled_from(NAMES), st.integers(0, 2**32 - 1))
def test_victims_placed_by_a_seed_are_balanced_as_drawn(name: str, seed: int) -> None:
    drawn = load_building(name)
    placed = placed_anew(drawn, seed)
    assert kinds(placed) == kinds(drawn)
    assert crowds(placed) == crowds(drawn)
    assert all(placed.room_of(victim) for victim in placed.victims)
    before, now = reached_by_follower(drawn), reached_by_follower(placed)
    assert now.red == before.red
    assert before.total - 1 <= now.total <= before.total
    assert parse_building(placed.text) == placed
    assert replace(placed, victims=drawn.victims, text=drawn.text) == drawn


def test_a_seed_places_them_always_alike_and_another_elsewhere() -> None:
    drawn = load_building("harbour")
    assert placed_anew(drawn, 1) == placed_anew(drawn, 1)
    assert placed_anew(drawn, 1).victims != placed_anew(drawn, 2).victims != drawn.victims


def test_a_building_with_nobody_in_it_stays_empty() -> None:
    empty = replace(load_building("practice"), victims=())
    assert placed_anew(empty, 1) == empty


@pytest.mark.parametrize("difficulty", get_args(Difficulty))
@pytest.mark.parametrize("name", [*NAMES, "generated:3"])
def test_a_difficulty_has_its_people(name: str, difficulty: Difficulty) -> None:
    drawn = load_building(name)
    building = varied(drawn, Variant(difficulty=difficulty), seed=5)
    share = DEMANDS[difficulty].people / 100
    assert kinds(building) == {kind: round(n * share) for kind, n in kinds(drawn).items()}
    assert len({victim.cell for victim in building.victims}) == len(building.victims)
    assert all(building.room_of(victim) for victim in building.victims)
    assert parse_building(building.text) == building


def test_easy_leaves_people_out_and_hard_adds_some() -> None:
    drawn = {victim.cell for victim in load_building("foundry").victims}
    easy, hard = (
        {victim.cell for victim in varied(load_building("foundry"), variant, 1).victims}
        for variant in (Variant(difficulty="easy"), Variant(difficulty="hard"))
    )
    assert easy < drawn < hard


def test_the_usual_variant_changes_nothing() -> None:
    drawn = load_building("harbour")
    assert varied(drawn, USUAL, 7) is drawn
    assert with_demands(FREE_PLAY, "standard") == FREE_PLAY
    assert USUAL.of_seed(7) == ""


def test_a_difficulty_changes_time_and_view_alone() -> None:
    easy, hard = with_demands(FREE_PLAY, "easy"), with_demands(FREE_PLAY, "hard")
    assert (easy.duration_ms, easy.sight_radius) == (300_000, 7)
    assert (hard.duration_ms, hard.sight_radius) == (210_000, 4)
    for demanding in (easy, hard):
        usual = replace(
            demanding, duration_ms=FREE_PLAY.duration_ms, sight_radius=FREE_PLAY.sight_radius
        )
        assert usual == FREE_PLAY


def test_what_is_unusual_is_said_in_a_few_words() -> None:
    assert Variant("seeded", "hard").of_seed(7) == "victims of seed 7, hard"
