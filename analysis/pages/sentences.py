"""Ready-made sentences in APA form, one for each test; *x* stands for an italic x.

Each takes a row of the results as `ana analyse --json` writes it; a null in it becomes a dash.
"""

from collections.abc import Mapping, Sequence
from typing import Any

from analysis.stats.apa import DASH, bounded, decimal, equals, p_value, share
from analysis.stats.level import percent

Numbers = Mapping[str, Any]

EFFECT_WORDS = {
    "knowledge": "main effect of knowledge",
    "complexity": "main effect of static level",
    "knowledge:complexity": "interaction of knowledge and static level",
    "adaptivity": "effect of the adaptivity of instruction",
    "knowledge:adaptivity": "interaction of knowledge and adaptivity",
    "complexity:adaptivity": "interaction of static level and adaptivity",
    "knowledge:complexity:adaptivity": "interaction of knowledge, static level and adaptivity",
}


def interval(low: float | None, high: float | None, level: float | None = None) -> str:
    """ "[0.12, 0.31]", with its level before it if one is given."""
    if low is None or high is None:
        return DASH
    ends = f"[{decimal(low)}, {decimal(high)}]"
    return ends if level is None else f"{percent(level)} CI {ends}"


def bounded_interval(low: float | None, high: float | None, digits: int = 2) -> str:
    """The same for what lies between -1 and 1: "[.04, .26]"."""
    if low is None or high is None:
        return DASH
    return f"[{bounded(low, digits)}, {bounded(high, digits)}]"


def time_words(minutes: float) -> str:
    """A memorise time: "3 min" or "1.5 min", and "20 s" where it is no half of a minute."""
    return f"{minutes:g} min" if minutes * 2 == int(minutes * 2) else f"{minutes * 60:.0f} s"


def degrees(df1: int, df2: float | None) -> str:
    """Degrees of freedom of an F test: "2, 101.4"."""
    return DASH if df2 is None else f"{df1}, {decimal(df2, 1)}"


def p_phrase(p: float | None) -> str:
    """ "*p* = .021" or "*p* < .001"."""
    return f"*p* {equals(p_value(p))}"


def _measure(outcome: str) -> str:
    return "the number of victims rescued" if outcome == "victims" else outcome


def anova_sentence(outcome: str, row: Numbers, alpha: float) -> str:
    """One effect of the mixed ANOVA on one outcome."""
    found = "a significant" if row["p"] < alpha else "no significant"
    wilks = "" if row["wilks"] is None else f"Wilks' Λ = {bounded(row['wilks'])}, "
    ends = bounded_interval(row["pes.lower"], row["pes.upper"])
    return (
        f"There was {found} {EFFECT_WORDS[row['effect']]} on {_measure(outcome)}, {wilks}"
        f"*F*({row['df1']}, {row['df2']}) = {decimal(row['F'])}, {p_phrase(row['p'])}, "
        f"partial *η*² {equals(share(row['pes']))}, {percent(1 - 2 * alpha)} CI {ends}."
    )


def level_sentence(
    state: str, knowledge: str, greater: str, less: str, row: Numbers, alpha: float
) -> str:
    """Two static levels compared within a knowledge group; `row` is greater less less, of two cells
    with people."""
    if not _significant(row, alpha):
        return (
            f"{knowledge}-knowledge participants’ {state} did not differ significantly between "
            f"{greater} and {less} instructions, {_contrast(row, alpha)}."
        )
    way = "higher" if row["estimate"] >= 0 else "lower"
    return (
        f"{knowledge}-knowledge participants reported {way} {state} with {greater} than with "
        f"{less} instructions, {_contrast(row, alpha)}."
    )


def empty_cells_sentence(comparisons: Sequence[tuple[str, str, str, str]]) -> str:
    """What an empty cell leaves out, by (state, group, level, level): each pair of levels once."""
    states: dict[str, list[str]] = {}
    for state, knowledge, *levels in comparisons:
        pair = " and ".join(sorted(levels))
        states.setdefault(f"{knowledge}-knowledge participants at {pair}", []).append(state)
    told = "; ".join(f"{pair} ({', '.join(names)})" for pair, names in states.items())
    return f"Not compared, because one of the two cells is empty: {told}."


