"""Tables of any separator, encoding and program: read where it is certain, refused by name else."""

import csv
import io
from collections.abc import Callable
from pathlib import Path

import pandas as pd
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from analysis.sources.absent import SourceError
from analysis.sources.factors import ADAPTIVITY
from analysis.sources.frames import StudyData
from analysis.sources.longcsv import MEASURED, read_long_csv
from analysis.sources.texttable import SEPARATORS, read_table

MakeTable = Callable[..., pd.DataFrame]
#: The folder is empty for each example, because each writes the same file again.
fresh = settings(suppress_health_check=[HealthCheck.function_scoped_fixture], deadline=None)


def complaint(path: Path, data: bytes | str) -> str:
    path.write_bytes(data.encode() if isinstance(data, str) else data)
    with pytest.raises(SourceError) as caught:
        read_table(path)
    return str(caught.value)


@pytest.fixture
def table(make_table: MakeTable) -> pd.DataFrame:
    return make_table().drop(columns=["disobeyed"])


@pytest.fixture
def plain(table: pd.DataFrame, tmp_path: Path) -> StudyData:
    path = tmp_path / "plain.csv"
    table.to_csv(path, index=False)
    return read_long_csv(path)


def same(one: StudyData, other: StudyData) -> None:
    pd.testing.assert_frame_equal(one.participants, other.participants, check_like=True)
    pd.testing.assert_frame_equal(one.rounds, other.rounds, check_like=True)


cells = st.text(st.characters(exclude_categories=["Cs", "Cc"]) | st.sampled_from(',;\t|"\n'))


@fresh
@given(
    rows=st.lists(st.lists(cells, min_size=2, max_size=2), min_size=1, max_size=6),
    separator=st.sampled_from(list(SEPARATORS)),
    encoding=st.sampled_from(["utf-8", "utf-8-sig", "utf-16"]),
    ending=st.sampled_from(["\n", "\r\n"]),
    stated=st.booleans(),
)
def test_what_a_writer_of_csv_writes_is_read_back(
    tmp_path: Path,
    rows: list[list[str]],
    separator: str,
    encoding: str,
    ending: str,
    stated: bool,
) -> None:
    out = io.StringIO(newline="")
    if stated:
        out.write(f"sep={separator}{ending}")
    writer = csv.writer(out, delimiter=separator, lineterminator=ending, quoting=csv.QUOTE_ALL)
    writer.writerow(["participant", "one", "two"])
    lines = []
    for at, row in enumerate(rows):
        lines.append(io.StringIO(out.getvalue(), newline="").read().count("\n") + 1)
        writer.writerow([f"P{at}", *row])
    path = tmp_path / "table.csv"
    path.write_bytes(out.getvalue().encode(encoding))
    read = read_table(path)
    assert read.cells[["one", "two"]].to_numpy().tolist() == [[c.strip() for c in r] for r in rows]
    assert read.cells.index.tolist() == lines


@fresh
@given(at=st.integers(0, 7), fields=st.integers(0, 9).filter(lambda count: count != 4))
def test_a_row_of_another_width_is_named(tmp_path: Path, at: int, fields: int) -> None:
    rows = [["P1", "a", "b", "c"]] * 8
    rows[at] = ["x"] * fields
    text = "\n".join(map(",".join, [["participant", "q", "r", "s"], *rows])) + "\n"
    path = tmp_path / "table.csv"
    if fields == 0:
        path.write_text(text)
        assert len(read_table(path).cells) == 7
        return
    words = complaint(path, text)
    count = "1 field" if fields == 1 else f"{fields} fields"
    assert f"line {at + 2} has {count}, the header has 4" in words


def test_the_line_is_the_files_after_fields_over_several_lines(tmp_path: Path) -> None:
    path = tmp_path / "t.csv"
    text = 'participant,note,n\nP1,"one\ntwo\r\nthree",1\n\nP2,x,many\n'
    path.write_bytes(text.encode())
    read = read_table(path)
    assert read.cells.index.tolist() == [2, 6]
    with pytest.raises(SourceError, match="line 6: n is 'many'"):
        read.numbers("n", ["n"])


