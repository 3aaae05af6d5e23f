"""The 24 design cells and their balance."""

from __future__ import annotations

from collections import Counter

import pytest
from hypothesis import given
from hypothesis import strategies as st

from game.study.design import BLOCK, HALF_BLOCK, design_cell, half_block

seeds = st.integers(0, 2**32)


def allocation(seed: int, count: int, stream: str = "live") -> list[str]:
    return [design_cell(seed, stream, slot).code for slot in range(count)]


@given(seeds, st.integers(0, 5))
def test_every_block_has_every_design_cell_once(seed: int, block: int) -> None:
    codes = {design_cell(seed, "live", block * BLOCK + place).code for place in range(BLOCK)}
    assert len(codes) == BLOCK


@given(seeds)
def test_108_give_the_papers_counts(seed: int) -> None:
    cells = [design_cell(seed, "live", slot) for slot in range(108)]
    assert Counter(cell.adaptive_first for cell in cells) == {True: 54, False: 54}
    assert set(Counter(cell.static_level for cell in cells).values()) == {36}
    assert Counter(cell.first_building for cell in cells) == {0: 54, 1: 54}
    assert Counter(cell.long_memorise for cell in cells) == {True: 54, False: 54}


@pytest.mark.parametrize("complemented", [False, True])
def test_a_half_block_is_balanced_by_itself(complemented: bool) -> None:
    cells = half_block(complemented)
    assert len(set(cells)) == HALF_BLOCK
    pairs = Counter((cell.static_level, cell.first_building) for cell in cells)
    assert set(pairs.values()) == {2}


def test_seeds_and_streams_give_different_orders_and_the_same_ones_every_time() -> None:
    assert allocation(1, 48) == allocation(1, 48)
    assert allocation(1, 48) != allocation(2, 48)
    assert allocation(1, 48) != allocation(1, 48, "pilot")
    assert allocation(7, 3) == ["1-SA-C2-b1", "3-AS-C2-b1", "1-AS-C3-b1"]


@pytest.mark.parametrize("complemented", [False, True])
def test_a_round_is_in_each_building(complemented: bool) -> None:
    for cell in half_block(complemented):
        assert cell.buildings[0] == cell.first_building
        assert sorted(cell.buildings) == [0, 1]


def test_a_negative_slot_is_refused() -> None:
    with pytest.raises(ValueError, match="-1"):
        design_cell(1, "live", -1)
