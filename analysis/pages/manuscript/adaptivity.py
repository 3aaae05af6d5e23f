"""Fig. 9 with the contrast as the paper words it: section 5.4, paragraph 4."""

from analysis.pages.apa_table import ApaTable
from analysis.pages.figures import cells_figure, fig9_adaptivity, first_state
from analysis.pages.manuscript.contrasts import contrast_cells, turned
from analysis.pages.manuscript.part import Found, Part, drawing
from analysis.pages.published import POSTHOC_FILE, printed
from analysis.pages.sentences import DECIDES, gain_sentence
from analysis.stats.apa import DASH
from analysis.stats.level import percent

_GAINS = "posthoc_diff_knowledge_within_complexity"


def adaptivity(found: Found) -> Part:
    """Fig. 9 with the contrast as the paper words it (section 5.4, paragraph 4)."""
    line = next(
        row
        for row in printed(found.paper, POSTHOC_FILE).to_dict("records")
        if row["round"] != "static"
    )
    sentences, rows = [], []
    outcome = first_state(found.study)
    gains = found.own(outcome)[_GAINS] or ()
    one, other = line["greater"], line["less"]
    for row in gains:
        level = row["complexity"]
        pair = [f"{group} {level}" for group in row["contrast"].split(" - ")]
        turn = pair == [other, one]
        shown = turned(row) if turn else row
        published = outcome == line["outcome"] and (turn or pair == [one, other])
        if published:
            points = found.printed("engagement gain of HIGH C1 over LOW C1")
            sentences.append(
                gain_sentence(outcome, one, other, shown, found.alpha)
                + f" (Paper: {points} points, *p* = {line['p_printed']}.)"
            )
        first, second = (one, other) if turn else pair
        rows.append(
            (f"{first} over {second}", *contrast_cells(shown),
             points if published else DASH, line["p_printed"] if published else DASH)
        )  # fmt: skip
    if any(row["estimate"] is not None for row in gains):
        sentences.append(DECIDES)
    else:
        rows = []
    ci = f"{percent(1 - found.alpha)} CI"
    table = ApaTable(
        "fig9",
        f"Gain in {outcome} with adaptive instruction, compared between knowledge groups",
        ("Contrast of adaptive − static", "*M* difference", ci, "*t*", "*df*", "*p*", "*p* Holm",
         "*d*", f"*d* {ci}", "Points paper", "*p* paper"),
        tuple(rows),
        "Holm adjusts over the three comparisons at a static level.",
    )  # fmt: skip
    drawings = [
        drawing(fig9_adaptivity, found.study, outcome, found.alpha),
        drawing(cells_figure, found.study, outcome, found.alpha),
    ]
    return Part("Adaptivity (section 5.4, paragraph 4; Fig. 9)", sentences, [table], drawings)
