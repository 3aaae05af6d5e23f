"""What the paper does not print: equivalence, other weights, samples, tests and models."""

from analysis.pages.apa_table import ApaTable
from analysis.pages.choices import (
    latent_table,
    other_tests,
    prior_table,
    specification_figure,
    survival,
    trimmed_table,
)
from analysis.pages.figures import first_state
from analysis.pages.manuscript.part import Drawing, Found, Numbers, Part, drawing
from analysis.pages.sentences import EFFECT_WORDS, degrees, factor, interval, paired_sentence
from analysis.sources.absent import Absent, Row, attempt
from analysis.stats.apa import DASH, bounded, decimal, p_value, share
from analysis.stats.level import percent
from analysis.stats.robust import PERMUTATIONS
from analysis.stats.specifications import specification_rows
from game.tables.exclusions import read_rules


def beyond(found: Found) -> Part:
    """What the paper does not print: equivalence, other weights, and other samples."""
    numbers, alpha = found.numbers, found.alpha
    sentences, tests, samples = [], [], []
    for outcome in found.study.outcomes:
        own = found.own(outcome)
        if own["paired"] is not None:
            sentences.append(paired_sentence(outcome, own["paired"], alpha))
        tests += [
            (outcome, row["test"], row["counts_equally"], row["error"], decimal(row["estimate"]),
             p_value(row["p"]))
            for row in own["adaptivity_tests"] or ()
        ]  # fmt: skip
    sentences += [f"Note: {note}." for note in numbers["notes"] if note.startswith("tests of ")]
    for rule in numbers["sensitivity"]["exclusions"]:
        for outcome in found.study.outcomes:
            rows = (rule["results"] or {}).get(outcome) or ()
            samples += [
                (rule["rule"], str(rule["n_kept"]), outcome, EFFECT_WORDS[row["effect"]],
                 f"{row['df1']}, {row['df2']}", decimal(row["F"]), p_value(row["p"]),
                 share(row["pes"]))
                for row in rows
                if row["effect"] in ("adaptivity", "knowledge:complexity:adaptivity")
            ]  # fmt: skip
    tables = [
        ApaTable(
            "adaptivity_tests",
            "Three tests of adaptive − static",
            ("Outcome", "Test", "Counts equally", "Error", "*M* difference", "*p*"),
            tuple(tests),
            "The ANOVA's is the planned test. The three differ where cells are of unequal size or "
            "spread.",
        ),
        ApaTable(
            "exclusions",
            "Effects of adaptivity under each exclusion rule and among everybody randomised",
            ("Sample", "*N*", "Outcome", "Effect", "*df*", "*F*", "*p*", "Partial *η*²"),
            tuple(samples),
        ),
    ]
    more, drawings = _checks(found)
    return Part("Beyond the paper", sentences, [*tables, *more], drawings)


def _checks(found: Found) -> tuple[list[ApaTable], list[Drawing]]:
    """Tests that assume less, other priors, and the specification curve."""
    study, alpha, outcome = found.study, found.alpha, first_state(found.study)
    ci = f"{percent(1 - alpha)} CI"
    tests = attempt(other_tests, study)
    tested = [] if isinstance(tests, Absent) else tests.reset_index().to_dict("records")
    priors = prior_table(study)
    specifications = specification_rows(found.randomised, read_rules())
    tables = [
        ApaTable(
            "other_tests",
            "Effects of adaptivity by HC3 and by permutation",
            ("Outcome", "Effect", "*F*", "*F* HC3", "*p* HC3", "*p* permutation"),
            tuple(
                (row["outcome"], row["effect"], decimal(row["F"]), decimal(row["F (HC3)"]),
                 p_value(row["p (HC3)"]), p_value(row["p (permutation)"]))
                for row in tested
            ),
            f"{PERMUTATIONS} permutations of the residuals of the model without the effect.",
        ),
        ApaTable(
            "trimmed",
            "Adaptive − static by 20% trimmed means",
            ("Outcome", "*n*", "Trimmed *M*", ci, "*t*", "*df*", "*p*"),
            tuple(
                (row["outcome"], str(row["n"]), decimal(row["estimate"]),
                 interval(row["lower.CL"], row["upper.CL"]), decimal(row["t"]), str(row["df"]),
                 p_value(row["p"]))
                for row in map(_numbers, trimmed_table(study, alpha))
            ),
            "People count equally.",
        ),
        ApaTable(
            "mixed_models",
            "Mixed models of every answered round",
            ("Outcome", "Effect", "*F*", "*df*", "*p*", "*F* KR", "*df* KR", "*p* KR"),
            tuple(
                (outcome, row["effect"], decimal(row["F"]), degrees(row["df1"], row["df2"]),
                 p_value(row["p"]), decimal(row["F_kr"]), degrees(row["df1"], row["df2_kr"]),
                 p_value(row["p_kr"]))
                for outcome in study.outcomes
                for row in (found.own(outcome)["lmm"] or {}).get("anova") or ()
            ),
            "A random intercept for each person, so that people with one round count too; Type III "
            "tests. Degrees of freedom are Satterthwaite's, and under KR those of Kenward and "
            "Roger, who also widen the errors for what is not known of the variances.",
        ),
        ApaTable(
            "latent",
            "The three-way effect on items as ordered answers, and on rescues out of a fixed "
            "number",
            ("Outcome", "Rounds", "*SD* of people", "χ²", "*df*", "*p*"),
            tuple(
                (row["of"], str(row["n_rows"]), decimal(row["sd_participant"]),
                 decimal(row["chi2"]), str(row["df"]), p_value(row["p"]))
                for row in map(_numbers, latent_table(study))
            ),
            "Cumulative logit models of the items, a binomial logit model of the rescues, each "
            "with "
            "a random intercept; likelihood-ratio tests. *SD* is on the logit scale.",
        ),
        ApaTable(
            "priors",
            "Bayes factors of adaptive − static by the scale of the prior",
            ("Outcome", *(f"*{name[0]}*{name[1:]}" for name in priors.columns)),
            tuple(
                (str(outcome), *(DASH if isinstance(value, Absent) else factor(value)
                                 for value in values))
                for outcome, values in zip(priors.index, priors.to_numpy(), strict=True)
            ),
            "*BF*₁₀, JZS prior; above 1 is evidence for a difference, below 1 for none.",
        ),
        ApaTable(
            "specifications",
            f"The three-way effect on {outcome} over all specifications",
            ("Choice", "Option", "Specifications", f"Share with *p* < {bounded(alpha, 2)}",
             "Greatest *p*"),
            tuple(
                (row["choice"], row["option"], str(row["specifications"]),
                 bounded(row["below alpha"], 2), p_value(row["greatest p"]))
                for row in map(_numbers, survival(specifications, alpha))
            ),
            "Every combination of sample, grouping of knowledge, model, and correction over the "
            "mental states.",
        ),
    ]  # fmt: skip
    if all(isinstance(row["p"], Absent) for row in specifications):
        return tables, []
    shown = drawing(
        specification_figure,
        specifications,
        simulated=study.simulated,
        alpha=alpha,
        outcome=outcome,
    )
    return tables, [shown]


def _numbers(row: Row) -> Numbers:
    return row