def gain_sentence(outcome: str, greater: str, less: str, row: Numbers, alpha: float) -> str:
    """Difference scores of two cells compared, as the paper words it (Fig. 9)."""
    if row["estimate"] is None:
        return f"Gains in {outcome} of {greater} and {less} cannot be compared: a cell is empty."
    if not _significant(row, alpha):
        pair = " and ".join(
            f"({name.split()[0]}-knowledge, {name.split()[1]})" for name in (greater, less)
        )
        return (
            f"The changes in {outcome} that {pair} participants experienced when instructed "
            f"adaptively did not differ significantly, {_contrast(row, alpha)}."
        )
    size = decimal(abs(row["estimate"]))
    way = "greater" if row["estimate"] >= 0 else "smaller"
    one, other = (f"({name.split()[0]}-knowledge, {name.split()[1]})" for name in (greater, less))
    return (
        f"{one} participants experienced a change in {outcome} when instructed adaptively that was "
        f"{way} than that of {other} participants, by {size} points on average, "
        f"{_contrast(row, alpha)}."
    )


def _contrast(row: Numbers, alpha: float) -> str:
    ends = interval(row["lower.CL"], row["upper.CL"], 1 - alpha)
    d_ends = interval(row["d.lower"], row["d.upper"])
    return (
        f"*M* difference = {decimal(row['estimate'])}, {ends}, *t*({row['df']}) = "
        f"{decimal(row['t.ratio'])}, {p_phrase(row['p_none'])} (Holm-adjusted "
        f"{p_phrase(row['p_holm'])}), *d* = {decimal(row['d'])} {d_ends}"
    )


def _significant(row: Numbers, alpha: float) -> bool:
    """Whether the Holm-adjusted p is below alpha."""
    p = row["p_holm"]
    return p is not None and p < alpha


DECIDES = "The Holm-adjusted *p* decides whether a difference is called significant."


def paired_sentence(outcome: str, row: Numbers, alpha: float) -> str:
    """adaptive - static over everybody, with equivalence and the Bayes factor."""
    tost = row["tost_p"]
    equivalent = (
        "Whether they are equivalent cannot be tested."
        if tost is None
        else f"Within half a standard deviation of the static round the two were "
        f"{'equivalent' if tost < alpha else 'not shown to be equivalent'} (two one-sided tests, "
        f"{p_phrase(tost)})"
    )
    bayes = "" if row["bf10_jzs_r0707"] is None else f"; *BF*₁₀ = {factor(row['bf10_jzs_r0707'])}"
    return (
        f"Counting people equally, {_measure(outcome)} differed by "
        f"{decimal(row['mean_diff'])} between adaptive and static instruction, "
        f"{interval(row['lower.CL'], row['upper.CL'], 1 - alpha)}, *t*({row['df']}) = "
        f"{decimal(row['t'])}, {p_phrase(row['p'])}, *d*_z = {decimal(row['dz'])} "
        f"{interval(row['dz.lower'], row['dz.upper'])}. {equivalent}{bayes}."
    )


def factor(value: float) -> str:
    """A Bayes factor, in powers of ten where it is far from 1."""
    return decimal(value) if 0.01 <= value < 1e4 else f"{value:.2e}"


def alpha_sentence(row: Numbers, alpha: float, printed: str) -> str:
    """Cronbach's alpha beside the paper's."""
    if row["listwise"] is None:
        return (
            "Cronbach's *α* of the four preference items cannot be computed: that takes two people "
            "who answered all of them, and not all alike."
        )
    ends = bounded_interval(row["lower"], row["upper"], 3)
    return (
        f"Cronbach's *α* of the four preference items was {bounded(row['listwise'])}, "
        f"{percent(1 - alpha)} CI {ends}, over {row['rows_complete']} complete rounds "
        f"(paper: {printed})."
    )


def preferred_sentence(row: Numbers, alpha: float) -> str:
    """How many preferred the adaptive instructor."""
    ends = bounded_interval(row["lower.CL"], row["upper.CL"])
    return (
        f"Of {row['n']} participants who preferred one instructor, {row['adaptive']} "
        f"({100 * row['share']:.0f}%) preferred the adaptive one, {percent(1 - alpha)} CI {ends}, "
        f"exact binomial {p_phrase(row['p'])}."
    )
