"""Do the results hang on who is left out, or on cutting knowledge into groups?"""

from itertools import product

import numpy as np
import pandas as pd

from analysis.sources.absent import Absent, Refusal, Row, Tree, attempt
from analysis.sources.factors import KNOWLEDGE
from analysis.sources.frames import Floats, StudyData, both_rounds, paired
from analysis.sources.samples import Sample, left_by
from analysis.stats.anova import mixed_anova
from analysis.stats.cellmodel import CELLS
from analysis.stats.clustering import Clustering, cut_at
from analysis.stats.groups import grouped
from analysis.stats.linear import added_columns
from game.tables.exclusions import ExclusionRules

FACTORS = ("memorise_minutes", "order", "complexity")


def exclusion_rows(study: StudyData, rules: ExclusionRules) -> list[Row]:
    """The ANOVA of every outcome among all randomised and under each rule.

    `study` is everybody randomised. Groups that the source does not state are formed again on each
    sample.
    """
    samples = [left_by(study, None)]
    rows = [_sample_row("all_randomised", "Everybody randomised.", samples[0], study)]
    for rule in rules.rule:
        if study.has(rule.column):
            rows.append(_sample_row(rule.name, rule.words, left_by(study, rule), study))
        else:
            rows.append(
                {
                    "rule": rule.name,
                    "words": rule.words,
                    "results": Absent(f"the source has no column {rule.column}"),
                }
            )
    return rows


def _sample_row(name: str, words: str, sample: Sample, everybody: StudyData) -> Row:
    kept, _ = grouped(sample.study)
    return {
        "rule": name,
        "words": words,
        "n_kept": len(kept.participants),
        "n_excluded": len(sample.excluded),
        "by_design_cell": by_design_cell(everybody, sample.excluded),
        "results": {outcome: _short_anova(kept, outcome) for outcome in kept.outcomes},
    }


def by_design_cell(study: StudyData, excluded: tuple[str, ...]) -> list[Row]:
    """Randomised and excluded in each combination of the allocated factors that are known."""
    people = study.participants
    factors = [name for name in FACTORS if study.has(name)]
    levels: list[list[str | float]] = [
        sorted(people[name].dropna().unique().tolist()) for name in factors
    ]
    gone = people.index.isin(excluded)
    rows: list[Row] = []
    for combination in product(*levels):
        inside = np.ones(len(people), dtype=bool)
        for name, level in zip(factors, combination, strict=True):
            inside &= (people[name] == level).to_numpy()
        where: Row = {
            name: level if isinstance(level, str) else float(level)
            for name, level in zip(factors, combination, strict=True)
        }
        rows.append(
            {**where, "randomised": int(inside.sum()), "excluded": int((inside & gone).sum())}
        )
    return rows


def other_grouping_rows(study: StudyData, clustering: Clustering) -> list[Row]:
    """The ANOVA of every outcome under each other grouping that fits the scores as well."""
    scores = {
        str(who): float(score) for who, score in study.participants["quiz_static"].dropna().items()
    }
    rows: list[Row] = []
    for max_low, max_med in clustering.tied:
        labels = cut_at(scores, max_low, max_med)
        regrouped = study.with_groups(pd.Series(labels, dtype=object))
        members = list(labels.values())
        rows.append(
            {
                "max_low": max_low,
                "max_med": max_med,
                "sizes": {group: members.count(group) for group in KNOWLEDGE},
                "results": {
                    outcome: _short_anova(regrouped, outcome) for outcome in regrouped.outcomes
                },
            }
        )
    return rows


def _short_anova(study: StudyData, outcome: str) -> Tree:
    def rows() -> list[Row]:
        return [
            {
                "effect": effect.effect,
                "df1": effect.test.df1,
                "df2": effect.test.df2,
                "F": effect.test.F,
                "p": effect.test.p,
                "pes": effect.test.pes,
            }
            for effect in mixed_anova(paired(study, outcome))
        ]

    return attempt(rows)


def continuous_rows(study: StudyData, outcome: str) -> list[Row]:
    """Type III tests with the quiz score itself, standardised, in place of the groups.

    Effects are taken at the mean score. Raises Refusal without scores, or where they do not vary.
    """
    if not study.has("quiz_static"):
        raise Refusal("the source has no quiz scores")
    people = study.participants.dropna(subset=["quiz_static"])
    rounds = both_rounds(study, outcome)
    people = people.loc[people.index.intersection(rounds.index)]
    rounds = rounds.loc[people.index]
    scores = people["quiz_static"].to_numpy(dtype=float)
    if len(scores) < len(CELLS) or np.ptp(scores) == 0:
        raise Refusal("too few people with both rounds and a score, or scores that do not vary")
    terms = _score_terms(
        (scores - scores.mean()) / scores.std(ddof=1), people["complexity"], study.crossed.levels
    )
    static, adaptive = (rounds[name].to_numpy(dtype=float) for name in ("static", "adaptive"))
    variables = {"": (adaptive + static) / 2**0.5, "adaptivity": (adaptive - static) / 2**0.5}
    rows: list[Row] = []
    for suffix, y in variables.items():
        for name, columns in terms.items():
            others = [part for other, part in terms.items() if other != name]
            test = added_columns(y, np.column_stack(others), columns)
            effect = ":".join(filter(None, ("" if name == "(Intercept)" else name, suffix)))
            rows.append(
                {
                    "effect": effect or name,
                    "df1": test.df1,
                    "df2": test.df2,
                    "F": test.F,
                    "p": test.p,
                    "pes": test.pes,
                }
            )
    return rows


def _score_terms(
    score: Floats, complexity: pd.Series, levels: tuple[str, ...]
) -> dict[str, Floats]:
    last = (complexity == levels[-1]).to_numpy(dtype=float)
    main: dict[str, Floats] = {"(Intercept)": np.ones((len(score), 1)), "score": score[:, None]}
    if len(levels) < 2:
        return main
    level: Floats = np.column_stack(
        [(complexity == name).to_numpy(dtype=float) - last for name in levels[:-1]]
    )
    return {
        **main,
        "complexity": level,
        "score:complexity": score[:, None] * level,
    }
