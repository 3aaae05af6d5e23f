"""Every round of a study in which an instructor has more than one: the paper has no such study."""

from analysis.pages.apa_table import ApaTable
from analysis.pages.manuscript.part import Found, Part, drawing
from analysis.pages.rounds_figure import every_round
from analysis.pages.sentences import degrees
from analysis.sources.factors import ADAPTIVITY
from analysis.stats.apa import decimal, p_value

TITLE = "Every round"


def rounds(found: Found) -> Part:
    """Means of every round with either instructor, and the mixed models over all of them; nothing
    where no instructor has more than one round."""
    study = found.study
    if study.every_round is None:
        return Part(TITLE, [], [], [])
    words = dict(zip(ADAPTIVITY, study.crossed.words, strict=True))
    told = {outcome: found.own(outcome)["rounds"] for outcome in study.outcomes}
    tables = [
        ApaTable(
            "rounds_means",
            "Means of every round with either instructor",
            ("Outcome", "Round", "Instructor", "*n*", "*M*", "*SD*"),
            tuple(
                (outcome, str(row["round"]), words[row["adaptivity"]], str(row["n"]),
                 decimal(row["mean"]), decimal(row["sd"]))
                for outcome, own in told.items()
                for row in (own or {}).get("means") or ()
            ),
        ),
        ApaTable(
            "rounds_models",
            "Mixed models over all rounds",
            ("Outcome", "Effect", "*F*", "*df*", "*p*", "*F* KR", "*df* KR", "*p* KR"),
            tuple(
                (outcome, row["effect"], decimal(row["F"]), degrees(row["df1"], row["df2"]),
                 p_value(row["p"]), decimal(row["F_kr"]), degrees(row["df1"], row["df2_kr"]),
                 p_value(row["p_kr"]))
                for outcome, own in told.items()
                for row in ((own or {}).get("lmm") or {}).get("anova") or ()
            ),
            "A random intercept for each person; besides the factors of the design, round and "
            "building, where they can be told apart from those. Type III tests; degrees of freedom "
            "are Satterthwaite's, and under KR those of Kenward and Roger.",
        ),
    ]  # fmt: skip
    sentence = (
        "The sections before take each person's first round with either instructor, as the paper's "
        "tests compare two rounds. Here all of them count."
    )
    return Part(TITLE, [sentence], tables, [drawing(every_round, study)])
