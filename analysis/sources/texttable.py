"""Reads one table from a file, whatever program wrote it, as cells of text.

Text files may be UTF-8 or UTF-16 and separated by commas, semicolons, tabs or bars, workbooks
.xlsx, and columnar files .parquet. What is not certain is refused, never guessed: a row with more
or fewer fields than the header, two columns of one name, bytes that are in no known encoding.
"""

import csv
import gzip
import io
import re
from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal, TypeAlias
from zipfile import BadZipFile, ZipFile

import pandas as pd

from analysis.sources.absent import SourceError
from game.errors import did_you_mean

#: A separator and its name.
SEPARATORS = {",": "commas", ";": "semicolons", "\t": "tabs", "|": "bars"}
#: The column that every table has; the header is recognised by it.
KEY = "participant"
MISSING = frozenset({"", "na", "nan", "n/a", "null", "none", "."})

_SEP_LINE = re.compile(r'"?sep=(.)"?\s*', re.IGNORECASE)
_NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?", re.ASCII)
_WITH_COMMA = re.compile(r"[+-]?\d*,\d+", re.ASCII)
_LONGEST_FIELD = 10_000_000
_SAVE_AS = "Save it as 'CSV UTF-8' (in a spreadsheet: File, Save as), and give that file"
#: First bytes of files that are no table of text, what they are, and what to do.
_KINDS = (
    (b"\xd0\xcf\x11\xe0", "an old .xls workbook", "Save it as .xlsx or as 'CSV UTF-8'"),
    (b"$FL2", "an SPSS file", _SAVE_AS.replace("in a spreadsheet: File, Save as", "in SPSS")),
    (b"%PDF", "a PDF", "Give the table that it was made from"),
    (b"RDX", "an R file", "In R: write.csv(data, 'data.csv', row.names = FALSE)"),
)

Unit: TypeAlias = Literal["line", "row"]
Rows: TypeAlias = list[tuple[int, list[str]]]


def is_missing(cell: str) -> bool:
    """Whether a cell says that there is no answer."""
    return cell.lower() in MISSING


@dataclass(frozen=True)
class TextTable:
    """A table as stripped text. The index of `cells` is where in the file each row begins, counted
    from 1 in `unit`s: the lines of a text file, the rows of a workbook."""

    name: str
    cells: pd.DataFrame
    unit: Unit = "line"
    separator: str = ","
    notes: tuple[str, ...] = ()
    header_at: int = 1

    def at(self, *places: object) -> str:
        """The beginning of a complaint: file and place."""
        distinct = list(dict.fromkeys(places))
        return (
            f"{self.name}: {self.unit}{'s' * (len(distinct) > 1)} {', '.join(map(str, distinct))}"
        )

    def needs(self, columns: Sequence[str]) -> None:
        """Raise SourceError naming the columns that are not there."""
        there = list(self.cells.columns)
        missing = [column for column in columns if column not in there]
        if missing:
            spare = [name for name in there if name not in columns]
            near = {column: did_you_mean(column, spare) for column in missing}
            words = " ".join(f"{name!r}: {hint}" for name, hint in near.items() if hint)
            raise SourceError(
                f"{self.at(self.header_at)}: no column {', '.join(map(repr, missing))}; "
                f"the header must have {', '.join(columns)}" + (f". {words}" if words else "")
            )

    def numbers(self, column: str, among: Iterable[str]) -> pd.Series:
        """A column as numbers, NaN where there is no answer.

        `among` names all columns of numbers: in one file all have the same decimal mark. Raises
        SourceError, with the place, for a cell that is no number.
        """
        comma = self._decimal_comma(among)

        def number(place: object, cell: str) -> float:
            if is_missing(cell):
                return float("nan")
            text = cell.replace(",", ".") if comma and _WITH_COMMA.fullmatch(cell) else cell
            value = float(text) if _NUMBER.fullmatch(text) else float("inf")
            if value in (float("inf"), float("-inf")):
                raise SourceError(
                    f"{self.at(place)}: {column} is {cell!r}; it must be a number, or empty "
                    "where no answer was given"
                )
            return value

        values = [number(place, cell) for place, cell in self.cells[column].items()]
        return pd.Series(values, index=self.cells.index, dtype=float)

    def _decimal_comma(self, among: Iterable[str]) -> bool:
        """Whether numbers have a decimal comma, as only a file not separated by commas can."""
        if self.separator == ",":
            return False
        found: dict[str, tuple[object, str]] = {}
        for column in among:
            if column in self.cells.columns:
                for place, cell in self.cells[column].items():
                    if _WITH_COMMA.fullmatch(cell):
                        found.setdefault("comma", (place, cell))
                    elif "." in cell and _NUMBER.fullmatch(cell):
                        found.setdefault("point", (place, cell))
        if len(found) == 2:
            (one, with_comma), (other, with_point) = found["comma"], found["point"]
            raise SourceError(
                f"{self.at(one, other)}: one number has a decimal comma ({with_comma}), another a "
                f"point ({with_point}); use one of them in the whole file"
            )
        return "comma" in found


