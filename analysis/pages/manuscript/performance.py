"""The mixed ANOVAs beside the printed ones, and Fig. 8: section 5.4, paragraph 4."""

from collections.abc import Mapping
from typing import Any

from analysis.pages.apa_table import ApaTable
from analysis.pages.figures import adaptivity_estimates, fig8_performance
from analysis.pages.manuscript.part import Found, Part, drawing
from analysis.pages.published import ANOVA_FILE, printed
from analysis.pages.sentences import anova_sentence, bounded_interval, interval
from analysis.stats.apa import DASH, bounded, decimal, p_value, share
from analysis.stats.level import percent


def performance(found: Found) -> Part:
    """The mixed ANOVAs of section 5.4, paragraph 4, beside the printed ones, and Fig. 8."""
    lines = printed(found.paper, ANOVA_FILE)
    sentences, rows = [], []
    for line in lines.to_dict("records"):
        row = found.effect(line["outcome"], line["effect"])
        if row is None:
            continue
        sentences.append(
            anova_sentence(line["outcome"], row, found.alpha)
            + f" (Paper: Λ = {line['lambda_read']}, *F*({line['df1']}, {line['df2']}) = "
            f"{line['F']}, *p* = {line['p_printed']}{_eta_printed(line)}.)"
        )
        rows.append(
            (line["outcome"], line["effect"], bounded(row["wilks"]), str(line["lambda_read"]),
             f"{row['df1']}, {row['df2']}", f"{line['df1']}, {line['df2']}", decimal(row["F"], 3),
             str(line["F"]), p_value(row["p"]), str(line["p_printed"]), share(row["pes"]),
             bounded_interval(row["pes.lower"], row["pes.upper"], 3),
             line["eta_printed"] if isinstance(line["eta_printed"], str) else DASH)
        )  # fmt: skip
    eta_level = percent(1 - 2 * found.alpha)
    tables = [
        ApaTable(
            "anova_printed",
            "Mixed ANOVAs: the effects that the paper prints",
            ("Outcome", "Effect", "Λ", "Λ paper", "*df*", "*df* paper", "*F*", "*F* paper", "*p*",
             "*p* paper", "Partial *η*²", f"{eta_level} CI", "*η*² paper"),
            tuple(rows),
            "The paper's “Λ = 836” lacks its point.",
        ),
        _anova_table(found),
        _means_table(found),
    ]  # fmt: skip
    drawings = [
        drawing(fig8_performance, found.study),
        drawing(adaptivity_estimates, found.study, found.alpha),
    ]
    title = "Performance and the mixed ANOVAs (section 5.4, paragraph 4; Fig. 8)"
    return Part(title, sentences, tables, drawings)


def _eta_printed(line: Mapping[Any, Any]) -> str:
    eta = line["eta_printed"]
    return f", partial *η*² = {eta}" if isinstance(eta, str) else ""


def _anova_table(found: Found) -> ApaTable:
    holm = found.numbers["holm_across_mental_states"]
    rows = []
    for outcome in found.study.outcomes:
        for row in (found.own(outcome)["anova"] or ())[1:]:
            across = holm[row["effect"]].get(outcome)
            rows.append(
                (outcome, row["effect"], f"{row['df1']}, {row['df2']}", decimal(row["F"]),
                 p_value(row["p"]), p_value(across), bounded(row["wilks"]), share(row["pes"]),
                 bounded_interval(row["pes.lower"], row["pes.upper"]),
                 share(row["ges_obs_knowledge"]))
            )  # fmt: skip
    return ApaTable(
        "anova_all",
        "Mixed ANOVAs of all outcomes",
        ("Outcome", "Effect", "*df*", "*F*", "*p*", "*p* Holm", "Λ", "Partial *η*²",
         f"{percent(1 - 2 * found.alpha)} CI", "Generalised *η*²"),
        tuple(rows),
        "Type III sums of squares. Holm adjusts over the four mental states, effect by effect. "
        "Generalised *η*² takes knowledge as measured. Λ belongs to within-person effects alone.",
    )  # fmt: skip


def _means_table(found: Found) -> ApaTable:
    rows = []
    for outcome in found.study.outcomes:
        own = found.own(outcome)
        if own["cells"] is None or own["emm"] is None:
            continue
        ends = {
            (row["knowledge"], row["complexity"], row["adaptivity"]): row
            for row in own["emm"]["knowledge_complexity_adaptivity"]
        }
        for cell in own["cells"]:
            if not cell["n"]:
                continue
            mean = ends[cell["knowledge"], cell["complexity"], cell["adaptivity"]]
            rows.append(
                (outcome, cell["knowledge"], cell["complexity"], cell["adaptivity"],
                 str(cell["n"]), decimal(cell["mean"]), decimal(cell["sd"]),
                 interval(mean["lower.CL"], mean["upper.CL"]))
            )  # fmt: skip
    return ApaTable(
        "means",
        "Means of the analysis cells",
        ("Outcome", "Group", "Level", "Round", "*n*", "*M*", "*SD*",
         f"{percent(1 - found.alpha)} CI"),
        tuple(rows),
        "Intervals are of the mean, from the round's pooled error. A cell without anybody is left "
        "out.",
    )  # fmt: skip
