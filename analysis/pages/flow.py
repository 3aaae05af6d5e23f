"""Who took part: the flow of participants, the balance of the design, and who is left out."""

import pandas as pd
from matplotlib.figure import Figure

from analysis.pages.style import (
    BLUE,
    INK,
    SHADE,
    TWO_COLUMNS,
    Captioned,
    captioned,
    quiet_style,
)
from analysis.sources.absent import Row
from analysis.sources.frames import StudyData
from analysis.sources.recorded import Recorded
from analysis.sources.samples import left_by
from analysis.stats.sensitivity import by_design_cell
from game.tables.exclusions import ExclusionRules


def flow_rows(recorded: Recorded, rules: ExclusionRules) -> list[Row]:
    """The steps from the first session to the analysed sample, with who left before each."""
    people = recorded.frame("participants")
    agreed = people[people["session_ending"] != "declined"]
    placeless = int((agreed["session_ending"] == "turned_away").sum())
    no_place = f", {placeless} found no place" if placeless else ""
    randomised = agreed[agreed["complexity"].notna()]
    finished = randomised[randomised["session_ending"] == "finished"]
    study = recorded.study()
    analysed = left_by(study, rules.main())
    steps = [
        ("began a session", len(people), ""),
        ("agreed", len(agreed), f"{len(people) - len(agreed)} declined"),
        (
            "were randomised",
            len(randomised),
            _left(len(agreed) - placeless, len(randomised), "before allocation") + no_place,
        ),
        (
            "finished both rounds",
            len(finished),
            _left(len(randomised), len(finished), "afterwards"),
        ),
        (
            "are analysed",
            len(analysed.study.participants),
            f"{len(analysed.excluded)} of the randomised left out: {rules.main().words}",
        ),
    ]
    return [{"step": step, "people": n, "note": note} for step, n, note in steps]


def _left(before: int, after: int, when: str) -> str:
    return f"{before - after} left {when}"


def flow_figure(rows: list[Row], *, simulated: bool) -> Captioned:
    """The flow of participants; `rows` are those of `flow_rows`."""
    with quiet_style():
        figure = Figure(figsize=(TWO_COLUMNS, 2.6))
        axes = figure.subplots()
        axes.grid(visible=False)
        widths = [int(str(row["people"])) for row in rows]
        colours = [BLUE if row is rows[-1] else SHADE for row in rows]
        axes.barh(range(len(rows)), widths, color=colours, edgecolor=INK, linewidth=0.6)
        for at, (width, colour) in enumerate(zip(widths, colours, strict=True)):
            ink = "white" if colour == BLUE else INK
            axes.text(width / 2, at, str(width), ha="center", va="center", color=ink)
        axes.set_yticks(range(len(rows)), [str(row["step"]) for row in rows])
        axes.set_ylim(len(rows) - 0.5, -0.5)
        axes.set_xticks([])
        axes.spines["bottom"].set_visible(False)
        return captioned(
            "flow",
            figure,
            "The flow of participants: see where people are lost. Everybody randomised is in the "
            "sensitivity checks, and in the mixed models with what they answered.",
            simulated=simulated,
        )


def balance(study: StudyData) -> pd.DataFrame:
    """People a design cell: memorise time and order by static level, in each first building."""
    people = study.participants.copy()
    first = study.rounds.merge(people[["order"]], left_on="participant", right_index=True)
    is_first = (first["adaptivity"] + "_first") == first["order"]
    people["first building"] = first[is_first].set_index("participant")["building"]
    return pd.crosstab(
        [people["memorise_minutes"], people["order"]],
        [people["complexity"], people["first building"]],
    )


def exclusion_table(study: StudyData, rules: ExclusionRules) -> pd.DataFrame:
    """Randomised and excluded in each design cell, a column a rule."""
    parts = []
    for rule in rules.rule:
        excluded = left_by(study, rule).excluded
        table = pd.DataFrame(by_design_cell(study, excluded))
        keys = [name for name in table.columns if name not in ("randomised", "excluded")]
        parts.append(table.set_index([*keys, "randomised"])["excluded"].rename(rule.name))
    return pd.concat(parts, axis=1).reset_index("randomised")
