"""The whole battery on one source: every number of the paper and of a reviewer's questions."""

import json
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from analysis.report import summary
from analysis.sources.absent import Absent, Leaf, Plain, Refusal, Row, Tree, attempt, plain
from analysis.sources.factors import ADAPTIVITY, ALIGNED, COMPLEXITY
from analysis.sources.frames import Paired, StudyData, both_rounds, paired
from analysis.sources.provenance import Provenance, provenance
from analysis.sources.samples import left_by
from analysis.sources.source import load
from analysis.sources.study_folder import Tick, is_study_folder
from analysis.stats.adaptivity import adaptivity_tests, why_they_differ
from analysis.stats.anova import EFFECTS, Effect, mixed_anova
from analysis.stats.assumptions import assumption_rows, hc3_rows
from analysis.stats.bayes import SEED as BAYES_SEED
from analysis.stats.bayes import bayes_rows, need_bayes
from analysis.stats.cellmodel import contrast_row, weights_of
from analysis.stats.clustering import Clustering
from analysis.stats.composites import composite_rows
from analysis.stats.corrections import PValue, corrected_by_name
from analysis.stats.equivalence import paired_row
from analysis.stats.groups import group_shares, grouped
from analysis.stats.intervals import SEED as BOOTSTRAP_SEED
from analysis.stats.level import ALPHA
from analysis.stats.mixed import mixed_model
from analysis.stats.order_effects import order_rows
from analysis.stats.ordinal import ordinal_rows
from analysis.stats.posthoc import (
    RoundModels,
    adaptivity_marginal,
    cell_rows,
    complexity_within_knowledge_avg,
    complexity_within_knowledge_by_round,
    difference_all_pairs,
    difference_knowledge_within_complexity,
    marginal_means,
    simple_adaptivity_within_cell,
)
from analysis.stats.power import SEED as POWER_SEED
from analysis.stats.power import power_rows
from analysis.stats.preferred import preferred_rows
from analysis.stats.reliability import alpha_rows
from analysis.stats.robust import SEED as PERMUTATION_SEED
from analysis.stats.rounds import rounds_rows
from analysis.stats.sensitivity import continuous_rows, exclusion_rows, other_grouping_rows
from game.journal.records import StudyMode
from game.tables.designs import Correction
from game.tables.exclusions import ExclusionRules, read_rules

WITHOUT_INTERCEPT = EFFECTS[1:]
#: Parts of an outcome that need the analysis cells.
BY_CELL: Mapping[str, Callable[[RoundModels], Tree]] = {
    "cells": cell_rows,
    "emm": marginal_means,
    "posthoc_complexity_within_knowledge_by_round": complexity_within_knowledge_by_round,
    "posthoc_complexity_within_knowledge_avg": complexity_within_knowledge_avg,
    "simple_adaptivity_within_cell": simple_adaptivity_within_cell,
    "posthoc_diff_knowledge_within_complexity": difference_knowledge_within_complexity,
    "posthoc_diff_all36": difference_all_pairs,
    "adaptivity_marginal": adaptivity_marginal,
}


@dataclass(frozen=True)
class BatteryResult:
    """Everything the battery found about one source.

    `study` is the analysed sample with its groups, `randomised` everybody; `results` the numbers,
    JSON-ready; `problems` what stopped a planned analysis, each naming the place; `notes` what a
    reader must know.
    """

    study: StudyData
    randomised: StudyData
    results: dict[str, Plain]
    anovas: Mapping[str, list[Effect] | Absent]
    problems: tuple[str, ...]
    notes: tuple[str, ...]

    @property
    def exit_status(self) -> int:
        """0, or 2 where a planned analysis was stopped."""
        return 2 if self.problems else 0

    def table(self) -> str:
        """The results a reader looks at first, as text for a terminal."""
        return summary(self.study, self.results, self.problems, self.notes)

    def to_json(self) -> str:
        """The results as JSON text; each null's reason stands under `absent`."""
        return json.dumps(self.results, indent=1, allow_nan=False, ensure_ascii=False) + "\n"