def read_table(path: Path, key: str = KEY) -> TextTable:
    """The table in a file; rows without anything in them are left out. `key` is the column that
    names the participant.

    Raises SourceError, naming the file, the place and the way out.
    """
    try:
        data = path.read_bytes()
    except FileNotFoundError as error:
        raise SourceError(f"{path}: there is no such file") from error
    except OSError as error:
        raise SourceError(f"{path}: the file cannot be read ({error.strerror})") from error
    if data.startswith(b"\x1f\x8b"):
        data = _unpacked(data, path)
    for magic, kind, hint in _KINDS:
        if data.startswith(magic):
            raise SourceError(f"this is {kind}, not a table of text", place=path.name, hint=hint)
    if data.startswith(b"PAR1"):
        return _columnar(data, path, key)
    if data.startswith(b"PK\x03\x04"):
        return _workbook(data, path, key)
    return _text(_decoded(data, path), path, key)


def _unpacked(data: bytes, path: Path) -> bytes:
    try:
        return gzip.decompress(data)
    except (OSError, EOFError) as error:
        raise SourceError(
            "the compressed file is damaged", place=path.name, hint="Copy or make it again"
        ) from error


def _decoded(data: bytes, path: Path) -> str:
    """The text of a file: UTF-8 or UTF-16, with or without a byte order mark."""
    if data.startswith((b"\xff\xfe", b"\xfe\xff")):
        encoding = "utf-16"
    elif len(data) > 3 and not any(data[1:200:2]):
        encoding = "utf-16-le"
    elif len(data) > 3 and not any(data[0:200:2]):
        encoding = "utf-16-be"
    else:
        encoding = "utf-8-sig"
    try:
        text = data.decode(encoding)
    except UnicodeDecodeError as error:
        line = data.count(b"\n", 0, error.start) + 1
        raise SourceError(
            f"line {line}: byte {data[error.start]:#04x} is not {encoding[:6].upper().rstrip('-')}"
            "; the file is in another encoding, or damaged",
            place=path.name,
            hint=_SAVE_AS,
        ) from error
    if "\0" in text:
        line = text.count("\n", 0, text.index("\0")) + 1
        raise SourceError(
            f"line {line}: a NUL character; this is no table, or it is damaged",
            place=path.name,
            hint=_SAVE_AS,
        )
    return text


def _text(text: str, path: Path, key: str) -> TextTable:
    first = re.match(r"[^\r\n]*", text)
    stated = _SEP_LINE.fullmatch(first.group() if first else "")
    if not text.strip() or (stated and not text[stated.end() :].strip()):
        raise SourceError(f"{path.name}: this is not a CSV table: the file is empty")
    separator = stated.group(1) if stated else _separator(text, path, key)
    rows = [(at, row) for at, row in _rows(text, separator, path) if any(map(str.strip, row))]
    if stated:
        rows = rows[1:]
    notes = () if text.endswith(("\n", "\r")) else (_UNENDED,)
    return _table(rows, path, key, "line", separator, notes)


_UNENDED = (
    "the file does not end with a line break; if it was cut off, its last number may be incomplete"
)


def _rows(text: str, separator: str, path: Path) -> Rows:
    """Each row with the line it begins on; a field in quotes may go over several lines."""
    csv.field_size_limit(_LONGEST_FIELD)
    reader = csv.reader(io.StringIO(text, newline=""), delimiter=separator, strict=True)
    rows: Rows = []
    line = 1
    try:
        for row in reader:
            rows.append((line, row))
            line = reader.line_num + 1
    except csv.Error as error:
        raise SourceError(
            f"the row that begins on line {line} cannot be read ({error})",
            place=path.name,
            hint="Look for a quotation mark that is not closed or not doubled",
        ) from error
    return rows


def _separator(text: str, path: Path, key: str) -> str:
    """The separator that makes a column `key` of the header."""
    header = next(line for line in text.splitlines() if line.strip())
    found = [
        separator
        for separator in SEPARATORS
        if key in (name.strip().strip('"').strip() for name in header.split(separator))
    ]
    if len(found) == 1:
        return found[0]
    if len(found) > 1 and header.strip().strip('"') == key:
        return ","
    raise SourceError(
        f"{path.name}: no column {key!r} in its header ({header.strip()[:60]!r}), whether it is "
        f"separated by {', '.join(SEPARATORS.values())}",
        hint="Name the columns in the first line, and separate them by commas",
    )


def _columnar(data: bytes, path: Path, key: str) -> TextTable:
    try:
        frame = pd.read_parquet(io.BytesIO(data))
    except ImportError as error:
        raise SourceError(
            "reading .parquet needs the package pyarrow, which is not installed",
            place=path.name,
            hint="Install it beside ana (pip install pyarrow), or save the table as CSV",
        ) from error
    except (OSError, ValueError) as error:
        raise SourceError(
            f"the .parquet file cannot be read ({error})", place=path.name, hint="Write it again"
        ) from error
    rows = [list(map(str, frame.columns))]
    rows += [[_typed(cell) for cell in row] for row in frame.itertuples(index=False, name=None)]
    return _table(list(enumerate(rows, start=1)), path, key, "row", ",", ())


