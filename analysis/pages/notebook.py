"""What every notebook begins with: one source, its analysed sample, and things to look at."""

import base64
import io
import os
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from html import escape
from pathlib import Path

import pandas as pd

from analysis.pages.mission_rows import missions
from analysis.pages.style import SIMULATED, VERMILION, Captioned
from analysis.sources.absent import Absent, Row, Tree
from analysis.sources.frames import StudyData
from analysis.sources.recorded import Recorded
from analysis.sources.samples import left_by
from analysis.sources.source import load_recorded
from analysis.stats.clustering import Clustering
from analysis.stats.groups import grouped
from game.tables.exclusions import ExclusionRules, read_rules

#: Names another source for all notebooks, in place of the one in their parameter cell.
VARIABLE = "ANA_SOURCE"
DPI = 130


@dataclass(frozen=True)
class Shown:
    """Something that a cell shows when it is its last line; `text` says it without pictures."""

    html: str
    text: str

    def _repr_html_(self) -> str:
        return self.html

    def __repr__(self) -> str:
        return self.text


@dataclass(frozen=True, repr=False)
class Opened:
    """A source as the notebooks use it. `randomised` is everybody, `study` the analysed sample
    with its knowledge groups."""

    folder: Path
    recorded: Recorded
    rules: ExclusionRules
    randomised: StudyData
    study: StudyData
    clustering: Clustering | Absent

    @property
    def simulated(self) -> bool:
        """Whether the people are."""
        return self.study.simulated

    @cached_property
    def missions(self) -> pd.DataFrame:
        """A row a mission of the analysed sample."""
        return missions(self.recorded, self.study)

    def table(
        self, rows: pd.DataFrame | Sequence[Tree] | Absent, title: str, digits: int = 3
    ) -> Shown:
        """A table under its title, or the reason why it cannot be had."""
        return table(rows, title, digits, simulated=self.simulated)

    def __repr__(self) -> str:
        analysed, of = len(self.study.participants), len(self.randomised.participants)
        return f"{self.study.label}: {analysed} people analysed of {of} randomised"

    def _repr_html_(self) -> str:
        words = (
            f"<b>{escape(self.study.label)}</b>: {len(self.study.participants)} people analysed "
            f"of {len(self.randomised.participants)} randomised"
        )
        notes = "".join(f"<br>Note: {escape(note)}." for note in self.study.notes)
        return f"<p>{_label(self.simulated)}{words}{notes}</p>"


def open_source(source: str) -> Opened:
    """The study in a folder of sessions or of tables, ready to be looked at.

    The variable `ANA_SOURCE` of the environment goes before `source`. Raises SourceError.
    """
    folder = Path(os.environ.get(VARIABLE) or source)
    recorded = load_recorded(folder, check=False)
    randomised = recorded.study()
    rules = read_rules().known_to(list(randomised.participants.columns))
    study, clustering = grouped(left_by(randomised, rules.main()).study)
    return Opened(folder, recorded, rules, randomised, study, clustering)


def show(figure: Captioned | Absent) -> Shown:
    """A figure with its caption below, which says what to see; or why it cannot be had."""
    if isinstance(figure, Absent):
        return Shown(f"<p>No figure: {escape(figure.reason)}.</p>", figure.reason)
    image = io.BytesIO()
    figure.figure.savefig(image, format="png", dpi=DPI)
    data = base64.b64encode(image.getvalue()).decode()
    caption = escape(figure.caption)
    html = (
        f'<figure><img alt="{caption}" src="data:image/png;base64,{data}">'
        f"<figcaption>{caption}</figcaption></figure>"
    )
    return Shown(html, figure.caption)


def table(
    rows: pd.DataFrame | Sequence[Tree] | Absent,
    title: str,
    digits: int = 3,
    *,
    simulated: bool = False,
) -> Shown:
    """A table under its title, or the reason why it cannot be had."""
    head = f"<p>{_label(simulated)}<b>{escape(title)}</b></p>"
    if isinstance(rows, Absent):
        return Shown(f"{head}<p>Not there: {escape(rows.reason)}.</p>", rows.reason)
    frame = rows if isinstance(rows, pd.DataFrame) else pd.DataFrame(list(rows))
    told = frame.map(lambda cell: _told(cell, digits))
    index = not isinstance(frame.index, pd.RangeIndex)
    return Shown(head + told.to_html(border=0, index=index), told.to_string(index=index))


def flat(rows: Sequence[Row]) -> list[Row]:
    """The same rows without what is nested in them."""
    return [
        {key: value for key, value in row.items() if not isinstance(value, dict | list)}
        for row in rows
    ]


def _told(cell: object, digits: int) -> str:
    """A cell as text; nothing where a table of others has nothing."""
    if isinstance(cell, Absent):
        return f"not there: {cell.reason}"
    if isinstance(cell, float):
        if pd.isna(cell):
            return ""
        return f"{cell:.0f}" if cell.is_integer() else f"{cell:.{digits}f}"
    return str(cell)


def _label(simulated: bool) -> str:
    return f'<b style="color:{VERMILION}">{SIMULATED}</b> ' if simulated else ""
