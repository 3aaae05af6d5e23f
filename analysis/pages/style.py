"""One quiet look for all figures: colours that differ for every eye, shapes that differ in print.

Colours are of the Okabe-Ito palette; every colour comes with a marker of its own.
"""

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from textwrap import fill
from typing import Any

import matplotlib as mpl
from matplotlib.axes import Axes
from matplotlib.figure import Figure

INK = "#222222"
SHADE = "#ededed"
BLUE = "#0072B2"
ORANGE = "#E69F00"
GREEN = "#009E73"
VERMILION = "#D55E00"

SIMULATED = "SIMULATED PEOPLE"

LEVEL_COLOURS = {"C1": BLUE, "C2": ORANGE, "C3": GREEN}
LEVEL_MARKERS = {"C1": "o", "C2": "s", "C3": "^"}

SETTINGS: dict[Any, object] = {
    "figure.dpi": 100,
    "savefig.dpi": 200,
    "figure.facecolor": "white",
    "font.family": "DejaVu Sans",
    "font.size": 9,
    "axes.titlesize": 10,
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
}


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
    """Write the caption below the figure, under the words SIMULATED PEOPLE where they apply."""
    text = fill(caption, int(figure.get_figwidth() * 17))
    line = 0.17 / figure.get_figheight()
    top = 0.02 + line * (text.count("\n") + 1)
    figure.text(0.015, 0.02, text, fontsize=8, color=INK, va="bottom", ha="left")
    if simulated:
        figure.text(0.015, top, SIMULATED, fontsize=8, weight="bold", color=VERMILION, va="bottom")
        top += line
    figure.set_layout_engine("constrained", rect=(0, top + line / 2, 1, 1 - top - line / 2))
    return Captioned(name, figure, f"{SIMULATED}. {caption}" if simulated else caption)


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
