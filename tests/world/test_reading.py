"""The building format: what it means, what it rejects, and that writing inverts reading."""

from itertools import accumulate

import pytest
from hypothesis import given
from hypothesis import strategies as st

from game.world.building import Building, Severity
from game.world.drawing import BuildingError, Problem
from game.world.geometry import Heading
from game.world.plan import Tile
from game.world.reading import decode, inspect_text, parse_building
from game.world.writing import render_building

SMALL = """\
; two rooms on a hallway
name: Small House

plan:
############
#A..#.....##
#.*.+.>...##
##+##..##+##
#...#..#o.o#
#...+..#.BB#
############

legend:
> = start facing west
A = room Mail Room
; the other one
B = room Tea & Coffee
* = red victim
o = blue victim
"""


def problem_in(text: str) -> Problem:
    """The only problem that reading `text` finds."""
    building, problems = inspect_text(text, "small.txt")
    assert building is None
    assert len(problems) == 1, problems
    return problems[0]


def changed(*changes: tuple[str, str]) -> str:
    """The small house with each first text, which must be there, replaced by the second."""
    text = SMALL
    for before, after in changes:
        assert before in text
        text = text.replace(before, after, 1)
    return text


class TestMeaning:
    building = parse_building(SMALL)

    def test_header_and_plan(self) -> None:
        assert self.building.name == "Small House"
        assert (self.building.plan.width, self.building.plan.height) == (12, 7)
        assert self.building.plan.tile((4, 2)) is Tile.DOOR
        assert self.building.plan.tile((1, 1)) is Tile.FLOOR
        assert self.building.text == SMALL

    def test_start(self) -> None:
        assert self.building.start == (6, 2)
        assert self.building.start_heading is Heading.WEST

    def test_rooms_are_the_spaces_closed_by_walls_and_doors(self) -> None:
        mail, tea = self.building.rooms
        assert mail.name == "Mail Room"
        assert mail.cells == ((1, 1), (2, 1), (3, 1), (1, 2), (2, 2), (3, 2))
        assert mail.label == (2, 1)
        assert tea.name == "Tea & Coffee"
        assert tea.label == (9, 4)
        assert self.building.room_at((2, 4)) is None

    def test_doors_of_a_room(self) -> None:
        mail, tea = self.building.rooms
        cells = [self.building.doors[door].cells for door in mail.doors]
        assert cells == [((4, 2),), ((2, 3),)]
        assert [self.building.doors[door].cells for door in tea.doors] == [((9, 3),)]

    def test_victims_are_numbered_row_by_row(self) -> None:
        assert [(v.id, v.cell, v.severity) for v in self.building.victims] == [
            ("v01", (2, 2), Severity.RED),
            ("v02", (8, 4), Severity.BLUE),
            ("v03", (10, 4), Severity.BLUE),
        ]

    def test_door_cells_side_by_side_are_one_door(self) -> None:
        text = changed(("#...#..#o.o#", "#...+..#o.o#"))
        doors = parse_building(text).doors
        assert ((4, 4), (4, 5)) in [door.cells for door in doors]
        assert len(doors) == 4

    @pytest.mark.parametrize(
        "text",
        [
            SMALL.replace("\n", "\r\n"),
            SMALL.replace("\n", "   \n"),
            SMALL.rstrip("\n"),
            changed(("############\n\nlegend", "############\n\n\n\nlegend")),
            changed(("plan:\n", "plan:\n\n")),
            changed(("A = room", "A=room")),
        ],
    )
    def test_spaces_at_line_ends_and_line_endings_are_ignored(self, text: str) -> None:
        again = parse_building(text)
        assert (again.plan, again.rooms, again.victims, again.start) == (
            self.building.plan,
            self.building.rooms,
            self.building.victims,
            self.building.start,
        )


