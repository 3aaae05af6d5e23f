"""Grids of 0, 1 and 2: with a legend beside them, furnished from a seed, and whole offices."""

from collections import Counter
from pathlib import Path

import pytest

from game.errors import AnaError
from game.world import load_building
from game.world.building import Building, Severity
from game.world.drawing import BuildingError
from game.world.furnishing import REDS, VICTIMS
from game.world.geometry import Heading
from game.world.reading import parse_building
from game.world.regions import reachable

REFERENCE = Path(__file__).resolve().parents[1] / "reference"

GRID = """\
1,1,1,1,1,1,1,1,1
1,0,0,1,0,0,0,0,1
1,0,0,2,0,1,1,1,1
1,0,0,1,0,2,0,0,1
1,1,1,1,0,1,0,0,1
1,0,0,2,0,1,0,0,1
1,0,0,1,0,1,1,1,1
1,0,0,1,0,0,0,0,1
1,1,1,1,1,1,1,1,1
"""
LEGEND = """\
; what was where in the study of 2021
name: Old House
start at 4,1 facing south
room Copy Room at 1,2
room Attic at 6,4
red victim at 2,1
blue victim at 7,5
"""


@pytest.fixture
def grid(tmp_path: Path) -> Path:
    path = tmp_path / "old.csv"
    path.write_text(GRID)
    return path


class TestLegend:
    @pytest.mark.parametrize("suffix", [".legend.txt", ".legend"])
    def test_places_what_it_says(self, grid: Path, suffix: str) -> None:
        grid.with_name("old" + suffix).write_text(LEGEND)
        building = load_building(grid)
        assert building.name == "Old House"
        assert (building.start, building.start_heading) == ((4, 1), Heading.SOUTH)
        assert [room.name for room in building.rooms] == ["Copy Room", "Attic"]
        assert [(v.cell, v.severity) for v in building.victims] == [
            ((2, 1), Severity.RED),
            ((7, 5), Severity.BLUE),
        ]
        assert parse_building(building.text) == building

    @pytest.mark.parametrize(
        ("line", "message"),
        [
            ("room Attic at 3,1", "line 8, column 15: 3,1 is not a floor cell of the 9 x 9 grid"),
            ("red victim at 9,1", "line 8, column 15: 9,1 is not a floor cell of the 9 x 9 grid"),
            ("start at 4,1", "line 8, column 1: 'start at 4,1' is not a valid line"),
            ("blue victim at 1,2 facing east", "line 8, column 1: .* is not a valid line"),
            ("green victim at 1,2", "line 8, column 1: .* is not a valid line"),
            ("room copy room at 1,6", "line 8, column 1: .*'copy room' is already used on line 4"),
        ],
    )
    def test_faults_name_the_legend(self, grid: Path, line: str, message: str) -> None:
        grid.with_name("old.legend").write_text(LEGEND + line)
        with pytest.raises(BuildingError, match=r"old\.legend, " + message):
            load_building(grid)

    def test_faults_of_a_place_name_the_grid(self, grid: Path) -> None:
        grid.with_name("old.legend").write_text(LEGEND + "red victim at 6,7")
        message = r"old\.csv, line 8, column 7: the red victim is not in a named room"
        with pytest.raises(BuildingError, match=message):
            load_building(grid)

    @pytest.mark.parametrize(
        ("more", "message"),
        [
            (
                "blue victim at 2,1",
                "line 2, column 3: the blue victim is on a cell",
            ),
            (
                "red victim at 1,1",
                "line 2, column 2: the red victim is on a cell",
            ),
            (
                "".join(f"blue victim at {x},{y}\n" for x in (6, 7) for y in (3, 4)),
                "line 5, column 7: 'Attic' has no free cell",
            ),
        ],
    )
    def test_one_thing_per_cell(self, grid: Path, more: str, message: str) -> None:
        attic = "blue victim at 6,5\n" if "6,3" in more else ""
        legend = LEGEND.replace("start at 4,1", "start at 1,1") + attic + more
        grid.with_name("old.legend").write_text(legend)
        with pytest.raises(BuildingError, match=r"old\.csv, " + message):
            load_building(grid)

    def test_a_legend_without_start(self, grid: Path) -> None:
        grid.with_name("old.legend").write_text("room Attic at 6,4")
        with pytest.raises(BuildingError, match=r"old\.legend, line 1, .* no start"):
            load_building(grid)


class TestGrid:
    @pytest.mark.parametrize(
        ("text", "message"),
        [
            (GRID.replace("1,0,0,2", "1,0,3,2", 1), "line 3, column 3: '3' is not a tile"),
            (GRID.replace("1,0,0,2,0,1,1,1,1", "1,0,0,2,0,1,1,1"), "line 3, column 9: .* 8 values"),
            (
                GRID.replace("1,0,0,2", "0,0,0,2", 1),
                "line 3, column 1: the west outer wall is open",
            ),
            ("", "line 1, column 1: the file is empty"),
            ("1,1,1\n1,0,1\n1,1,1", "line 1, column 1: the grid has no room"),
            ("1,1,1\n1,1,1\n1,1,1", "line 1, column 1: the grid has no room"),
        ],
    )
    def test_faults(self, grid: Path, text: str, message: str) -> None:
        grid.write_text(text)
        with pytest.raises(BuildingError, match=r"old\.csv, " + message):
            load_building(grid)

    def test_a_missing_file(self, tmp_path: Path) -> None:
        with pytest.raises(AnaError, match="cannot be read"):
            load_building(tmp_path / "none.csv")


class TestFurnishing:
    def test_seed_decides(self, grid: Path) -> None:
        assert load_building(grid, seed=4) == load_building(grid, seed=4)
        texts = {load_building(grid, seed=seed).text for seed in range(10)}
        assert len(texts) == 10

    def test_start_is_in_the_space_with_most_doors(self, grid: Path) -> None:
        hallway = {(4, y) for y in range(1, 8)} | {(x, y) for x in (5, 6, 7) for y in (1, 7)}
        for seed in range(20):
            building = load_building(grid, seed=seed)
            assert building.start in hallway
            assert len(building.rooms) == 3

    def test_no_more_victims_than_there_is_space_for(self, grid: Path) -> None:
        """18 room cells, of which each of three rooms keeps its label cell free."""
        victims = load_building(grid).victims
        assert len(victims) == 15
        assert len({victim.cell for victim in victims}) == 15


@pytest.mark.parametrize(("name", "size"), [("annexe", (75, 45)), ("terraces", (87, 47))])
@pytest.mark.parametrize("seed", [0, 1])
def test_whole_grids_import(name: str, size: tuple[int, int], seed: int) -> None:
    building = load_building(REFERENCE / f"{name}.csv", seed)
    assert (building.plan.width, building.plan.height) == size
    assert len(building.rooms) >= 20
    assert len(building.victims) == VICTIMS
    assert sum(victim.severity is Severity.RED for victim in building.victims) == REDS
    assert building.room_at(building.start) is None
    assert_playable(building)


def assert_playable(building: Building) -> None:
    reached = reachable(building.plan, building.start)
    rooms = Counter(building.room_of(victim) for victim in building.victims)
    assert None not in rooms
    assert max(rooms.values()) <= 2
    assert all(victim.cell in reached for victim in building.victims)
    assert all(room.cells[0] in reached and room.doors for room in building.rooms)
    assert parse_building(building.text) == building