def _workbook(data: bytes, path: Path, key: str) -> TextTable:
    """The one sheet of a workbook whose first row has a column `key`."""
    try:
        with ZipFile(io.BytesIO(data)) as archive:
            is_workbook = "xl/workbook.xml" in archive.namelist()
    except BadZipFile as error:
        raise SourceError(
            "the file is damaged", place=path.name, hint="Copy or save it again"
        ) from error
    if not is_workbook:
        raise SourceError(
            "this is an archive or another program's document, not an .xlsx workbook",
            place=path.name,
            hint=_SAVE_AS,
        )
    import openpyxl

    values = openpyxl.load_workbook(io.BytesIO(data), read_only=True, data_only=True)
    formulas = openpyxl.load_workbook(io.BytesIO(data), read_only=True, data_only=False)
    sheets = {
        sheet.title: list(sheet.iter_rows(values_only=True))
        for sheet in values.worksheets
        if sheet.sheet_state == "visible"
    }
    fitting = [name for name, rows in sheets.items() if rows and key in map(_typed, rows[0])]
    if len(fitting) != 1:
        raise SourceError(
            f"{len(fitting) or 'none'} of its sheets ({', '.join(sheets)}) "
            f"{'have' if len(fitting) > 1 else 'has'} a column {key!r} in the first row",
            place=path.name,
            hint="Leave the table alone in the workbook, its header in row 1",
        )
    name = fitting[0]
    for at, (row, written) in enumerate(
        zip(sheets[name], formulas[name].iter_rows(values_only=True), strict=True), start=1
    ):
        for value, text in zip(row, written, strict=True):
            if value is None and text is not None:
                raise SourceError(
                    f"row {at}: the formula {text} was never computed",
                    place=path.name,
                    hint="Open and save the workbook in a spreadsheet, or save it as CSV",
                )
    rows = [(at, [_typed(cell) for cell in row]) for at, row in enumerate(sheets[name], start=1)]
    other = [sheet for sheet in sheets if sheet != name]
    notes = (f"sheets not used: {', '.join(other)}",) if other else ()
    return _table([row for row in rows if any(row[1])], path, key, "row", ",", notes)


def _typed(cell: Any) -> str:
    """The text of a cell that a workbook or columnar file holds as a number, a truth or a date."""
    if cell is None or (not isinstance(cell, str) and pd.isna(cell)):
        return ""
    if isinstance(cell, float) and cell.is_integer():
        return str(int(cell))
    return str(cell).strip()


def _table(
    rows: Rows, path: Path, key: str, unit: Unit, separator: str, notes: tuple[str, ...]
) -> TextTable:
    if not rows:
        raise SourceError(f"{path.name}: the table is empty; nothing can be analysed")
    (header_at, header), *body = rows
    names = [name.strip() for name in header]
    _check_widths(len(names), body, path, unit, separator)
    while names and not names[-1] and not any(row[len(names) - 1].strip() for _, row in body):
        names.pop()
    names = [name or f"column {at} (no name)" for at, name in enumerate(names, start=1)]
    for name, count in Counter(names).items():
        if count > 1:
            fields = [str(at) for at, one in enumerate(names, start=1) if one == name]
            raise SourceError(
                f"{path.name}: {unit} {header_at}: {count} columns are called {name!r} "
                f"(fields {', '.join(fields)}); keep one, or rename the others"
            )
    frame = pd.DataFrame(
        [[cell.strip() for cell in row[: len(names)]] for _, row in body],
        index=pd.Index([at for at, _ in body], dtype=int),
        columns=names,
        dtype=str,
    )
    if key not in names:
        raise SourceError(f"{path.name}: {unit} {header_at}: no column {key!r}")
    if frame.empty:
        raise SourceError(f"{path.name}: a header and no rows; nothing can be analysed")
    table = TextTable(path.name, frame, unit, separator, notes, header_at)
    nameless = frame.index[frame[key] == ""]
    if len(nameless):
        raise SourceError(f"{table.at(nameless[0])}: the participant is not named")
    return table


def _check_widths(width: int, body: Rows, path: Path, unit: Unit, separator: str) -> None:
    wrong = [(at, len(row)) for at, row in body if len(row) != width]
    if not wrong:
        return
    at, fields = wrong[0]
    more = f" (and {len(wrong) - 1} more rows)" if len(wrong) > 1 else ""
    if len(wrong) == len(body) and all(count == width + 1 for _, count in wrong):
        hint = (
            "Every row has one field more than the header: name the missing column, or leave the "
            "names of the rows out (in R: row.names = FALSE)"
        )
    elif fields > width:
        hint = (
            f"Put fields that contain {SEPARATORS.get(separator, 'the separator')} in quotation "
            "marks, and take surplus fields out"
        )
    else:
        hint = "Leave a missing answer empty between its separators; is the file complete?"
    raise SourceError(
        f"{unit} {at} has {_fields(fields)}, the header has {width}{more}",
        place=path.name,
        hint=hint,
    )


def _fields(count: int) -> str:
    return "1 field" if count == 1 else f"{count} fields"
