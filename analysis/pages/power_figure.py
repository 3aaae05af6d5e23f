"""How many people a study needs to see the paper's three-way effect."""

from collections.abc import Sequence

import pandas as pd
from matplotlib.figure import Figure

from analysis.pages.style import (
    BLUE,
    INK,
    ORANGE,
    TWO_COLUMNS,
    Captioned,
    captioned,
    quiet_style,
)
from analysis.stats.anova import THREE_WAY
from analysis.stats.power import SAMPLE_SIZES, PowerPoint, sample_size, simulated_power

#: The paper recruited so many.
PUBLISHED_N = 108


def power_points(
    effects: Sequence[float],
    shares: Sequence[float],
    sizes: Sequence[int] = SAMPLE_SIZES,
    samples: int = 2000,
) -> dict[float, list[PowerPoint]]:
    """The simulated curve of each partial eta squared."""
    return {
        pes: [simulated_power(THREE_WAY, pes, n, samples=samples, shares=shares) for n in sizes]
        for pes in effects
    }


def power_figure(curves: dict[float, list[PowerPoint]]) -> Captioned:
    """Power by number of people; `curves` are those of `power_points`."""
    with quiet_style():
        figure = Figure(figsize=(TWO_COLUMNS, 3.9))
        axes = figure.subplots()
        axes.axhline(0.8, color=INK, linewidth=0.8, linestyle=":")
        axes.axvline(PUBLISHED_N, color=INK, linewidth=0.8, linestyle=":")
        styles = ((BLUE, "o"), (ORANGE, "s"), (INK, "^"))
        for (pes, points), (colour, marker) in zip(curves.items(), styles, strict=False):
            sizes = [point.n for point in points]
            axes.fill_between(
                sizes,
                [point.lower for point in points],
                [point.upper for point in points],
                color=colour,
                alpha=0.2,
                linewidth=0,
            )
            power = [point.power for point in points]
            axes.plot(sizes, power, marker, linestyle="-", color=colour, label=f"{pes:g}")
            axes.plot(sizes, [point.analytic for point in points], "--", color=colour)
        axes.set_ylim(0, 1)
        axes.set_xlabel("people")
        axes.set_ylabel("power at .05")
        axes.legend(title="partial eta squared", loc="lower right")
        return captioned(
            "power",
            figure,
            "Chance to see the knowledge x complexity x adaptivity effect: a line above .8 "
            "(dotted) is enough people; solid with band: simulated samples whose groups fall at "
            "random, dashed: noncentral F at equal cells; vertical: the paper's 108.",
            simulated=False,
        )


def needed(effects: Sequence[float]) -> pd.DataFrame:
    """The least people for power .8 and .9 at equal cells, by partial eta squared."""
    return pd.DataFrame(
        {f"power {power:g}": [sample_size(THREE_WAY, pes, power) for pes in effects]
         for power in (0.8, 0.9)},
        index=pd.Index(effects, name="partial eta squared"),
    )  # fmt: skip
