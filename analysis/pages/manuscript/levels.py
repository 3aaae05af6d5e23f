"""What the adaptive instructor did over time: section 5.4, paragraph 5, Fig. 10."""

import pandas as pd

from analysis.pages.apa_table import ApaTable
from analysis.pages.behaviour import level_rows
from analysis.pages.manuscript.part import Found, Part, drawing
from analysis.pages.mission_rows import missions
from analysis.pages.traces import all_traces, fig10_traces
from analysis.sources.absent import Absent, attempt
from analysis.stats.level import percent


def levels(found: Found) -> Part:
    """What the adaptive instructor did over time (section 5.4, paragraph 5; Fig. 10)."""
    title = "Levels over time (section 5.4, paragraph 5; Fig. 10)"
    if found.recorded is None:
        return Part(title, ["The source does not record levels over time."], [], [])
    recorded = found.recorded
    drawings = [
        drawing(fig10_traces, recorded, found.study),
        drawing(all_traces, recorded, found.study),
    ]
    shares = attempt(lambda: level_rows(missions(recorded, found.study), found.alpha))
    if isinstance(shares, Absent):
        return Part(title, [f"There is no table of levels: {shares.reason}."], [], drawings)
    frame = pd.DataFrame(shares)
    table = ApaTable(
        "fig10",
        "Share of the adaptive missions at each level, and switches a mission",
        tuple(str(column) for column in frame.columns),
        tuple(tuple(str(cell) for cell in row) for row in frame.itertuples(index=False)),
        f"Means with {percent(1 - found.alpha)} bootstrap intervals over people. The paper: LOW "
        "mostly at C1; MED and HIGH mostly at C2, HIGH with more C3 and less C1 than MED.",
    )
    return Part(title, [], [table], drawings)
