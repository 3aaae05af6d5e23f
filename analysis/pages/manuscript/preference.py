"""Preference: sections 5.3 and 5.5."""

import pandas as pd

from analysis.pages.apa_table import ApaTable
from analysis.pages.manuscript.part import Found, Part, drawing
from analysis.pages.preference import preferred_figure, preferred_table, statements_figure
from analysis.pages.sentences import anova_sentence, bounded_interval, preferred_sentence
from analysis.sources.absent import attempt
from analysis.stats.apa import DASH, bounded, p_value
from analysis.stats.level import percent
from analysis.stats.preferred import preferred_rows


def preference(found: Found) -> Part:
    """Preference (sections 5.3 and 5.5: no preference was significant)."""
    sentences = [
        anova_sentence("preference", row, found.alpha)
        for row in (found.own("preference")["anova"] or ())[1:]
    ]
    chosen = attempt(preferred_rows, found.study, found.alpha)
    tables = []
    drawings = [drawing(statements_figure, found.study)]
    told = found.numbers["preferred_instructor"]
    if told is not None:
        sentences.append(preferred_sentence(told["all"], found.alpha))
        frame = preferred_table(chosen)
        tables.append(
            ApaTable(
                "preferred_instructor",
                "Participants who preferred the adaptive instructor",
                ("Of", "*n*", "Adaptive", "Share", f"{percent(1 - found.alpha)} CI", "*p*",
                 "*p* Holm"),
                tuple(
                    (str(row["of"]), str(row["n"]), str(row["adaptive"]), bounded(row["share"], 2),
                     bounded_interval(row["lower.CL"], row["upper.CL"]), p_value(row["p"]),
                     DASH if pd.isna(row.get("p_holm")) else p_value(row["p_holm"]))
                    for row in frame.to_dict("records")
                ),
                "Exact binomial tests against one half; people who preferred neither are not "
                "counted.",
            )
        )  # fmt: skip
        study, second = found.study, found.study.crossed.words[1]
        drawings.append(
            drawing(preferred_figure, chosen, second, simulated=study.simulated, alpha=found.alpha)
        )
    return Part("Preference (sections 5.3 and 5.5)", sentences, tables, drawings)
