"""The battery's results as text for a terminal."""

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from analysis.sources.absent import Plain
from analysis.sources.designs import Crossed
from analysis.sources.factors import ADAPTIVITY
from analysis.sources.frames import StudyData
from analysis.stats.apa import bounded, p_value


def summary(
    study: StudyData, results: Mapping[str, Plain], problems: Sequence[str], notes: Sequence[str]
) -> str:
    """Sample, groups, alpha, the ANOVAs and the significant comparisons, then problems and notes.

    `results` are the battery's JSON-ready results.
    """
    numbers: Mapping[str, Any] = results
    source = numbers["source"]
    first, second = study.crossed.words
    lines = [
        f"{study.label}: {source['n_analysed']} analysed of {source['n_randomised']} participants"
        + (" - SIMULATED PEOPLE" if study.simulated else ""),
        _groups(source, numbers["clustering"]),
        f"compared: {second} with {first}{_levels(study.crossed)}",
        *_alphas(numbers["composites"]),
        "",
    ]
    for outcome, rows in numbers["outcomes"].items():
        lines += [
            *_outcome(outcome, rows, numbers, study.crossed),
            "",
        ]
    lines += [f"problem: {problem}" for problem in problems]
    lines += [f"note: {note}" for note in notes]
    return "\n".join(lines).rstrip() + "\n"


def _groups(source: Mapping[str, Any], clustering: Mapping[str, Any] | None) -> str:
    if source["n_grouped"] is None:
        return "knowledge groups: none, neither stated nor formed from quiz scores"
    without = source["n_analysed"] - source["n_grouped"]
    lacking = f"; {without} of the analysed without one" if without else ""
    return f"knowledge groups: {source['groups']}{_sizes(clustering)}{lacking}"


def _sizes(clustering: Mapping[str, Any] | None) -> str:
    if clustering is None:
        return ""
    low, high = clustering["boundaries"]
    sizes = ", ".join(f"{group} {size}" for group, size in clustering["sizes"].items())
    return f"; by the scores {sizes}, cut at {low:g} and {high:g}"


def _levels(crossed: Crossed) -> str:
    return f"; static levels {', '.join(crossed.levels)}" if len(crossed.levels) > 1 else ""


def _alphas(composites: Mapping[str, Any]) -> Iterator[str]:
    """Cronbach's alpha of every composite."""
    for name, row in composites.items():
        items = len(row["items"])
        yield f"Cronbach's alpha of {name} ({items} items): {_number(row['alpha'])}"


def _outcome(
    outcome: str, rows: Mapping[str, Any], numbers: Mapping[str, Any], crossed: Crossed
) -> list[str]:
    holm = numbers["holm_across_mental_states"]
    lines = [f"{outcome}  (n = {rows['n']}, {rows['n_dropped']} without both rounds or a group)"]
    if rows["anova"] is None:
        lines.append("  no ANOVA; the reason stands below")
    else:
        lines.append(
            f"  {'effect':<33}{'df':>6}{'F':>9}{'p':>7}{'p Holm':>8}{'eta_p':>7}{'eta_g':>7}"
        )
        lines += [_anova_line(outcome, row, holm) for row in rows["anova"][1:]]
    lines += _comparisons(rows, numbers["source"]["alpha_level"], crossed)
    if rows["rounds"] is not None:
        lines += _all_rounds(rows["rounds"], crossed)
    if rows["paired"] is not None:
        paired = rows["paired"]
        lines.append(
            f"  {crossed.gap}: {paired['mean_diff']:+.2f} (d_z {paired['dz']:+.2f}), TOST p "
            f"{p_value(paired['tost_p'])}, BF10 {_number(paired['bf10_jzs_r0707'])}"
        )
    return lines


def _anova_line(outcome: str, row: Mapping[str, Any], holm: Mapping[str, Any]) -> str:
    df = f"{row['df1']}, {row['df2']}"
    corrected = p_value(holm[row["effect"]][outcome]) if outcome in holm[row["effect"]] else ""
    return (
        f"  {row['effect']:<32}{df:>7}{row['F']:>9.3f}{p_value(row['p']):>7}{corrected:>8}"
        f"{bounded(row['pes']):>7}{bounded(row['ges_obs_knowledge']):>7}"
    )


def _comparisons(rows: Mapping[str, Any], alpha: float, crossed: Crossed) -> list[str]:
    """Comparisons of the paper's Figs. 7 and 9 that stay below alpha after Holm."""
    words = dict(zip(ADAPTIVITY, crossed.words, strict=True))
    within = [
        (f"{row['knowledge']}, {words[row['adaptivity']]}", row)
        for row in rows["posthoc_complexity_within_knowledge_by_round"] or ()
    ]
    between = [
        (f"{crossed.gap}{_at(row, crossed)}", row)
        for row in rows["posthoc_diff_knowledge_within_complexity"] or ()
    ]
    return [
        f"  {where}: {row['contrast']} = {row['estimate']:+.2f}, p Holm {p_value(row['p_holm'])}"
        for where, row in (*within, *between)
        if row["p_holm"] is not None and row["p_holm"] < alpha
    ]


def _all_rounds(rows: Mapping[str, Any], crossed: Crossed) -> list[str]:
    """The means of every round, and what the mixed model over all of them finds."""
    words = dict(zip(ADAPTIVITY, crossed.words, strict=True))
    means = ", ".join(
        f"{row['round']} {words[row['adaptivity']]} {row['mean']:.2f} (n = {row['n']})"
        for row in rows["means"]
    )
    lines = [f"  every round: {means}"]
    if rows["lmm"] is None:
        return lines
    tests = ", ".join(
        f"{row['effect']} F({row['df1']}, {row['df2']:.1f}) = {row['F']:.2f}, p {p_value(row['p'])}"
        for row in rows["lmm"]["anova"]
        if row["effect"] in ("adaptivity", "round", "building")
    )
    return [*lines, f"  mixed model over all rounds: {tests}"]


def _at(row: Mapping[str, Any], crossed: Crossed) -> str:
    return f" at {row['complexity']}" if len(crossed.levels) > 1 else ""


def _number(value: float | None) -> str:
    return "-" if value is None else f"{value:.3g}"