def test_names_of_rows_without_a_header_are_explained(tmp_path: Path) -> None:
    text = "participant,q\n1,P1,3\n2,P2,4\n"
    assert "row.names = FALSE" in complaint(tmp_path / "t.csv", text)
    (tmp_path / "t.csv").write_text('"","participant","q"\n"1","P1",3\n')
    assert read_table(tmp_path / "t.csv").cells.columns[0] == "column 1 (no name)"


def test_empty_columns_at_the_end_are_nothing(tmp_path: Path) -> None:
    (tmp_path / "t.csv").write_text("participant;q;;\nP1;3;;\n;;;\nP2;4;;\n")
    assert read_table(tmp_path / "t.csv").cells.shape == (2, 2)


@pytest.mark.parametrize(
    "header", ["participant,q,q", "participant,q , q", "participant,participant,q"]
)
def test_columns_of_one_name_are_refused(tmp_path: Path, header: str) -> None:
    words = complaint(tmp_path / "t.csv", f"{header}\nP1,1,2\n")
    assert "line 1: 2 columns are called" in words and "fields" in words


def test_an_unclosed_quotation_mark_is_named(tmp_path: Path) -> None:
    words = complaint(tmp_path / "t.csv", 'participant,q\nP1,2\nP2,"3\nP3,4\n')
    assert "begins on line 3" in words and "quotation mark" in words


