"""The buildings that come with the game, and the commands that show and check buildings."""

import re
from collections import Counter
from collections.abc import Callable
from contextlib import nullcontext
from itertools import pairwise
from pathlib import Path
from statistics import mean

import pytest

from game.cli import main
from game.errors import AnaError
from game.study.folder import new_study, open_study
from game.world import load_building
from game.world.building import Building, Severity
from game.world.fitness import shortcomings
from game.world.floodfill import Floodfills
from game.world.labels import HALF_BLOCKS, SQUARES
from game.world.library import shipped_buildings
from game.world.picture import Ink, joined, picture, small_picture
from game.world.reading import parse_building
from game.world.regions import reachable
from game.world.route import RoutePlanner
from game.world.settings import MissionSettings

MISSION_BUILDINGS = ("harbour", "foundry")


@pytest.mark.parametrize("name", MISSION_BUILDINGS)
class TestMissionBuilding:
    def test_is_of_the_published_size(self, name: str) -> None:
        building = load_building(name)
        assert (building.plan.width, building.plan.height) == (95, 52)

    def test_has_the_published_victims_all_in_rooms(self, name: str) -> None:
        building = load_building(name)
        severities = Counter(victim.severity for victim in building.victims)
        assert severities == {Severity.RED: 7, Severity.BLUE: 13}
        by_room = Counter(building.room_of(victim) for victim in building.victims)
        assert None not in by_room
        assert sum(count == 2 for count in by_room.values()) >= 3
        assert max(by_room.values()) == 2
        assert len(building.rooms) - len(by_room) >= 3

    def test_has_twenty_rooms_with_doors(self, name: str) -> None:
        building = load_building(name)
        assert len(building.rooms) == 20
        assert all(room.doors for room in building.rooms)

    def test_can_be_walked_everywhere(self, name: str) -> None:
        building = load_building(name)
        reached = building.plan.mask(reachable(building.plan, building.start))
        assert reached == building.plan.walkable_mask


@pytest.mark.parametrize("name", shipped_buildings())
def test_shipped_buildings_are_fit_for_a_study(name: str) -> None:
    assert shortcomings(load_building(name), name, top_line=1) == ()


def test_mission_buildings_share_no_room_name() -> None:
    first, second = map(load_building, MISSION_BUILDINGS)
    assert not {room.name for room in first.rooms} & {room.name for room in second.rooms}


def mean_distance(building: Building) -> float:
    floodfills = Floodfills(building.plan)
    return mean(floodfills.distance(building.start, room.label) for room in building.rooms)


def room_area(building: Building) -> int:
    return sum(len(room.cells) for room in building.rooms)


@pytest.mark.parametrize("measure", [mean_distance, room_area])
def test_mission_buildings_are_balanced(measure: Callable[[Building], float]) -> None:
    first, second = (measure(load_building(name)) for name in MISSION_BUILDINGS)
    assert abs(first - second) <= 0.1 * max(first, second)


def planned_rescues(name: str) -> Counter[Severity]:
    """The victims that a follower who loses no time rescues on the route planned at the start."""
    building = load_building(name)
    settings = MissionSettings()
    waiting = {victim.id: victim for victim in building.victims}
    planner = RoutePlanner(building.terrain.floodfills, settings, waiting)
    route = planner.plan(building.start, 0, waiting, ms_per_move=settings.pace_ms)
    severity = {victim.id: victim.severity for victim in building.victims}
    return Counter(severity[victim] for victim in route.order)


def test_a_perfect_follower_rescues_every_red_but_not_everyone() -> None:
    first, second = map(planned_rescues, MISSION_BUILDINGS)
    assert first[Severity.RED] == second[Severity.RED] == 7
    assert {first.total(), second.total()} <= {18, 19}


def test_practice_building_is_small_and_teaches_counting() -> None:
    building = load_building("practice")
    assert building.plan.width <= 41
    assert building.plan.height <= 20
    assert 6 <= len(building.rooms) <= 8
    assert {victim.severity for victim in building.victims} == set(Severity)
    for wall in (8, 11):
        on_this_side = [door for door in building.doors if door.cells[0][1] == wall]
        assert len(on_this_side) >= 3


def test_the_example_in_the_docs_is_valid() -> None:
    page = (Path(__file__).parents[2] / "docs" / "building-format.md").read_text()
    example = next(block for block in page.split("```") if "\nplan:\n" in block).lstrip()
    building = parse_building(example)
    assert [room.name for room in building.rooms] == ["Mail Room", "Lounge"]
    assert shortcomings(building, "example", top_line=1) == ()


class TestNames:
    def test_shipped(self) -> None:
        assert set(shipped_buildings()) == {*MISSION_BUILDINGS, "practice"}

    @pytest.mark.parametrize(
        ("wrong", "right"),
        [("harbor", "harbour"), ("Foundry", "foundry"), ("practise", "practice")],
    )
    def test_nearest_name_is_suggested(self, wrong: str, right: str) -> None:
        with pytest.raises(AnaError, match=f"no building '{wrong}'.*Did you mean {right}?"):
            load_building(wrong)

    def test_a_path(self, tmp_path: Path) -> None:
        path = tmp_path / "mine"
        path.write_text(load_building("practice").text)
        assert load_building(str(path)) == load_building("practice")

    def test_a_directory(self, tmp_path: Path) -> None:
        with pytest.raises(AnaError, match="cannot be read"):
            load_building(tmp_path)


