"""Cells drawn large, where a window has much room."""

from __future__ import annotations

import pytest

from game.screens.play.mission_screen import MissionScreen
from game.screens.widgets.camera import Camera
from game.screens.widgets.canvas import plain, width
from game.screens.widgets.glyphs import PLAIN, SOLID, GlyphSet, Kind
from game.screens.widgets.large_office import large_rows
from game.screens.widgets.office import Label, Line
from game.screens.widgets.officeview import cell_size
from tests.screens.pilots import Open, press, shown, until

CAMERA = Camera(len(Kind), 1, 0, 0)
LOOKALIKE = {Kind.DARK, Kind.DARK_WALL, Kind.DARK_DOOR}


@pytest.mark.parametrize("glyphs", [SOLID, PLAIN])
def test_every_kind_takes_four_columns_and_two_rows(glyphs: GlyphSet) -> None:
    for kind in Kind:
        rows = large_rows(Line(bytes([kind, kind]), None), CAMERA, glyphs)
        assert [width(row) for row in rows] == [8, 8]
        for row in rows:
            assert {style for _, style in row} == {glyphs[kind].style}
            assert row[0][0][:4] == row[0][0][4:], "two of a kind look alike"


def test_with_few_colours_every_kind_has_a_shape_of_its_own() -> None:
    walls = (Kind.WALL, Kind.DOOR, Kind.FLOOR, Kind.SEEN_WALL, Kind.SEEN_DOOR, Kind.SEEN_FLOOR)
    people = (Kind.RED, Kind.BLUE, Kind.RESCUED, Kind.EXPIRED)
    players = (Kind.PLAYER_NORTH, Kind.PLAYER_EAST, Kind.PLAYER_SOUTH, Kind.PLAYER_WEST)
    shapes = {
        tuple(plain(large_rows(Line(bytes([kind]), None), CAMERA, PLAIN)))
        for kind in (*walls, *people, *players)
    }
    assert len(shapes) == len(walls) + len(people) + len(players)


def test_a_name_stands_in_the_middle_of_where_it_was() -> None:
    line = Line(bytes([Kind.FLOOR] * 20), Label(10, "Archive"))
    upper, lower = plain(large_rows(line, Camera(20, 1, 0, 0), SOLID))
    start = upper.index("Archive")
    assert abs((start + 3.5) - 2 * (10 + 3.5)) <= 1 and not lower.strip()
    moved, _ = plain(large_rows(line, Camera(20, 1, 2, 0), SOLID))
    assert moved.index("Archive") == start - 8
    narrow, _ = plain(large_rows(line, Camera(20, 1, -3, 0), SOLID))
    assert narrow.index("Archive") == start + 12


def test_cells_are_large_only_where_there_is_room() -> None:
    assert cell_size("auto", 101, 56) == (4, 2) and cell_size("auto", 68, 36) == (2, 1)
    assert cell_size("large", 68, 36) == (4, 2) and cell_size("large", 52, 20) == (2, 1)
    assert cell_size("small", 400, 200) == (2, 1)


async def test_a_large_window_shows_large_cells_and_walking_keeps_them_right(
    open_app: Open,
) -> None:
    async with open_app(size=(200, 60), moves_per_second=100) as (_, pilot):
        mission = await until(pilot, MissionScreen)
        office = mission.view.office
        assert "◢██◣" in shown(mission)
        for key in ("left", "left", "left", "left", "right"):
            await press(pilot, key)
            kept = list(office.rows)
            office.notify_style_update()
            office.show(mission.live.observation())
            assert office.rows == kept, "what was drawn before is drawn alike"
