"""One quiet look for all figures: colours that differ for every eye, shapes that differ in print.

Ordered things (levels, knowledge groups) have colours ordered by lightness, so that they are told
apart in grey and with any colour vision; the others are of the Okabe-Ito palette. Every colour
comes with a marker or a line style of its own. No figure carries its caption: that is for the text
around it.
"""

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import matplotlib as mpl
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.layout_engine import ConstrainedLayoutEngine

INK = "#222222"
SHADE = "#ededed"
BLUE = "#0072B2"
ORANGE = "#E69F00"
GREEN = "#009E73"
VERMILION = "#D55E00"

#: Widths of a figure in print, one and two columns of a journal, in inches (85 and 175 mm).
ONE_COLUMN = 85 / 25.4
TWO_COLUMNS = 175 / 25.4

SIMULATED = "SIMULATED PEOPLE"

#: The higher the level, the darker.
LEVEL_COLOURS = {"C1": "#ea7457", "C2": "#ab3090", "C3": "#240a6b"}
#: Blue, red and green as in Fig. 10, the more knowledge the lighter.
GROUP_COLOURS = {"LOW": "#163f77", "MED": "#d1543a", "HIGH": "#86cfa0"}
GROUP_LINES = {"LOW": "-", "MED": "--", "HIGH": "-."}
LEVEL_MARKERS = {"C1": "o", "C2": "s", "C3": "^"}

SETTINGS: dict[Any, object] = {
    "figure.dpi": 100,
    "savefig.dpi": 300,
    "figure.facecolor": "white",
    "font.family": "DejaVu Sans",
    "font.size": 8,
    "axes.titlesize": 9,
    "axes.titleweight": "bold",
    "axes.titlelocation": "left",
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.edgecolor": INK,
    "axes.labelcolor": INK,
    "axes.linewidth": 0.8,
    "axes.grid": True,
    "axes.grid.axis": "y",
    "axes.axisbelow": True,
    "grid.color": "#e6e6e6",
    "grid.linewidth": 0.7,
    "xtick.color": INK,
    "ytick.color": INK,
    "legend.frameon": False,
    "svg.hashsalt": "ana",
    "svg.fonttype": "none",
    "pdf.fonttype": 42,
}

#: What each kind of file is told, so that two runs give the same bytes.
FORMATS: dict[str, dict[str, str | None]] = {
    "svg": {"Date": None},
    "pdf": {"CreationDate": None},
    "png": {"Software": None},
}

#: What a description is called in each kind of file.
DESCRIPTIONS = {"svg": "Description", "pdf": "Subject", "png": "Description"}


@dataclass(frozen=True)
class Captioned:
    """A figure, its file's name without ending, and the sentence that says what to see."""

    name: str
    figure: Figure
    caption: str


@contextmanager
def quiet_style() -> Iterator[None]:
    """Draw inside this style, whatever the caller's own settings are."""
    with mpl.rc_context():
        mpl.rcdefaults()
        mpl.rcParams.update(SETTINGS)
        yield


def captioned(name: str, figure: Figure, caption: str, *, simulated: bool) -> Captioned:
    """A finished figure and its caption; SIMULATED PEOPLE is written into it where that applies."""
    bottom = 0.0
    if simulated:
        bottom = 0.17 / figure.get_figheight()
        figure.text(0.01, 0.02 / figure.get_figheight(), SIMULATED, fontsize=7, weight="bold",
                    color=VERMILION, va="bottom", ha="left")  # fmt: skip
    layout = ConstrainedLayoutEngine(rect=(0, bottom, 1, 1 - bottom))
    figure.set_layout_engine(layout)
    layout.execute(figure)
    figure.set_layout_engine("none")  # laid out once, whatever it is written to
    return Captioned(name, figure, f"{SIMULATED}. {caption}" if simulated else caption)


def save_figures(drawn: Sequence[Captioned], folder: Path, origin: str = "") -> list[Path]:
    """Write each figure as SVG, PDF and PNG (300 dots an inch) into a folder that exists, and
    their captions into captions.txt; `origin` is written into each file's description."""
    paths = []
    for item in drawn:
        for kind, undated in FORMATS.items():
            path = folder / f"{item.name}.{kind}"
            told = {DESCRIPTIONS[kind]: origin} if origin else {}
            with quiet_style():
                item.figure.savefig(path, metadata=undated | told)
            paths.append(path)
    captions = "".join(f"{item.name}\n{item.caption}\n\n" for item in drawn)
    (folder / "captions.txt").write_text(captions, encoding="utf-8")
    return paths


def bracket(axes: Axes, left: float, right: float, height: float, text: str) -> None:
    """A bracket over two positions with its p-value; `height` in data units."""
    low, high = axes.get_ylim()
    drop = 0.015 * (high - low)
    axes.plot(
        [left, left, right, right],
        [height - drop, height, height, height - drop],
        color=INK,
        linewidth=0.8,
    )
    axes.text((left + right) / 2, height, text, ha="center", va="bottom", fontsize=7, color=INK)