def run_battery(
    randomised: StudyData, rules: ExclusionRules, alpha: float = ALPHA
) -> BatteryResult:
    """Run everything on the sample that the primary exclusion rule leaves of all randomised; tests
    are judged at `alpha` and intervals are made for it."""
    rules = rules.known_to(list(randomised.participants.columns))
    sample = left_by(randomised, rules.main())
    study, clustering = grouped(sample.study)
    notes = list(study.notes)
    if not study.has(rules.main().column):
        notes.append(
            f"the source has no column {rules.main().column}: it is taken as the analysed sample"
        )
    pairs = {outcome: attempt(paired, study, outcome) for outcome in study.outcomes}
    anovas = {
        outcome: pair if isinstance(pair, Absent) else attempt(mixed_anova, pair)
        for outcome, pair in pairs.items()
    }
    tests = {
        outcome: pair if isinstance(pair, Absent) else attempt(adaptivity_tests, pair)
        for outcome, pair in pairs.items()
    }
    by_outcome: dict[str, Tree] = {
        outcome: outcome_rows(study, outcome, pairs[outcome], anovas[outcome], alpha)
        | {"adaptivity_tests": tests[outcome]}
        for outcome in study.outcomes
    }
    tree: Row = {
        "source": {
            "label": study.label,
            "simulated": study.simulated,
            "n_randomised": len(randomised.participants),
            "n_analysed": len(study.participants),
            "n_grouped": int(study.participants["knowledge"].notna().sum())
            if study.has("knowledge")
            else Absent("there are no knowledge groups"),
            "exclusion_rule": rules.main().name,
            "alpha_level": alpha,
            "groups": "stated" if sample.study.has("knowledge") else "formed from quiz_static",
            "instructors": dict(zip(ADAPTIVITY, study.crossed.words, strict=True)),
            "static_levels": list(study.crossed.levels),
        },
        "clustering": clustering if isinstance(clustering, Absent) else clustering.row(),
        "alpha": alpha_rows(study, alpha),
        "outcomes": by_outcome,
        "primary": attempt(primary_rows, study, anovas),
        "holm_across_mental_states": holm_across(
            {state: anovas[state] for state in study.asked.mental_states}
        ),
        "preferred_instructor": attempt(preferred_rows, study, alpha),
        "ordinal": ordinal_rows(study),
        "composites": composite_rows(study),
        "order_and_building": order_rows(study, alpha),
        "sensitivity": {
            "exclusions": exclusion_rows(randomised, rules),
            "other_groupings": other_grouping_rows(study, clustering)
            if not isinstance(clustering, Absent) and not sample.study.has("knowledge")
            else Absent("the groups are not formed from quiz scores"),
            "continuous_score": {
                outcome: attempt(continuous_rows, study, outcome) for outcome in study.outcomes
            },
        },
        "power": power_rows(group_shares(study))
        if study.crossed.levels == COMPLEXITY
        else Absent("it is computed for three static levels; `ana study design` has this design's"),
    }
    problems = tuple(stopped(study, clustering, anovas))
    notes += why_they_differ(tests, alpha, study.crossed)
    values, reasons = plain(tree)
    if not isinstance(values, dict):
        raise TypeError("the results are not a mapping")
    results = values | {
        "problems": list(problems),
        "notes": list(notes),
        "absent": _by_reason(reasons),
    }
    return BatteryResult(study, randomised, results, anovas, problems, tuple(notes))


def outcome_rows(
    study: StudyData,
    outcome: str,
    pair: Paired | Absent,
    anova: list[Effect] | Absent,
    alpha: float = ALPHA,
) -> Row:
    """All parts of one outcome; a part that cannot be had is absent with its reason."""
    rows: Row = {
        "anova": anova if isinstance(anova, Absent) else [effect.row(alpha) for effect in anova]
    }
    people = both_rounds(study, outcome)
    if isinstance(pair, Absent):
        rows |= {"n": len(people), "n_dropped": len(study.participants) - len(people)}
        rows |= dict.fromkeys((*BY_CELL, "alignment", "assumptions", "hc3_diff"), pair)
    else:
        models = RoundModels.of(pair, alpha)
        rows |= {"n": len(pair.participants), "n_dropped": pair.n_dropped}
        rows |= {name: make(models) for name, make in BY_CELL.items()}
        rows |= {
            "alignment": attempt(alignment_rows, models),
            "assumptions": assumption_rows(pair),
            "hc3_diff": attempt(hc3_rows, pair),
        }
    return rows | {
        "paired": attempt(paired_row, people, alpha),
        "lmm": attempt(mixed_model, study, outcome),
        "rounds": attempt(rounds_rows, study, outcome),
    }