@pytest.mark.parametrize(
    ("data", "words"),
    [
        ("participant,q\nP1,1\nJörg,2\n".encode("latin-1"), "line 3: byte 0xf6 is not UTF-8"),
        (b"participant,q\nP1,\0\n", "line 2: a NUL"),
        (b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1", ".xls workbook"),
        (b"$FL2@(#) SPSS", "SPSS"),
        (b"PK\x03\x04 broken", "damaged"),
        (b"\x1f\x8b broken", "damaged"),
        (b"PAR1 broken", "parquet"),
        (b"name q\nP1 1\n", "separated by commas, semicolons, tabs, bars"),
        (b"", "empty"),
        (b"sep=;\n", "empty"),
        (b"participant,q\n", "no rows"),
        (b"participant,q\n,1\n", "line 2: the participant is not named"),
    ],
)
def test_what_cannot_be_read_says_why(tmp_path: Path, data: bytes, words: str) -> None:
    assert words in complaint(tmp_path / "t.csv", data)


@pytest.mark.parametrize(
    "cell", ["1_0", "0x10", "1e400", "１２", "1 0", "1,0", "+-1", "1.0.0", "true"]
)
def test_only_a_number_is_a_number(tmp_path: Path, cell: str) -> None:
    (tmp_path / "t.csv").write_text(f'participant,q\nP1,"{cell}"\n', encoding="utf-8")
    with pytest.raises(SourceError, match="line 2: q is"):
        read_table(tmp_path / "t.csv").numbers("q", ["q"])


def test_a_decimal_comma_goes_with_semicolons(tmp_path: Path) -> None:
    path = tmp_path / "t.csv"
    path.write_text("participant;q;r\nP1;0,5;3\nP2;1,25;-,5\n")
    read = read_table(path)
    assert read.numbers("q", ["q", "r"]).tolist() == [0.5, 1.25]
    assert read.numbers("r", ["q", "r"]).tolist() == [3, -0.5]
    path.write_text("participant;q;r\nP1;0,5;3\nP2;1;2.5\n")
    with pytest.raises(SourceError, match="lines 2, 3: one number has a decimal comma"):
        read_table(path).numbers("q", ["q", "r"])


def test_a_file_that_may_be_cut_off_is_noted(tmp_path: Path) -> None:
    path = tmp_path / "t.csv"
    path.write_text("participant,q\nP1,12")
    assert "line break" in read_table(path).notes[0]
    path.write_text("participant,q\nP1,12\n")
    assert read_table(path).notes == ()


@pytest.mark.parametrize("separator", list(SEPARATORS))
@pytest.mark.parametrize("encoding", ["utf-8-sig", "utf-16", "utf-16-le", "utf-16-be"])
def test_a_study_is_the_same_in_any_text(
    plain: StudyData, table: pd.DataFrame, tmp_path: Path, separator: str, encoding: str
) -> None:
    path = tmp_path / "other.csv"
    path.write_bytes(table.to_csv(index=False, sep=separator).encode(encoding))
    same(read_long_csv(path), plain)


def test_a_compressed_study_is_read(plain: StudyData, table: pd.DataFrame, tmp_path: Path) -> None:
    table.to_csv(tmp_path / "other.csv.gz", index=False)
    same(read_long_csv(tmp_path / "other.csv.gz"), plain)


def test_a_workbook_is_read(plain: StudyData, table: pd.DataFrame, tmp_path: Path) -> None:
    path = tmp_path / "other.xlsx"
    with pd.ExcelWriter(path) as writer:
        table.to_excel(writer, sheet_name="data", index=False)
        pd.DataFrame({"about": ["made up"]}).to_excel(writer, sheet_name="notes", index=False)
    study = read_long_csv(path)
    same(study, plain)
    assert "sheets not used: notes" in study.notes


def test_a_workbook_names_its_rows(table: pd.DataFrame, tmp_path: Path) -> None:
    path = tmp_path / "other.xlsx"
    table = table.astype({"victims": object})
    table.loc[3, "victims"] = "many"
    table.to_excel(path, index=False)
    with pytest.raises(SourceError, match="row 5: victims is 'many'"):
        read_long_csv(path)
    with pd.ExcelWriter(path) as writer:
        table.to_excel(writer, sheet_name="one", index=False)
        table.to_excel(writer, sheet_name="two", index=False)
    with pytest.raises(SourceError, match="2 of its sheets"):
        read_long_csv(path)


def test_a_formula_never_computed_is_no_missing_answer(table: pd.DataFrame, tmp_path: Path) -> None:
    path = tmp_path / "other.xlsx"
    table = table.astype({"victims": object})
    table.loc[0, "victims"] = "=6+6"
    table.to_excel(path, index=False)
    with pytest.raises(SourceError, match="row 2: the formula =6"):
        read_long_csv(path)


def widened(table: pd.DataFrame) -> pd.DataFrame:
    within = [*MEASURED, "building"]
    wide = table.pivot(index="participant", columns="adaptivity", values=within)
    wide.columns = pd.Index(["_".join(pair) for pair in wide.columns.to_flat_index()])
    people = table.drop(columns=[*within, "adaptivity"]).drop_duplicates("participant")
    return people.merge(wide.reset_index(), on="participant")


def test_a_row_a_participant_is_read(plain: StudyData, table: pd.DataFrame, tmp_path: Path) -> None:
    path = tmp_path / "wide.csv"
    widened(table).to_csv(path, index=False)
    same(read_long_csv(path), plain)


@pytest.mark.parametrize("adaptivity", ADAPTIVITY)
def test_a_wide_table_needs_both_rounds(
    table: pd.DataFrame, tmp_path: Path, adaptivity: str
) -> None:
    path = tmp_path / "wide.csv"
    wide = widened(table)
    wide.drop(columns=f"confusion_{adaptivity}").to_csv(path, index=False)
    with pytest.raises(SourceError, match=f"no column 'confusion_{adaptivity}'"):
        read_long_csv(path)
    pd.concat([wide, wide.tail(1)]).to_csv(path, index=False)
    with pytest.raises(SourceError, match="has a row already"):
        read_long_csv(path)


def test_a_misspelt_column_is_guessed(table: pd.DataFrame, tmp_path: Path) -> None:
    path = tmp_path / "t.csv"
    table.rename(columns={"engagement": "Engagement"}).to_csv(path, index=False)
    with pytest.raises(SourceError, match="Did you mean Engagement"):
        read_long_csv(path)
