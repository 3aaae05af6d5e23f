"""The primary outcomes that the study's settings fixed, with the correction that they name."""

from analysis.pages.apa_table import ApaTable
from analysis.pages.manuscript.part import Found, Part
from analysis.pages.sentences import EFFECT_WORDS, p_phrase
from analysis.stats.apa import p_value
from analysis.stats.corrections import NAMES

TITLE = "Primary outcomes"


def primary(found: Found) -> Part:
    """Every effect on the primary outcomes, its p corrected over them as the settings say."""
    told = found.numbers["primary"]
    if told is None:
        return Part(TITLE, ["The source states no primary outcomes."], [], [])
    outcomes, name = told["outcomes"], NAMES[told["correction"]]
    cells = [
        (effect, outcome, row["p"], row["p_corrected"])
        for effect, family in told["effects"].items()
        for outcome, row in family.items()
        if row["p"] is not None
    ]
    stated = (
        f"The study's settings fix the primary outcomes, {' and '.join(outcomes)}, and how the "
        f"*p* of each effect is adjusted over them: {name}."
    )
    if not cells:
        return Part(TITLE, [f"{stated} None of them has an ANOVA."], [], [])
    found_significant = [
        f"the {EFFECT_WORDS[effect]} on {outcome} (adjusted {p_phrase(corrected)})"
        for effect, outcome, _, corrected in cells
        if corrected < found.alpha
    ]
    verdict = (
        f"Significant after that: {'; '.join(found_significant)}."
        if found_significant
        else "No effect on them is significant after that."
    )
    table = ApaTable(
        "primary",
        "Effects on the primary outcomes",
        ("Outcome", "Effect", "*p*", f"*p* {name}"),
        tuple(
            (outcome, effect, p_value(p), p_value(corrected))
            for effect, outcome, p, corrected in cells
        ),
        f"From the mixed ANOVAs below, adjusted effect by effect ({name}).",
    )
    return Part(TITLE, [f"{stated} {verdict}"], [table], [])