def alignment_rows(models: RoundModels) -> list[Row]:
    """Aligned (LOW-C1, MED-C2, HIGH-C3, as far as there are these levels) less the other cells, in
    each round and between. Raises Refusal where there is one static level."""
    if len(models.levels) < 2:
        raise Refusal("one static level, so knowledge and level cannot be aligned")
    aligned = [cell for cell in ALIGNED if cell in models.mean.cells]
    others = [cell for cell in models.mean.cells if cell not in ALIGNED]
    weights = weights_of(aligned) - weights_of(others)
    rows: list[Row] = []
    for name, model in (*models.by_round(), ("adaptive - static", models.difference)):
        contrast = model.contrast(weights)
        rows.append(
            {
                "contrast": "aligned - misaligned",
                "of": name,
                **contrast_row(contrast, models.alpha),
                "p.value": contrast.p,
            }
        )
    return rows


def primary_rows(study: StudyData, anovas: Mapping[str, list[Effect] | Absent]) -> dict[str, Tree]:
    """The primary outcomes that the settings fix: p of every effect, and p corrected over them.

    Raises Refusal where no settings are known.
    """
    primary = study.crossed.primary
    if primary is None:
        raise Refusal("no settings of the study are known, so no primary outcomes")
    own = {
        outcome: anovas[outcome] if outcome in anovas else attempt(_anova_of, study, outcome)
        for outcome in primary.outcomes
    }
    plain_p, corrected = across(own, "none"), across(own, primary.correction)
    effects: dict[str, Tree] = {
        effect: {
            outcome: {"p": plain_p[effect][outcome], "p_corrected": p}
            for outcome, p in family.items()
        }
        for effect, family in corrected.items()
        if effect in WITHOUT_INTERCEPT
    }
    return {
        "outcomes": list(primary.outcomes),
        "correction": primary.correction,
        "effects": effects,
    }


def _anova_of(study: StudyData, outcome: str) -> list[Effect]:
    if not study.has(outcome):
        raise Refusal(f"nothing measures {outcome}")
    return mixed_anova(paired(study, outcome))


def holm_across(anovas: Mapping[str, list[Effect] | Absent]) -> dict[str, dict[str, PValue]]:
    """Holm over the outcomes, effect by effect; an outcome without ANOVA does not count."""
    return across(anovas, "holm")


def across(
    anovas: Mapping[str, list[Effect] | Absent], correction: Correction
) -> dict[str, dict[str, PValue]]:
    """p of each effect, corrected over the outcomes; an outcome without ANOVA does not count."""
    by_effect: dict[str, dict[str, PValue]] = {}
    for effect in EFFECTS:
        family: dict[str, PValue] = {
            state: rows if isinstance(rows, Absent) else _p_of(rows, effect)
            for state, rows in anovas.items()
        }
        by_effect[effect] = corrected_by_name(family, correction)
    return by_effect


def _p_of(rows: list[Effect], effect: str) -> PValue:
    found = (row.test.p for row in rows if row.effect == effect)
    return next(found, Absent("the design has one static level"))