class TestPicture:
    def test_squares_show_every_cell_and_name(self) -> None:
        building = load_building("practice")
        rows = ["".join(stroke.text for stroke in row) for row in picture(building, SQUARES)]
        assert len(rows) == building.plan.height
        assert {len(row) for row in rows} == {2 * building.plan.width}
        assert all(any(room.name in row for row in rows) for room in building.rooms)
        drawn = Counter("".join(rows))
        assert drawn["●"] + drawn["○"] == len(building.victims)
        assert drawn["▒"] == 2 * sum(len(door.cells) for door in building.doors)

    def test_half_blocks_show_two_cells_per_character(self) -> None:
        building = load_building("practice")
        rows = picture(building, HALF_BLOCKS)
        assert len(rows) == building.plan.height // 2
        assert {len(row) for row in rows} == {building.plan.width}
        wall_over_floor = rows[0][1]
        assert (wall_over_floor.text, wall_over_floor.ink, wall_over_floor.paper) == (
            "▀",
            Ink.WALL,
            Ink.FLOOR,
        )

    def test_four_cells_a_character_number_the_rooms(self) -> None:
        building = load_building("harbour")
        numbers = {room.name: number for number, room in enumerate(building.rooms, start=1)}
        rows = ["".join(stroke.text for stroke in row) for row in small_picture(building, numbers)]
        assert (len(rows[0]), len(rows)) == (48, 26)
        drawn = Counter("".join(rows))
        assert (drawn["●"], drawn["○"]) == (7, 13)
        assert Counter("".join(re.findall(r"\d", "".join(rows)))) == Counter(
            "".join(map(str, numbers.values()))
        )

    def test_joining_keeps_the_text(self) -> None:
        for row in picture(load_building("practice"), HALF_BLOCKS):
            runs = joined(row)
            assert "".join(run.text for run in runs) == "".join(stroke.text for stroke in row)
            assert all((a.ink, a.paper) != (b.ink, b.paper) for a, b in pairwise(runs))


class TestCommands:
    def test_show(self, capsys: pytest.CaptureFixture[str]) -> None:
        assert main(["building", "show", "practice"]) == 0
        out = capsys.readouterr().out
        assert "Practice Wing: 41 x 20 cells, 8 rooms, 8 doors, 6 victims (2 red)" in out
        assert "Tea Room                1 door, 1 blue" in out

    def test_show_unknown(self, capsys: pytest.CaptureFixture[str]) -> None:
        assert main(["building", "show", "foundy"]) == 2
        assert "Did you mean foundry?" in capsys.readouterr().err

    def test_check_without_problems(
        self, tmp_path: Path, capsys: pytest.CaptureFixture[str]
    ) -> None:
        path = tmp_path / "mine.txt"
        path.write_text(load_building("practice").text)
        assert main(["building", "check", str(path)]) == 0
        assert capsys.readouterr().out == (
            f"{path}: no problems (41 x 20 cells, 8 rooms, 8 doors, 6 victims (2 red))\n"
        )

    def test_check_lists_every_problem(
        self, tmp_path: Path, capsys: pytest.CaptureFixture[str]
    ) -> None:
        path = tmp_path / "mine.txt"
        text = load_building("practice").text
        path.write_text(text.replace("Clinic", "Studio").replace("######+", "#######", 1))
        assert main(["building", "check", str(path)]) == 2
        first, second = capsys.readouterr().out.splitlines()
        assert first.startswith(f"{path}, line 9, column 5: 'Tea Room' has no door. Draw")
        assert second.startswith(f"{path}, line 33, column 1: the room name 'Studio' is already")

    def test_check_refuses_a_name_that_does_not_fit(
        self, tmp_path: Path, capsys: pytest.CaptureFixture[str]
    ) -> None:
        path = tmp_path / "mine.txt"
        path.write_text(load_building("practice").text.replace("Clinic", "Polyclinic"))
        load_building(path)
        assert main(["building", "check", str(path)]) == 2
        assert "'Polyclinic' does not fit its room" in capsys.readouterr().out


@pytest.mark.parametrize(("width", "fits"), [(98, True), (99, False), (110, False), (121, False)])
def test_check_and_a_study_agree_on_what_fits_the_screen(
    tmp_path: Path, width: int, fits: bool
) -> None:
    text = f"""name: Hall

plan:
{"#" * width}
#........#{"." * (width - 11)}#
#.A......#{"." * (width - 11)}#
#........#{"." * (width - 11)}#
#.o......+>{"." * (width - 12)}#
{"#" * width}

legend:
> = start facing east
o = blue victim
A = room Annex
"""
    path = tmp_path / "hall.txt"
    path.write_text(text)
    assert (main(["building", "check", str(path)]) == 0) is fits
    folder = tmp_path / "study"
    new_study(folder, seed=1, blocks=1)
    settings = (folder / "study.toml").read_text().replace('"foundry"', f'"{path}"')
    (folder / "study.toml").write_text(settings)
    with nullcontext() if fits else pytest.raises(AnaError, match="more than the map"):
        open_study(folder)
