"""The specification curve (Simonsohn, Simmons & Nelson, 2020): one effect under every reasonable
combination of who is left out, how knowledge is grouped, and which test is made."""

from collections.abc import Callable, Iterator

import numpy as np
import pandas as pd

from analysis.sources.absent import Absent, Refusal, Row, attempt
from analysis.sources.factors import KNOWLEDGE
from analysis.sources.frames import Paired, StudyData, paired
from analysis.sources.samples import left_by
from analysis.stats.anova import THREE_WAY, mixed_anova
from analysis.stats.assumptions import hc3_rows
from analysis.stats.corrections import adjusted
from analysis.stats.groups import grouped
from analysis.stats.mixed import mixed_model
from analysis.stats.robust import permutation_rows
from analysis.stats.sensitivity import continuous_rows
from game.tables.exclusions import ExclusionRules

OUTCOME = "engagement"
CORRECTIONS = {"none": "p_none", "Holm": "p_holm", "Bonferroni": "p_bonf"}
FEWER_PERMUTATIONS = 499


def specification_rows(randomised: StudyData, rules: ExclusionRules) -> list[Row]:
    """p of the three-way effect on engagement (on the first mental state, where a study does not
    ask for it) under every specification.

    A correction is over the mental states. A specification that cannot be had has no p, and
    says why. With one static level there is no such effect, and so there are no rows.
    """
    rows: list[Row] = []
    states = randomised.asked.mental_states
    if not states or len(randomised.crossed.levels) < 2:
        return rows
    outcome = states.index(OUTCOME) if OUTCOME in states else 0
    for sample, study in _samples(randomised, rules):
        for grouping, regrouped in _groupings(study):
            for model, p_of in _models(grouping):
                values = [attempt(p_of, regrouped, state) for state in states]
                ours = adjusted(values)[outcome]
                rows += [
                    {"sample": sample, "groups": grouping, "model": model, "correction": name,
                     "n": len(regrouped.participants), "p": ours[column]}
                    for name, column in CORRECTIONS.items()
                ]  # fmt: skip
    return rows


def _samples(randomised: StudyData, rules: ExclusionRules) -> Iterator[tuple[str, StudyData]]:
    yield "everybody", randomised
    for rule in rules.rule:
        if randomised.has(rule.column):
            yield rule.name, left_by(randomised, rule).study


def _groupings(study: StudyData) -> Iterator[tuple[str, StudyData]]:
    if study.has("knowledge"):
        yield "stated", study
    if study.has("quiz_static"):
        bare = study.without_groups()
        regrouped, clustering = grouped(bare)
        if not isinstance(clustering, Absent):
            yield "k-means", regrouped
        ranks = study.participants["quiz_static"].rank(method="average", pct=True).dropna()
        cuts = np.minimum((ranks * 3).to_numpy(dtype=float), 2.999).astype(int)
        thirds = pd.Series([KNOWLEDGE[cut] for cut in cuts], index=ranks.index, dtype=object)
        yield "thirds", bare.with_groups(thirds)
        yield "score", bare


def _models(grouping: str) -> list[tuple[str, Callable[[StudyData, str], float]]]:
    if grouping == "score":
        return [("ANOVA", _score_p)]
    return [
        ("ANOVA", lambda study, outcome: _anova_p(paired(study, outcome))),
        ("HC3", lambda study, outcome: _hc3_p(paired(study, outcome))),
        ("permutation", lambda study, outcome: _permutation_p(paired(study, outcome))),
        ("mixed model", _mixed_p),
    ]


def _anova_p(pair: Paired) -> float:
    return next(effect.test.p for effect in mixed_anova(pair) if effect.effect == THREE_WAY)


def _hc3_p(pair: Paired) -> float:
    return next(_number(row["p"]) for row in hc3_rows(pair) if row["effect"] == THREE_WAY)


def _permutation_p(pair: Paired) -> float:
    rows = permutation_rows(pair, FEWER_PERMUTATIONS, effects=(THREE_WAY,))
    return _number(rows[0]["p_permutation"])


def _mixed_p(study: StudyData, outcome: str) -> float:
    rows = mixed_model(study, outcome)["anova"]
    if not isinstance(rows, list):
        raise Refusal("the mixed model has no tests of effects")
    return next(_number(row["p"]) for row in rows if row["effect"] == THREE_WAY)


def _score_p(study: StudyData, outcome: str) -> float:
    rows = continuous_rows(study, outcome)
    return next(_number(row["p"]) for row in rows if row["effect"] == "score:complexity:adaptivity")


def _number(value: object) -> float:
    if not isinstance(value, float):
        raise Refusal("the test has no p")
    return value