def analyse_source(
    source: Path,
    quiz: Path | None = None,
    figures: Path | None = None,
    mode: StudyMode | None = None,
    *,
    columns: Path | None = None,
    report: Path | None = None,
    check: bool = True,
    tick: Tick = lambda _done, _all: None,
    loaded: Callable[[], object] = lambda: None,
    alpha: float = ALPHA,
    bayes: bool = False,
) -> BatteryResult:
    """Read a source as `load` does, run the battery, and write the figures and the report where
    folders are given. `loaded` is called once the source was read, before anything comes of it.
    With `bayes` the results have Bayesian mixed models.

    Raises SourceError or JournalError where the source cannot be read, MissingExtraError where
    `bayes` cannot be had, OSError where a folder cannot be written.
    """
    if bayes:
        need_bayes()
    read = load(source, quiz, mode, columns=columns, check=check, tick=tick)
    loaded()
    rules = read_rules().known_to(list(read.study.participants.columns))
    result = run_battery(read.study, rules, alpha)
    if bayes:
        _add_bayes(result, alpha)
    made = signed(result, source, columns or quiz, mode, verified=check and is_study_folder(source))
    if figures is not None:
        from analysis.pages.figures import write_figures

        write_figures(result.study, figures, alpha, made.line())
    if report is not None:
        from analysis.pages.manuscript import Found, manuscript
        from analysis.pages.published import PUBLISHED
        from analysis.pages.results_page import write_report

        found = Found(result.results, result.study, result.randomised, read.recorded, PUBLISHED)
        write_report(
            manuscript(found),
            result.study,
            [*result.problems, *result.notes],
            made,
            report,
        )
        if is_study_folder(source):
            from analysis.pages.missions_page import missions_html
            from analysis.sources.replays import read_replays

            page = missions_html(read_replays(source, mode), result.study)
            (report / "missions.html").write_text(page, encoding="utf-8")
    return result


def _add_bayes(result: BatteryResult, alpha: float) -> None:
    values, reasons = plain({"bayes": bayes_rows(result.study, alpha)})
    if not isinstance(values, dict):
        raise TypeError("the Bayesian models are not a mapping")
    absent = result.results["absent"]
    result.results.update(values)
    result.results["absent"] = [*(absent if isinstance(absent, list) else []), *_by_reason(reasons)]


def signed(
    result: BatteryResult,
    source: Path,
    beside: Path | None = None,
    mode: StudyMode | None = None,
    *,
    verified: bool,
) -> Provenance:
    """Write into the results where they come from, and return it; `beside` is the file that was
    given with the source."""
    read: Mapping[str, Any] = result.results
    settings: dict[str, Leaf] = {
        "alpha": read["source"]["alpha_level"],
        "exclusion_rule": read["source"]["exclusion_rule"],
        "verified": verified,
    }
    seeds = {"power": POWER_SEED, "bootstrap": BOOTSTRAP_SEED, "permutation": PERMUTATION_SEED}
    if "bayes" in read:
        seeds["bayes"] = BAYES_SEED
    made = provenance(source, beside, mode, settings, seeds)
    result.results["provenance"], _ = plain(made.row())
    return made


def preregister(source: Path, out: Path, alpha: float = ALPHA) -> None:
    """Write the planned analysis of the study in a folder, or of a study.toml, to `out`.

    Raises SourceError where the settings cannot be read, OSError where `out` cannot be written.
    """
    from analysis.pages.preregistration import settings_file, write_preregistration

    path = settings_file(source)
    rules = read_rules()
    if not (path.parent / "forms.toml").is_file():
        rules = rules.known_to(())  # no forms, no attention checks
    settings: dict[str, Leaf] = {"alpha": alpha, "exclusion_rule": rules.main().name}
    made = provenance(path, None, None, settings, {})
    write_preregistration(source, out, rules, alpha, made)


def stopped(
    study: StudyData, clustering: Clustering | Absent, anovas: Mapping[str, list[Effect] | Absent]
) -> list[str]:
    """What stopped a test that the design has; those that it has not are in a note."""
    if not study.crossed.has_anova:
        return []
    problems = []
    if isinstance(clustering, Absent) and study.has("quiz_static"):
        problems.append(f"knowledge groups: {clustering.reason}")
    outcomes_of: dict[str, list[str]] = {}
    for outcome, anova in anovas.items():
        if isinstance(anova, Absent):
            outcomes_of.setdefault(anova.reason, []).append(outcome)
    problems += [
        f"{', '.join(outcomes)}: the ANOVA{'s are' if len(outcomes) > 1 else ' is'} left out: "
        f"{reason}"
        for reason, outcomes in outcomes_of.items()
    ]
    return problems


def _by_reason(reasons: Mapping[str, str]) -> list[Plain]:
    paths: dict[str, list[Plain]] = {}
    for path, reason in reasons.items():
        paths.setdefault(reason, []).append(path)
    return [{"reason": reason, "paths": found} for reason, found in paths.items()]
