"""Tables in the form of the APA manual: as CSV, LaTeX, a document for word processors, and HTML.

Cells are text already (see `analysis.stats.apa`). In headings and notes, *x* stands for an italic
x, as statistical symbols are set.
"""

from __future__ import annotations

import csv
import io
import re
import zipfile
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from html import escape
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pandas as pd

from analysis.stats.apa import DASH, MINUS

if TYPE_CHECKING:
    from docx.text.paragraph import Paragraph

#: The kinds of file of every table.
KINDS = ("csv", "tex", "docx")
#: What LaTeX cannot take as it is.
_LATEX = {
    "\\": r"\textbackslash{}",
    "&": r"\&",
    "%": r"\%",
    "$": r"\$",
    "#": r"\#",
    "_": r"\_",
    "{": r"\{",
    "}": r"\}",
    "~": r"\textasciitilde{}",
    "^": r"\textasciicircum{}",
    "<": "$<$",
    ">": "$>$",
    DASH: "--",
    MINUS: "$-$",
    "±": r"$\pm$",
    "²": "$^2$",
    "₀": "$_0$",
    "₁": "$_1$",
    "η": r"$\eta$",
    "α": r"$\alpha$",
    "Λ": r"$\Lambda$",
    "χ": r"$\chi$",
    "×": r"$\times$",
}
#: The date of every part of a document, so that the same table gives the same bytes.
_EPOCH = (1980, 1, 1, 0, 0, 0)


@dataclass(frozen=True)
class ApaTable:
    """A table whose cells are text; `name` is its file's, `note` says what a reader must know."""

    name: str
    title: str
    columns: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]
    note: str = ""

    def numbered(self, number: int) -> Numbered:
        """The table under its number."""
        return Numbered(number, self)


@dataclass(frozen=True)
class Numbered:
    """A table with its number in a report."""

    number: int
    table: ApaTable

    @property
    def name(self) -> str:
        """The name of its files, without ending."""
        return f"table{self.number:02}_{self.table.name}"

    def html(self) -> str:
        """The table as HTML."""
        title = escape(unmarked(self.table.title))
        head = f'<p class="title"><b>Table {self.number}</b><br><i>{title}</i></p>'
        body = _styled(self.table).hide(axis="index").set_uuid(self.name)
        body = body.set_table_attributes('class="apa"')
        note = f'<p class="note"><i>Note.</i> {html_of(self.table.note)}</p>'
        return f"<div>{head}{body.to_html()}{note if self.table.note else ''}</div>"

    def csv(self) -> str:
        """The table as CSV."""
        out = io.StringIO()
        writer = csv.writer(out, lineterminator="\n")
        writer.writerow([unmarked(column) for column in self.table.columns])
        writer.writerows(self.table.rows)
        return out.getvalue()

    def latex(self) -> str:
        """The table as LaTeX (packages booktabs and threeparttable)."""
        frame = pd.DataFrame(
            [[_latex(cell) for cell in row] for row in self.table.rows],
            columns=[_latex(column) for column in self.table.columns],
        )
        tabular: str = frame.style.hide(axis="index").to_latex(
            column_format="l" + "r" * (len(self.table.columns) - 1), hrules=True
        )
        note = f"\\begin{{tablenotes}}\n\\item \\textit{{Note.}} {_latex(self.table.note)}\n"
        note += "\\end{tablenotes}\n"
        return (
            "% needs \\usepackage{booktabs, threeparttable}\n"
            "\\begin{table}\n\\begin{threeparttable}\n"
            f"\\caption{{{_latex(self.table.title)}}}\n\\label{{tab:{self.table.name}}}\n"
            f"{tabular}{note if self.table.note else ''}"
            "\\end{threeparttable}\n\\end{table}\n"
        )

    def docx(self) -> bytes:
        """The table as a document for word processors."""
        import docx

        document: Any = docx.Document()
        document.core_properties.author = ""
        document.core_properties.title = f"Table {self.number}"
        document.add_paragraph().add_run(f"Table {self.number}").bold = True
        document.add_paragraph().add_run(unmarked(self.table.title)).italic = True
        grid = document.add_table(rows=1 + len(self.table.rows), cols=len(self.table.columns))
        for at, column in enumerate(self.table.columns):
            write_runs(grid.rows[0].cells[at].paragraphs[0], column)
        for line, row in zip(grid.rows[1:], self.table.rows, strict=True):
            for cell, text in zip(line.cells, row, strict=True):
                write_runs(cell.paragraphs[0], text)
        _rules(grid)
        if self.table.note:
            paragraph = document.add_paragraph()
            paragraph.add_run("Note. ").italic = True
            write_runs(paragraph, self.table.note)
        packed = io.BytesIO()
        document.save(packed)
        return undated(packed.getvalue())


def write_tables(tables: Sequence[Numbered], folder: Path) -> list[Path]:
    """Write each table as CSV, LaTeX and docx into a folder that exists."""
    paths = []
    for table in tables:
        parts = (table.csv().encode(), table.latex().encode(), table.docx())
        for kind, content in zip(KINDS, parts, strict=True):
            path = folder / f"{table.name}.{kind}"
            path.write_bytes(content)
            paths.append(path)
    return paths


def marked(text: str) -> Iterator[tuple[str, bool]]:
    """The parts of a text and whether each is italic."""
    for at, part in enumerate(re.split(r"\*(?=\S)([^*]+)\*", text)):
        if part:
            yield part, at % 2 == 1


def unmarked(text: str) -> str:
    """The text without its marks."""
    return "".join(part for part, _ in marked(text))


def html_of(text: str) -> str:
    """The text as HTML."""
    return "".join(
        f"<i>{escape(part)}</i>" if italic else escape(part) for part, italic in marked(text)
    )


def _latex(text: str) -> str:
    return "".join(
        f"\\textit{{{escaped}}}" if italic else escaped
        for part, italic in marked(text)
        for escaped in ["".join(_LATEX.get(letter, letter) for letter in part)]
    )


def _styled(table: ApaTable) -> Any:
    rows = [[escape(cell) for cell in row] for row in table.rows]
    return pd.DataFrame(rows, columns=[html_of(column) for column in table.columns]).style


def write_runs(paragraph: Paragraph, text: str) -> None:
    """Add a text to a paragraph of a document, its marked parts in italics."""
    for part, italic in marked(text):
        paragraph.add_run(part).italic = italic


def _rules(grid: Any) -> None:
    """Rules above and below the heading, and below the last row, and no others."""
    for at, sides in ((0, ("top", "bottom")), (len(grid.rows) - 1, ("bottom",))):
        for cell in grid.rows[at].cells:
            _border(cell, sides)


def _border(cell: Any, sides: Sequence[str]) -> None:
    from docx.oxml import OxmlElement
    from docx.oxml.ns import qn

    borders = OxmlElement("w:tcBorders")
    for side in sides:
        line = OxmlElement(f"w:{side}")
        for name, value in (("val", "single"), ("sz", "6"), ("color", "000000")):
            line.set(qn(f"w:{name}"), value)
        borders.append(line)
    cell._tc.get_or_add_tcPr().append(borders)


def undated(document: bytes) -> bytes:
    """The same document with its parts dated alike."""
    out = io.BytesIO()
    with zipfile.ZipFile(io.BytesIO(document)) as parts, zipfile.ZipFile(out, "w") as packed:
        for name in parts.namelist():
            info = zipfile.ZipInfo(name, _EPOCH)
            info.compress_type = zipfile.ZIP_DEFLATED
            packed.writestr(info, parts.read(name))
    return out.getvalue()
