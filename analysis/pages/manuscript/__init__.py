"""A results section in the paper's order: every number and figure of its sections 5.3 to 5.5, ours
beside the printed, with ready-made sentences and tables in APA form. One module makes a part."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property

from analysis.pages.apa_table import ApaTable, Numbered
from analysis.pages.manuscript.adaptivity import adaptivity
from analysis.pages.manuscript.beyond import beyond
from analysis.pages.manuscript.levels import levels
from analysis.pages.manuscript.measures import measures
from analysis.pages.manuscript.mental_states import mental_states
from analysis.pages.manuscript.part import Drawing, Found, Part
from analysis.pages.manuscript.participants import participants
from analysis.pages.manuscript.performance import performance
from analysis.pages.manuscript.preference import preference
from analysis.pages.manuscript.primary import primary
from analysis.pages.manuscript.rounds import rounds
from analysis.pages.style import SIMULATED, Captioned
from analysis.sources.absent import Absent, attempt
from analysis.sources.frames import StudyData

__all__ = ["PARTS", "PRINTED", "Found", "Section", "figures_in", "manuscript", "tables_of"]

Parts = tuple[Callable[[Found], Part], ...]
PRINTED: Parts = (measures, participants, mental_states, performance, adaptivity)
"""The parts for which the paper prints numbers."""
PARTS: Parts = (measures, participants, primary, *PRINTED[2:], rounds, levels, preference, beyond)


@dataclass(frozen=True)
class Section:
    """A part of the results with its tables numbered: sentences (*x* is an italic x), then tables,
    then figures. `left_out` are the tables of which nothing could be computed."""

    title: str
    sentences: tuple[str, ...]
    tables: tuple[Numbered, ...]
    drawings: tuple[Drawing, ...]
    left_out: tuple[ApaTable, ...] = ()

    @cached_property
    def figures(self) -> tuple[Captioned, ...]:
        """Those of the figures that can be had, drawn when they are first asked for."""
        drawn = (attempt(drawing) for drawing in self.drawings)
        return tuple(figure for figure in drawn if not isinstance(figure, Absent))


def manuscript(found: Found, parts: Parts = PARTS) -> list[Section]:
    """The sections in the paper's order, their tables numbered through; a part about which there is
    nothing to say is none."""
    sections = []
    number = 0
    for make in parts:
        part = make(found)
        if not (part.sentences or part.tables or part.drawings):
            continue
        mapping = found.study.crossed.mapping
        sentences = [*([f"In this section {mapping}."] if mapping else []), *part.sentences]
        numbered = []
        for table in part.tables:
            if table.rows:
                number += 1
                numbered.append(_labelled(table, found.study).numbered(number))
        left_out = tuple(table for table in part.tables if not table.rows)
        if left_out:
            titles = "; ".join(table.title for table in left_out)
            why = "for want of people or because of empty cells"
            sentences.append(f"Not computed, {why}: {titles}.")
        sections.append(
            Section(part.title, tuple(sentences), tuple(numbered), tuple(part.drawings), left_out)
        )
    return sections


def _labelled(table: ApaTable, study: StudyData) -> ApaTable:
    """The table with what a reader must know of all of it in its note."""
    told = [SIMULATED] if study.simulated else []
    told += [study.crossed.mapping] if study.crossed.mapping else []
    note = " ".join([*(f"{one}." for one in told), table.note]).strip()
    return ApaTable(table.name, table.title, table.columns, table.rows, note)


def tables_of(sections: Sequence[Section]) -> Iterator[Numbered]:
    """All tables of a report."""
    return (table for section in sections for table in section.tables)


def figures_in(sections: Sequence[Section]) -> Iterator[Captioned]:
    """All figures of a report."""
    return (figure for section in sections for figure in section.figures)
