"""The planned analysis of a study as a document, written before there are data."""

import io
import tomllib
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from analysis.pages.apa_table import undated, unmarked, write_runs
from analysis.sources.absent import SourceError
from analysis.sources.provenance import Provenance
from analysis.stats.anova import THREE_WAY
from analysis.stats.apa import bounded
from analysis.stats.corrections import NAMES
from analysis.stats.equivalence import BOUND_SDS, PRIOR_SCALE
from analysis.stats.level import percent
from analysis.stats.power import PUBLISHED_PES, analytic_power
from game.tables.designs import Correction
from game.tables.exclusions import ExclusionRules

BLOCK = 24
KINDS = (".md", ".docx")


@dataclass(frozen=True)
class Part:
    """A part of the document: a heading and its paragraphs; *x* stands for an italic x."""

    heading: str
    paragraphs: tuple[str, ...]


def settings_file(source: Path) -> Path:
    """The study.toml of a study folder, or the file itself. Raises SourceError where there is
    none."""
    path = source / "study.toml" if source.is_dir() else source
    if not path.is_file() or path.suffix != ".toml":
        raise SourceError(
            "there is no study.toml",
            place=str(source),
            hint="Give a study folder, as `ana study new` makes it, or its study.toml",
        )
    return path


def planned(path: Path, rules: ExclusionRules, alpha: float) -> list[Part]:
    """The planned analysis of the study with these settings.

    Raises SourceError where the file cannot be read or lacks a setting.
    """
    try:
        study: dict[str, Any] = tomllib.loads(path.read_text(encoding="utf-8-sig"))
        people = BLOCK * int(study["blocks"])
        primary = study["primary"]
        outcomes = [str(outcome) for outcome in primary["outcomes"]]
        correction: Correction = primary["correction"]
        return [
            _study(study, people),
            _participants(people, rules),
            _measures(),
            _tests(outcomes, correction, alpha),
            _checks(rules, alpha),
            _power(people, alpha),
        ]
    except (OSError, UnicodeDecodeError, tomllib.TOMLDecodeError) as error:
        raise SourceError(f"the settings cannot be read ({error})", place=str(path)) from error
    except (KeyError, TypeError, ValueError) as error:
        raise SourceError(
            f"a setting that the plan needs is missing or wrong: {error}",
            place=str(path),
            hint="`ana study check` says what a study.toml must hold",
        ) from error


def _study(study: dict[str, Any], people: int) -> Part:
    times = " or ".join(f"{int(seconds) / 60:g} min" for seconds in study["memorise_seconds"])
    return Part(
        "Design",
        (
            f"Study: {study['name']}. A mixed design: knowledge (LOW, MED, HIGH; measured) and "
            "static "
            "level (C1, C2, C3; randomised) between people, adaptivity of instruction (static, "
            "adaptive) within people, in two rounds of a guided search-and-rescue mission.",
            f"Counterbalanced: memorise time ({times}), order of the two instructors, static level "
            f"and the first building ({', '.join(map(str, study['buildings']))}), dealt in seeded "
            f"permuted blocks of {BLOCK} (seed {study['seed']}), concealed while recruiting.",
            f"The adaptive instructor is “{study['coach']}”, preset “{study['preset']}”.",
            f"Planned are {people} participants.",
        ),
    )


def _participants(people: int, rules: ExclusionRules) -> Part:
    rule = rules.main()
    return Part(
        "Who is analysed",
        (
            f"Of the {people} randomised, those are left out who meet the rule “{rule.name}”: "
            f"{rule.words} Nobody else is left out. Everybody randomised is analysed too, and the "
            "exclusions are shown by design cell, because the rule depends on the treatment.",
            "People who miss a round of an outcome are left out of its ANOVA; the mixed model "
            "keeps "
            "their other round. Missing answers are never replaced.",
        ),
    )


def _measures() -> Part:
    return Part(
        "Measures",
        (
            "Knowledge groups are formed from the room-labelling score before the static mission, "
            "on "
            "the analysed sample, by optimal one-dimensional k-means with three groups. A tie goes "
            "to "
            "the lowest cuts, and the other groupings are reported.",
            "Performance is the number of victims rescued. Engagement, confidence, frustration and "
            "confusion are answers from 1 to 100 after each mission. Preference is the sum of four "
            "five-point items after each mission; its Cronbach's *α* is reported with its "
            "interval.",
        ),
    )


