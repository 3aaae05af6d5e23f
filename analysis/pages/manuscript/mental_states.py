"""Fig. 7 and its comparisons: section 5.4, paragraphs 2 and 3."""

from collections.abc import Mapping
from typing import Any

from analysis.pages.apa_table import ApaTable
from analysis.pages.figures import fig7_mental_states
from analysis.pages.manuscript.contrasts import contrast_cells, turned
from analysis.pages.manuscript.part import Found, Numbers, Part, drawing
from analysis.pages.published import POSTHOC_FILE, printed
from analysis.pages.sentences import DECIDES, empty_cells_sentence, level_sentence
from analysis.stats.apa import DASH, MINUS
from analysis.stats.cellmodel import cell_words
from analysis.stats.level import percent

_WITHIN = "posthoc_complexity_within_knowledge_by_round"


def mental_states(found: Found) -> Part:
    """Fig. 7 and the comparisons that the paper prints (section 5.4, paragraphs 2 and 3)."""
    lines = printed(found.paper, POSTHOC_FILE)
    lines = lines[lines["round"] == "static"]
    sentences, rows, empty = [], [], []
    for line in lines.to_dict("records"):
        row = _level_row(found, line["outcome"], line["knowledge"], line["greater"], line["less"])
        if row is None:
            continue
        words = (line["outcome"], line["knowledge"], line["greater"], line["less"])
        if row["estimate"] is None:
            empty.append(words)
        else:
            sentences.append(level_sentence(*words, row, found.alpha))
        rows.append(
            (line["outcome"], line["knowledge"], f"{line['greater']} > {line['less']}",
             *contrast_cells(row), _printed_p(line))
        )  # fmt: skip
    if sentences:
        sentences.append(DECIDES)
    if empty:
        sentences.append(empty_cells_sentence(empty))
    head = (
        "*M* difference", f"{percent(1 - found.alpha)} CI", "*t*", "*df*", "*p*", "*p* Holm",
        "*d*", f"*d* {percent(1 - found.alpha)} CI",
    )  # fmt: skip
    note = (
        "*p* is unadjusted; Holm adjusts over the three comparisons of a group. *d* is the "
        "difference over the pooled standard deviation of the "
        f"{cell_words(found.study.crossed.levels)}. The paper does not say whether its *p* is "
        "adjusted."
    )
    every = [
        (state, row["knowledge"], row["contrast"].replace("-", MINUS), *contrast_cells(row))
        for state in found.study.asked.mental_states
        for row in found.own(state)[_WITHIN] or ()
        if row["adaptivity"] == "static" and row["estimate"] is not None
    ]
    tables = [
        ApaTable(
            "fig7_printed",
            "Static levels compared within knowledge groups: the comparisons that the paper prints",
            ("Outcome", "Group", "As published", *head, "*p* paper"),
            tuple(rows) if len(empty) < len(rows) else (),
            note + " A dash in the last column: claimed in a caption or in section 5.5 without a "
            "test.",
        ),
        ApaTable(
            "fig7_all",
            "Static levels compared within knowledge groups after the static round",
            ("Outcome", "Group", "Contrast", *head),
            tuple(every),
            note,
        ),
    ]
    drawings = [drawing(fig7_mental_states, found.study, found.alpha)]
    return Part(
        "Mental states (section 5.4, paragraphs 2 and 3; Fig. 7)", sentences, tables, drawings
    )


def _level_row(
    found: Found, outcome: str, knowledge: str, greater: str, less: str
) -> Numbers | None:
    for row in found.own(outcome)[_WITHIN] or ():
        if (row["adaptivity"], row["knowledge"]) == ("static", knowledge):
            if row["contrast"] == f"{greater} - {less}":
                return dict(row)
            if row["contrast"] == f"{less} - {greater}":
                return turned(row)
    return None


def _printed_p(line: Mapping[Any, Any]) -> str:
    if not isinstance(line["p_printed"], str):
        return DASH
    return line["p_printed"] if line["p_relation"] == "=" else f"< {line['p_printed']}"