class TestRefusals:
    """Each single fault gives a single problem, at its own line and column."""

    @pytest.mark.parametrize(
        ("text", "line", "column", "message"),
        [
            (changed(("#...+..#.BB#", "#.x.+..#.BB#")), 10, 3, "'x' is not in the legend"),
            (changed(("#...+..#.BB#", "#.\t.+..#.BB#")), 10, 3, "a tab inside the plan"),
            (changed(("#...+..#.BB#", "#. .+..#.BB#")), 10, 3, "a blank inside the plan"),
            (
                changed(("#...+..#.BB#", "#...+..#.B")),
                10,
                11,
                "row 6 of the plan is 2 cells too short",
            ),
            (
                changed(("#...+..#.BB#", "#...+..#.BB##")),
                10,
                13,
                "row 6 of the plan is 1 cell too long",
            ),
            (changed(("#...+..#.BB#", "#...+..#.BB.")), 10, 12, "the east outer wall is open"),
            (
                changed(("############", "##..########")),
                5,
                3,
                "the north outer wall is open in 2 cells",
            ),
            (changed((">", "."), ("> = start facing west\n", "")), 13, 1, "has no start"),
            (changed(("#...+..#.BB#", "#...+.>#.BB#")), 10, 7, "more than one start"),
            (changed(("##+##..##+##", "##+##..#####")), 10, 10, "'Tea & Coffee' has no door"),
            (
                changed(("Tea & Coffee", "mail room")),
                17,
                1,
                "'mail room' is already used on line 15",
            ),
            (changed(("#...#..#o.o#", "#...#..#oAo#")), 9, 10, "'Mail Room' is in two"),
            (
                changed(("A..#", "AC.#"), ("; the other one", "C = room Den")),
                6,
                3,
                "in the same enclosed",
            ),
            (
                changed(("A = room Mail Room\n", "A = room Mail Room\nC = room Den\n")),
                16,
                1,
                "'C' is not in the plan",
            ),
            (
                changed(("#...+..#.BB#", "#...+.o#.BB#")),
                10,
                7,
                "the blue victim is not in a named room",
            ),
            (
                changed(("Tea & Coffee", "Tea. Coffee")),
                17,
                1,
                "'Tea. Coffee' is not a valid room name",
            ),
            (
                changed(("B = room Tea & Coffee", "B room Tea")),
                17,
                1,
                "'B room Tea' is not a legend line",
            ),
            (
                changed(("room Tea & Coffee", "roum Tea")),
                17,
                5,
                "'roum Tea' is not a valid meaning",
            ),
            (
                changed(("facing west", "facing up")),
                14,
                5,
                "'start facing up' is not a valid meaning",
            ),
            (
                changed(("; the other one", "A = room Den")),
                16,
                1,
                "'A' already has a meaning on line 15",
            ),
            (changed(("; the other one", "# = room Den")), 16, 1, "'#' always means a tile"),
            (changed(("name: Small House\n", "")), 1, 1, "the building has no name"),
            (changed(("name: Small House\n", "name:\n")), 2, 6, "the name is empty"),
            (changed(("\n\nplan:", "\nname: Other\n\nplan:")), 3, 1, "a second name"),
            (changed(("; two", "two")), 1, 1, "'two rooms on a hallway' is not a header line"),
            ("", 1, 1, "the file is empty"),
            ("\n  \n", 1, 1, "the file is empty"),
            ("name: A\n", 2, 1, "there is no plan"),
            ("name: A\nplan:\n###\n#.#\n###", 5, 1, "there is no legend"),
            ("name: A\nplan:\n\nlegend:\n", 4, 1, "the plan is empty"),
        ],
    )
    def test_fault(self, text: str, line: int, column: int, message: str) -> None:
        problem = problem_in(text)
        assert message in problem.message
        assert (problem.line, problem.column) == (line, column)
        assert problem.hint[0].isupper()

    def test_unreachable_rooms_and_victims(self) -> None:
        """Behind a door that leads nowhere, a room; in an unnamed cell, a victim."""
        plan = SMALL.splitlines()
        plan[8:11] = ["#...#..#o..##", "#...+..#.BB+#", "#############"]
        plan[4:8] = ["#############", "#A..#.....###", "#.*.+.>...###", "##+##..######"]
        plan.insert(11, "#o###########")
        plan.insert(12, "#############")
        _, problems = inspect_text("\n".join(plan), "small.txt")
        assert [(problem.line, problem.column, problem.message) for problem in problems] == [
            (10, 10, "'Tea & Coffee' cannot be reached from the start"),
            (12, 2, "the blue victim cannot be reached from the start"),
        ]

    def test_all_problems_are_listed_in_file_order(self) -> None:
        text = changed(("Tea & Coffee", "mail room"), ("############", "#.##########"), (">", "o"))
        building, problems = inspect_text(text, "small.txt")
        assert building is None
        assert [problem.line for problem in problems] == [14]
        fixed = text.replace("> = start facing west\n", "")
        _, problems = inspect_text(fixed, "small.txt")
        assert [problem.line for problem in problems] == [5, 7, 13, 16]

    def test_the_error_tells_place_fault_hint_and_how_many_more(self) -> None:
        text = changed(
            ("############", "#.##########"), (">", "o"), ("> = start facing west\n", "")
        )
        with pytest.raises(BuildingError) as caught:
            parse_building(text, "small.txt")
        assert str(caught.value) == (
            "small.txt, line 5, column 2: the north outer wall is open (and 2 more problems). "
            "Draw wall all around the plan"
        )
        assert len(caught.value.problems) == 3

    def test_text_that_is_not_utf8(self) -> None:
        with pytest.raises(BuildingError, match=r"small.txt, line 2, column 10: .*not UTF-8"):
            decode(
                "; ä\nname: Caf\xe9\n".encode("latin-1").replace(b"\xe4", b"a")[:-1], "small.txt"
            )

    def test_columns_before_bad_bytes_count_characters(self) -> None:
        with pytest.raises(BuildingError, match="line 1, column 5"):
            decode(b"name\xff", "small.txt")
        with pytest.raises(BuildingError, match="line 1, column 3"):
            decode("äö".encode() + b"\xff", "small.txt")

    def test_a_byte_order_mark_is_allowed(self) -> None:
        assert decode(SMALL.encode("utf-8-sig"), "small.txt") == SMALL


