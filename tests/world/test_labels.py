"""Room names on the map: inside the room, complete, in as few lines as possible."""

from hypothesis import given
from hypothesis import strategies as st

from game.world.geometry import Cell
from game.world.labels import (
    FILLER,
    HALF_BLOCKS,
    SQUARES,
    LabelLine,
    MapScale,
    label_lines,
    spread,
)


def block(left: int, top: int, width: int, height: int) -> tuple[Cell, ...]:
    return tuple((x, y) for y in range(top, top + height) for x in range(left, left + width))


def test_one_line_in_the_middle() -> None:
    assert label_lines("Mail", block(2, 2, 8, 6)) == (LabelLine(4, 2, "Mail"),)


def test_broken_between_words_where_the_room_is_narrow() -> None:
    assert label_lines("Mail Room", block(2, 2, 6, 6)) == (
        LabelLine(3, 1, "Mail"),
        LabelLine(3, 2, "Room"),
    )


def test_a_map_row_needs_both_its_cells() -> None:
    assert label_lines("Mail", block(2, 2, 4, 2)) == (LabelLine(2, 1, "Mail"),)
    assert label_lines("Mail", block(2, 3, 4, 2)) == ()
    assert label_lines("Mail", block(2, 3, 4, 1), SQUARES) == (LabelLine(6, 3, "Mail"),)


def test_too_narrow_or_too_low() -> None:
    assert label_lines("Mail", block(2, 2, 3, 9)) == ()
    assert label_lines("Mail Room", block(2, 2, 8, 2)) == ()


def test_furniture_is_not_written_over() -> None:
    room = tuple(cell for cell in block(2, 2, 9, 4) if cell != (6, 4))
    assert label_lines("Mail", room) == (LabelLine(4, 1, "Mail"),)


@given(
    st.lists(st.text("abc", min_size=1, max_size=6), min_size=1, max_size=3),
    st.sets(st.tuples(st.integers(0, 12), st.integers(0, 8)), min_size=1),
    st.sampled_from([HALF_BLOCKS, SQUARES]),
)
def test_every_letter_stands_on_the_room(
    words: list[str], cells: set[Cell], scale: MapScale
) -> None:
    lines = label_lines(" ".join(words), sorted(cells), scale)
    if lines:
        assert " ".join(line.text for line in lines) == " ".join(words)
        assert [line.row for line in lines] == list(range(lines[0].row, lines[0].row + len(lines)))
    for line in lines:
        for column in range(line.column, line.column + len(line.text)):
            for below in range(scale.cells):
                assert (column // scale.columns, line.row * scale.cells + below) in cells


@given(st.text("a図ー室é", min_size=1, max_size=5), st.integers(1, 14))
def test_a_name_in_wide_characters_takes_two_columns_for_each(name: str, columns: int) -> None:
    lines = label_lines(name, block(2, 2, columns, 4))
    wide = sum(letter in "図ー室" for letter in name)
    assert bool(lines) == (len(name) + wide <= columns)
    for line in lines:
        assert line.text == spread(name)
        drawn = dict(line.letters)
        assert "".join(drawn.values()) == name
        assert all(drawn[at] == "" for at, it in enumerate(line.text, line.column) if it == FILLER)
        assert {*drawn} == {*range(line.column, line.column + len(name) + wide)}
