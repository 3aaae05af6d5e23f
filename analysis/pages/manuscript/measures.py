"""Knowledge groups and the reliability of preference: section 5.3."""

from analysis.pages.apa_table import ApaTable
from analysis.pages.manuscript.part import Found, Part
from analysis.pages.sentences import alpha_sentence, bounded_interval
from analysis.sources.factors import COMPLEXITY, KNOWLEDGE
from analysis.stats.apa import DASH, bounded, decimal
from analysis.stats.level import percent

TITLE = "Measures (paper, section 5.3)"
_ALPHA = "Cronbach's alpha of the four preference items"


def measures(found: Found) -> Part:
    """Knowledge groups and the reliability of preference (section 5.3)."""
    numbers, alpha = found.numbers, found.alpha
    clusters = numbers["clustering"]
    sentences = []
    tables = []
    if clusters is not None:
        low, high = clusters["boundaries"]
        sizes = ", ".join(f"{size} {group}" for group, size in clusters["sizes"].items())
        sentences.append(
            "Participants were clustered on their quiz score before the static mission by optimal "
            f"one-dimensional k-means into three knowledge groups ({sizes}), with cuts at "
            f"{bounded(low) if high <= 1 else decimal(low)} and "
            f"{bounded(high) if high <= 1 else decimal(high)}."
        )
        people = found.study.participants
        rows = []
        for group, centre in zip(KNOWLEDGE, clusters["centers"], strict=True):
            own = people.loc[people["knowledge"] == group, "complexity"].tolist()
            counts = [str(own.count(name)) for name in COMPLEXITY]
            size = clusters["sizes"][group]
            rows.append((group, str(size), decimal(centre, 3), *counts))
        tables.append(
            ApaTable(
                "knowledge_groups",
                "Knowledge groups formed from the quiz scores",
                ("Group", "*n*", "*M* score", *COMPLEXITY),
                tuple(rows),
                f"C1 to C3 are the people of each group at each static level.{_without(found)} The "
                "paper prints neither cuts nor sizes.",
            )
        )
    elif found.study.has("knowledge"):
        sentences.append("The knowledge groups are those that the source states.")
    else:
        sentences.append(
            "There are no knowledge groups: the source states none, and none could be formed from "
            "quiz scores."
        )
    if not any(row["rows_any"] for row in numbers["alpha"].values()):
        sentences.append("Nobody answered the four preference items.")
        return Part(TITLE, sentences, tables, [])
    printed_alpha = f"{bounded(float(found.printed(_ALPHA)))}"
    sentences.append(alpha_sentence(numbers["alpha"]["all"], alpha, printed_alpha))
    tables.append(
        ApaTable(
            "alpha",
            "Cronbach's α of the four preference items",
            ("Rounds", "*n*", "*α*", f"{percent(1 - alpha)} CI", "Paper"),
            tuple(
                (
                    name,
                    str(row["rows_complete"]),
                    bounded(row["listwise"]),
                    bounded_interval(row["lower"], row["upper"], 3),
                    printed_alpha if name == "all" else DASH,
                )
                for name, row in numbers["alpha"].items()
            ),
            "*n* counts rounds with all four answers; the interval is Feldt's.",
        )
    )
    return Part(TITLE, sentences, tables, [])


def _without(found: Found) -> str:
    source = found.numbers["source"]
    lacking = source["n_analysed"] - source["n_grouped"]
    if not lacking:
        return ""
    return f" Of the {source['n_analysed']} analysed, {lacking} have no quiz score and so no group."