def _tests(outcomes: Sequence[str], correction: Correction, alpha: float) -> Part:
    first = (
        f"The primary outcomes are {' and '.join(outcomes)}; each effect's p-values are adjusted "
        f"over them ({NAMES[correction]})."
    )
    return Part(
        "Planned tests",
        (
            f"{first} Tests are two-sided at *α* = {bounded(alpha, 2)}; intervals have "
            f"{percent(1 - alpha)}, those of partial *η*² {percent(1 - 2 * alpha)}.",
            "Each outcome: a knowledge × static level × adaptivity mixed ANOVA, Type III with "
            "sum-to-zero contrasts, with Wilks' Λ, partial and generalised *η*². The effect of "
            "adaptivity counts the nine cells of knowledge and level equally.",
            "After the static round: the three static levels are compared within each knowledge "
            "group, "
            "with the round's pooled error (Fig. 7 of the paper).",
            "Difference scores adaptive − static: knowledge groups are compared within each static "
            "level; the planned contrast is HIGH over LOW at C1 on engagement (Fig. 9).",
            "Inside each family of three comparisons, and over the four mental states, p-values "
            "are adjusted by Holm; unadjusted ones are reported too.",
            "No effect of adaptivity is claimed only if two one-sided tests show equivalence "
            "within "
            f"{BOUND_SDS:g} standard deviations of the static round; a Bayes factor (JZS, scale "
            f"{PRIOR_SCALE:.3f}) is reported beside them.",
            "The preferred instructor: exact binomial tests against one half, overall and by "
            "order, "
            "level and group.",
        ),
    )


def _checks(rules: ExclusionRules, alpha: float) -> Part:
    names = ", ".join(f"“{rule.name}”" for rule in rules.rule)
    return Part(
        "Checks of robustness",
        (
            f"The ANOVAs among everybody randomised and under each exclusion rule ({names}); with "
            "HC3 "
            "errors; by permutation; by 20% trimmed means; by a mixed model with a random "
            "intercept; "
            "with the score itself in place of the groups; the items as ordered answers; effects "
            "of "
            "round, order and building; Bayes factors for other priors.",
            "A specification curve of the three-way effect on engagement over all combinations of "
            "sample, grouping, model and correction.",
            "None of these replaces a planned test.",
        ),
    )


def _power(people: int, alpha: float) -> Part:
    told = "; ".join(
        f"{bounded(analytic_power(THREE_WAY, pes, people, alpha), 2)} for a partial *η*² of "
        f"{bounded(pes)}"
        for pes in PUBLISHED_PES
    )
    return Part(
        "Power",
        (
            f"With {people} people in equal cells, the power for the three-way effect on "
            "engagement "
            f"is {told} (as the paper prints it, and corrected for the bias of a sample).",
        ),
    )


TITLE = "Planned analysis"


def markdown(parts: Sequence[Part], made: Provenance) -> str:
    """The document as Markdown."""
    text = "\n\n".join(f"## {part.heading}\n\n" + "\n\n".join(part.paragraphs) for part in parts)
    return f"# {TITLE}\n\n{text}\n\n## Where this comes from\n\n{made.line()}; {made.date}.\n"


def document(parts: Sequence[Part], made: Provenance) -> bytes:
    """The document for word processors."""
    import docx

    written: Any = docx.Document()
    written.core_properties.author = ""
    written.core_properties.title = TITLE
    written.add_heading(TITLE, 0)
    for part in parts:
        written.add_heading(part.heading, 1)
        for paragraph in part.paragraphs:
            write_runs(written.add_paragraph(), paragraph)
    written.add_heading("Where this comes from", 1)
    written.add_paragraph(unmarked(f"{made.line()}; {made.date}."))
    packed = io.BytesIO()
    written.save(packed)
    return undated(packed.getvalue())


def write_preregistration(
    source: Path, out: Path, rules: ExclusionRules, alpha: float, made: Provenance
) -> None:
    """Write the planned analysis of a study to a .md or .docx file.

    Raises SourceError for another ending, and as `planned` does.
    """
    if out.suffix not in KINDS:
        raise SourceError(f"a planned analysis is written as {' or '.join(KINDS)}", place=str(out))
    parts = planned(settings_file(source), rules, alpha)
    if out.suffix == ".md":
        out.write_text(markdown(parts, made), encoding="utf-8")
    else:
        out.write_bytes(document(parts, made))