@st.composite
def drawn_buildings(draw: st.DrawFn) -> str:
    """A hallway with rooms of random widths above and below it, each behind one door."""
    width_of_row = 26
    depth = draw(st.integers(2, 4))
    names = iter(
        draw(st.permutations(["Den", "Lab 2", "Bar", "Cafe É", "Gym", "Spa", "Pub", "Inn"]))
    )
    rows = {}
    legend = []
    glyphs = iter("ABCDEFGH")
    for side in ("above", "below"):
        widths = draw(st.lists(st.integers(4, 7), min_size=1, max_size=3))
        ends = list(accumulate(width + 1 for width in widths))
        grid = [["#"] * width_of_row for _ in range(depth)]
        door_row = ["#"] * width_of_row
        for width, end in zip(widths, ends, strict=True):
            inside = [(x, y) for y in range(depth) for x in range(end - width, end)]
            for x, y in inside:
                grid[y][x] = "."
            bearing, *victims = draw(
                st.lists(st.sampled_from(inside), min_size=1, max_size=4, unique=True)
            )
            glyph = next(glyphs)
            legend.append(f"{glyph} = room {next(names)}")
            grid[bearing[1]][bearing[0]] = glyph
            for x, y in victims:
                grid[y][x] = draw(st.sampled_from("ro"))
            door_row[draw(st.integers(end - width, end - 1))] = "+"
        rows[side] = [*grid, door_row] if side == "above" else [door_row, *grid]
    hallway = list("#" + "." * (width_of_row - 2) + "#")
    hallway[draw(st.integers(1, width_of_row - 2))] = ">"
    outline = "#" * width_of_row
    plan = [
        outline,
        *map("".join, rows["above"]),
        "".join(hallway),
        *map("".join, rows["below"]),
        outline,
    ]
    legend.append(f"> = start facing {draw(st.sampled_from(Heading)).name.lower()}")
    legend += [f"{g} = {s} victim" for g, s in (("r", "red"), ("o", "blue")) if g in "".join(plan)]
    return "\n".join(["name: Drawn", "plan:", *plan, "legend:", *draw(st.permutations(legend))])


def all_but_text(building: Building) -> tuple[object, ...]:
    return (
        building.name,
        building.plan,
        building.rooms,
        building.doors,
        building.victims,
        building.start,
        building.start_heading,
    )


@given(drawn_buildings())
def test_reading_what_was_written_gives_the_same_building(text: str) -> None:
    building = parse_building(text)
    written = render_building(building)
    again = parse_building(written)
    assert all_but_text(again) == all_but_text(building)
    assert again.text == written
    assert render_building(again) == written


@given(drawn_buildings(), st.data())
def test_a_text_with_one_character_changed_is_read_or_refused_in_place(
    text: str, data: st.DataObject
) -> None:
    at = data.draw(st.integers(0, len(text) - 1))
    mangled = text[:at] + data.draw(st.characters(codec="utf-8")) + text[at + 1 :]
    building, problems = inspect_text(mangled)
    assert (building is None) == bool(problems)
    lines = mangled.count("\n") + 1
    assert all(1 <= problem.line <= lines and problem.column >= 1 for problem in problems)


def test_a_building_with_a_room_full_of_victims_cannot_be_written() -> None:
    building = parse_building(SMALL)
    room = building.rooms[0]
    crowd = tuple(
        type(building.victims[0])(f"v{i:02}", cell, Severity.RED)
        for i, cell in enumerate(room.cells)
    )
    crowded = Building(
        building.name,
        building.plan,
        building.rooms,
        building.doors,
        crowd,
        building.start,
        building.start_heading,
        "",
    )
    with pytest.raises(ValueError, match="Mail Room has no free cell"):
        render_building(crowded)
