"""A results section in the paper's order: every number and figure of its sections 5.3 to 5.5, ours
beside the printed, with ready-made sentences and tables in APA form."""

from collections import defaultdict
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pandas as pd

from analysis.pages.apa_table import ApaTable, Numbered
from analysis.pages.choices import (
    latent_table,
    other_tests,
    prior_table,
    specification_figure,
    survival,
    trimmed_table,
)
from analysis.pages.figures import (
    adaptivity_estimates,
    cells_figure,
    fig7_mental_states,
    fig8_performance,
    fig9_adaptivity,
    first_state,
)
from analysis.pages.preference import preferred_figure, preferred_table, statements_figure
from analysis.pages.published import ANOVA_FILE, POSTHOC_FILE, STUDY_FILE, printed
from analysis.pages.sentences import (
    EFFECT_WORDS,
    alpha_sentence,
    anova_sentence,
    bounded_interval,
    factor,
    gain_sentence,
    interval,
    level_sentence,
    paired_sentence,
    preferred_sentence,
)
from analysis.pages.style import SIMULATED, Captioned
from analysis.pages.traces import all_traces, fig10_traces
from analysis.sources.absent import Absent, Row, attempt
from analysis.sources.factors import COMPLEXITY, KNOWLEDGE
from analysis.sources.frames import StudyData
from analysis.sources.recorded import Recorded
from analysis.stats.apa import DASH, MINUS, bounded, decimal, p_value, share
from analysis.stats.cellmodel import cell_words
from analysis.stats.level import percent
from analysis.stats.preferred import preferred_rows
from analysis.stats.robust import PERMUTATIONS
from analysis.stats.specifications import specification_rows
from game.tables.exclusions import read_rules

Numbers = Mapping[str, Any]


@dataclass(frozen=True)
class Section:
    """A part of the results under its title: sentences (*x* is an italic x), then tables, then
    figures."""

    title: str
    sentences: tuple[str, ...]
    tables: tuple[Numbered, ...]
    figures: tuple[Captioned, ...]


@dataclass(frozen=True)
class Found:
    """What a section is made from: the numbers of the battery, the analysed sample, everybody
    randomised, what was recorded where that is known, and the folder of the printed numbers."""

    numbers: Numbers
    study: StudyData
    randomised: StudyData
    recorded: Recorded | None
    paper: Path

    @property
    def alpha(self) -> float:
        """The level that tests are judged at."""
        level: float = self.numbers["source"]["alpha_level"]
        return level

    def printed(self, quantity: str) -> str:
        """One printed number of the study, as text."""
        table = printed(self.paper, STUDY_FILE)
        return str(table.loc[table["quantity"] == quantity, "value"].iloc[0])

    def effect(self, outcome: str, effect: str) -> Numbers | None:
        """One line of an outcome's ANOVA, or None where there is no ANOVA."""
        rows = self.own(outcome)["anova"]
        return next((row for row in rows or () if row["effect"] == effect), None)

    def own(self, outcome: str) -> Numbers:
        """The numbers of an outcome; all of them are None where the study does not ask for it."""
        numbers: Numbers = self.numbers["outcomes"].get(outcome, defaultdict(lambda: None))
        return numbers


Part = tuple[str, list[str], list[ApaTable], list[Captioned]]


def manuscript(found: Found) -> list[Section]:
    """The sections in the paper's order, their tables numbered through."""
    sections = []
    number = 0
    for make in PARTS:
        title, sentences, tables, figures = make(found)
        if mapping := found.study.crossed.mapping:
            sentences = [f"In this section {mapping}.", *sentences]
        numbered = []
        for table in tables:
            number += 1
            numbered.append(_labelled(table, found.study).numbered(number))
        sections.append(Section(title, tuple(sentences), tuple(numbered), tuple(figures)))
    return sections


def _labelled(table: ApaTable, study: StudyData) -> ApaTable:
    """The table with what a reader must know of all of it in its note."""
    told = [SIMULATED] if study.simulated else []
    told += [study.crossed.mapping] if study.crossed.mapping else []
    note = " ".join([*(f"{one}." for one in told), table.note]).strip()
    return ApaTable(table.name, table.title, table.columns, table.rows, note)


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
                "C1 to C3 are the people of the analysed sample at each static level. The paper "
                "prints neither cuts nor sizes.",
            )
        )
    else:
        sentences.append("The knowledge groups are those that the source states.")
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
    return "Measures (paper, section 5.3)", sentences, tables, []


_ALPHA = "Cronbach's alpha of the four preference items"


def participants(found: Found) -> Part:
    """Who took part and who was left out (section 5.4, paragraph 1)."""
    everybody, kept = found.randomised.participants, found.study.participants

    def count(table: pd.DataFrame, column: str, value: str) -> str:
        if column not in table.columns or not table[column].notna().any():
            return DASH
        return str(int((table[column] == value).sum()))

    left = len(everybody) - len(kept)
    rows = [
        ("Participants randomised", str(len(everybody)), found.printed("participants recruited")),
        ("Adaptive instructor first, randomised", count(everybody, "order", "adaptive_first"),
         found.printed("adaptive first")),
        ("Static instructor first, randomised", count(everybody, "order", "static_first"),
         found.printed("static first")),
        *((f"Static level {level}, randomised", count(everybody, "complexity", level),
           found.printed("participants per static level")) for level in COMPLEXITY),
        ("Left out", str(left), "8"),
        ("Adaptive instructor first, analysed", count(kept, "order", "adaptive_first"),
         found.printed("adaptive first analysed")),
        ("Static instructor first, analysed", count(kept, "order", "static_first"),
         found.printed("static first analysed")),
        ("Participants analysed", str(len(kept)), "100"),
    ]  # fmt: skip
    rule = found.numbers["source"]["exclusion_rule"]
    sentences = [
        f"Data were collected from {len(everybody)} participants, of whom {left or 'none'} "
        f"{'were' if left > 1 else 'was'} left out by the rule “{rule}” (the paper: 8 who "
        "disobeyed more than five times)"
        f", which left {len(kept)} (paper: 100)."
    ]
    table = ApaTable(
        "participants",
        "Participants, here and in the paper",
        ("Quantity", "Here", "Paper"),
        tuple(rows),
        "The paper's 100 analysed and 8 left out follow from its 48 and 52. Everybody randomised "
        "is analysed too, in the last section.",
    )
    return "Participants (section 5.4, paragraph 1)", sentences, [table], []


def mental_states(found: Found) -> Part:
    """Fig. 7 and the comparisons that the paper prints (section 5.4, paragraphs 2 and 3)."""
    lines = printed(found.paper, POSTHOC_FILE)
    lines = lines[lines["round"] == "static"]
    sentences, rows = [], []
    for line in lines.to_dict("records"):
        row = _level_row(found, line["outcome"], line["knowledge"], line["greater"], line["less"])
        if row is None:
            continue
        words = (line["outcome"], line["knowledge"], line["greater"], line["less"])
        sentences.append(level_sentence(*words, row, found.alpha))
        rows.append(
            (line["outcome"], line["knowledge"], f"{line['greater']} > {line['less']}",
             *_contrast_cells(row), _printed_p(line))
        )  # fmt: skip
    head = (
        "*M* difference", f"{percent(1 - found.alpha)} CI", "*t*", "*df*", "*p*", "*p* Holm",
        "*d*", f"*d* {percent(1 - found.alpha)} CI",
    )  # fmt: skip
    note = (
        "*p* is unadjusted; Holm adjusts over the three comparisons of a group. *d* is the "
        "difference over the pooled standard deviation of the "
        f"{cell_words(found.study.crossed.levels)}. The paper does not say whether its *p* is "
        "adjusted."
    )
    every = [
        (state, row["knowledge"], row["contrast"].replace("-", MINUS), *_contrast_cells(row))
        for state in found.study.asked.mental_states
        for row in found.own(state)[_WITHIN] or ()
        if row["adaptivity"] == "static"
    ]
    tables = [
        ApaTable(
            "fig7_printed",
            "Static levels compared within knowledge groups: the comparisons that the paper prints",
            ("Outcome", "Group", "As published", *head, "*p* paper"),
            tuple(rows),
            note + " A dash in the last column: claimed in a caption or in section 5.5 without a "
            "test.",
        ),
        ApaTable(
            "fig7_all",
            "Static levels compared within knowledge groups after the static round",
            ("Outcome", "Group", "Contrast", *head),
            tuple(every),
            note,
        ),
    ]
    figures = _drawn(fig7_mental_states, found.study, found.alpha)
    return "Mental states (section 5.4, paragraphs 2 and 3; Fig. 7)", sentences, tables, figures


_WITHIN = "posthoc_complexity_within_knowledge_by_round"
_GAINS = "posthoc_diff_knowledge_within_complexity"


def _level_row(
    found: Found, outcome: str, knowledge: str, greater: str, less: str
) -> Numbers | None:
    for row in found.own(outcome)[_WITHIN] or ():
        if (row["adaptivity"], row["knowledge"]) == ("static", knowledge):
            if row["contrast"] == f"{greater} - {less}":
                return dict(row)
            if row["contrast"] == f"{less} - {greater}":
                return turned(row)
    return None


def turned(row: Numbers) -> Numbers:
    """The same comparison the other way round."""

    def minus(value: float | None) -> float | None:
        return None if value is None else -value

    return {
        **row,
        "estimate": minus(row["estimate"]),
        "t.ratio": minus(row["t.ratio"]),
        "lower.CL": minus(row["upper.CL"]),
        "upper.CL": minus(row["lower.CL"]),
        "d": minus(row["d"]),
        "d.lower": minus(row["d.upper"]),
        "d.upper": minus(row["d.lower"]),
    }


def _contrast_cells(row: Numbers) -> tuple[str, ...]:
    return (
        decimal(row["estimate"]),
        interval(row["lower.CL"], row["upper.CL"]),
        decimal(row["t.ratio"]),
        str(row["df"]),
        p_value(row["p_none"]),
        p_value(row["p_holm"]),
        decimal(row["d"]),
        interval(row["d.lower"], row["d.upper"]),
    )


def _printed_p(line: Mapping[Any, Any]) -> str:
    if not isinstance(line["p_printed"], str):
        return DASH
    return line["p_printed"] if line["p_relation"] == "=" else f"< {line['p_printed']}"


def performance(found: Found) -> Part:
    """The mixed ANOVAs of section 5.4, paragraph 4, beside the printed ones, and Fig. 8."""
    lines = printed(found.paper, ANOVA_FILE)
    sentences, rows = [], []
    for line in lines.to_dict("records"):
        row = found.effect(line["outcome"], line["effect"])
        if row is None:
            continue
        sentences.append(
            anova_sentence(line["outcome"], row, found.alpha)
            + f" (Paper: Λ = {line['lambda_read']}, *F*({line['df1']}, {line['df2']}) = "
            f"{line['F']}, *p* = {line['p_printed']}{_eta_printed(line)}.)"
        )
        rows.append(
            (line["outcome"], line["effect"], bounded(row["wilks"]), str(line["lambda_read"]),
             f"{row['df1']}, {row['df2']}", f"{line['df1']}, {line['df2']}", decimal(row["F"], 3),
             str(line["F"]), p_value(row["p"]), str(line["p_printed"]), share(row["pes"]),
             bounded_interval(row["pes.lower"], row["pes.upper"], 3),
             line["eta_printed"] if isinstance(line["eta_printed"], str) else DASH)
        )  # fmt: skip
    eta_level = percent(1 - 2 * found.alpha)
    tables = [
        ApaTable(
            "anova_printed",
            "Mixed ANOVAs: the effects that the paper prints",
            ("Outcome", "Effect", "Λ", "Λ paper", "*df*", "*df* paper", "*F*", "*F* paper", "*p*",
             "*p* paper", "Partial *η*²", f"{eta_level} CI", "*η*² paper"),
            tuple(rows),
            "The paper's “Λ = 836” lacks its point.",
        ),
        _anova_table(found),
        _means_table(found),
    ]  # fmt: skip
    figures = [
        *_drawn(fig8_performance, found.study),
        *_drawn(adaptivity_estimates, found.study, found.alpha),
    ]
    title = "Performance and the mixed ANOVAs (section 5.4, paragraph 4; Fig. 8)"
    return title, sentences, tables, figures


def _eta_printed(line: Mapping[Any, Any]) -> str:
    eta = line["eta_printed"]
    return f", partial *η*² = {eta}" if isinstance(eta, str) else ""


def _anova_table(found: Found) -> ApaTable:
    holm = found.numbers["holm_across_mental_states"]
    rows = []
    for outcome in found.study.outcomes:
        for row in (found.own(outcome)["anova"] or ())[1:]:
            across = holm[row["effect"]].get(outcome)
            rows.append(
                (outcome, row["effect"], f"{row['df1']}, {row['df2']}", decimal(row["F"]),
                 p_value(row["p"]), p_value(across), bounded(row["wilks"]), share(row["pes"]),
                 bounded_interval(row["pes.lower"], row["pes.upper"]),
                 share(row["ges_obs_knowledge"]))
            )  # fmt: skip
    return ApaTable(
        "anova_all",
        "Mixed ANOVAs of all outcomes",
        ("Outcome", "Effect", "*df*", "*F*", "*p*", "*p* Holm", "Λ", "Partial *η*²",
         f"{percent(1 - 2 * found.alpha)} CI", "Generalised *η*²"),
        tuple(rows),
        "Type III sums of squares. Holm adjusts over the four mental states, effect by effect. "
        "Generalised *η*² takes knowledge as measured. Λ belongs to within-person effects alone.",
    )  # fmt: skip


def _means_table(found: Found) -> ApaTable:
    rows = []
    for outcome in found.study.outcomes:
        own = found.own(outcome)
        if own["cells"] is None or own["emm"] is None:
            continue
        ends = {
            (row["knowledge"], row["complexity"], row["adaptivity"]): row
            for row in own["emm"]["knowledge_complexity_adaptivity"]
        }
        for cell in own["cells"]:
            mean = ends[cell["knowledge"], cell["complexity"], cell["adaptivity"]]
            rows.append(
                (outcome, cell["knowledge"], cell["complexity"], cell["adaptivity"],
                 str(cell["n"]), decimal(cell["mean"]), decimal(cell["sd"]),
                 interval(mean["lower.CL"], mean["upper.CL"]))
            )  # fmt: skip
    return ApaTable(
        "means",
        "Means of the analysis cells",
        ("Outcome", "Group", "Level", "Round", "*n*", "*M*", "*SD*",
         f"{percent(1 - found.alpha)} CI"),
        tuple(rows),
        "Intervals are of the mean, from the round's pooled error.",
    )  # fmt: skip


def adaptivity(found: Found) -> Part:
    """Fig. 9 with the contrast as the paper words it (section 5.4, paragraph 4)."""
    line = next(
        row
        for row in printed(found.paper, POSTHOC_FILE).to_dict("records")
        if row["round"] != "static"
    )
    sentences, rows = [], []
    gains = found.own("engagement")[_GAINS] or ()
    one, other = line["greater"], line["less"]
    for row in gains:
        level = row["complexity"]
        pair = [f"{group} {level}" for group in row["contrast"].split(" - ")]
        turn = pair == [other, one]
        shown = turned(row) if turn else row
        published = turn or pair == [one, other]
        if published:
            points = found.printed("engagement gain of HIGH C1 over LOW C1")
            sentences.append(
                gain_sentence("engagement", one, other, shown, found.alpha)
                + f" (Paper: {points} points, *p* = {line['p_printed']}.)"
            )
        first, second = (one, other) if turn else pair
        rows.append(
            (f"{first} over {second}", *_contrast_cells(shown),
             points if published else DASH, line["p_printed"] if published else DASH)
        )  # fmt: skip
    ci = f"{percent(1 - found.alpha)} CI"
    table = ApaTable(
        "fig9",
        "Gain in engagement with adaptive instruction, compared between knowledge groups",
        ("Contrast of adaptive − static", "*M* difference", ci, "*t*", "*df*", "*p*", "*p* Holm",
         "*d*", f"*d* {ci}", "Points paper", "*p* paper"),
        tuple(rows),
        "Holm adjusts over the three comparisons at a static level.",
    )  # fmt: skip
    figures = [
        *_drawn(fig9_adaptivity, found.study, first_state(found.study), found.alpha),
        *_drawn(cells_figure, found.study, first_state(found.study), found.alpha),
    ]
    return "Adaptivity (section 5.4, paragraph 4; Fig. 9)", sentences, [table], figures


def levels(found: Found) -> Part:
    """What the adaptive instructor did over time (section 5.4, paragraph 5; Fig. 10)."""
    title = "Levels over time (section 5.4, paragraph 5; Fig. 10)"
    if found.recorded is None:
        return title, ["The source does not record levels over time."], [], []
    from analysis.pages.behaviour import level_rows
    from analysis.pages.mission_rows import missions

    recorded = found.recorded
    figures = [
        *_drawn(fig10_traces, recorded, found.study),
        *_drawn(all_traces, recorded, found.study),
    ]
    shares = attempt(lambda: level_rows(missions(recorded, found.study)))
    if isinstance(shares, Absent):
        return title, [f"There is no table of levels: {shares.reason}."], [], figures
    frame = pd.DataFrame(shares)
    table = ApaTable(
        "fig10",
        "Share of the adaptive missions at each level, and switches a mission",
        tuple(str(column) for column in frame.columns),
        tuple(tuple(str(cell) for cell in row) for row in frame.itertuples(index=False)),
        "Means with 95% bootstrap intervals over people. The paper: LOW mostly at C1; MED and HIGH "
        "mostly at C2, HIGH with more C3 and less C1 than MED.",
    )
    return title, [], [table], figures


def preference(found: Found) -> Part:
    """Preference (sections 5.3 and 5.5: no preference was significant)."""
    sentences = [
        anova_sentence("preference", row, found.alpha)
        for row in (found.own("preference")["anova"] or ())[1:]
    ]
    chosen = attempt(preferred_rows, found.study, found.alpha)
    tables = []
    figures = _drawn(statements_figure, found.study)
    told = found.numbers["preferred_instructor"]
    if told is not None:
        sentences.append(preferred_sentence(told["all"], found.alpha))
        frame = preferred_table(chosen)
        tables.append(
            ApaTable(
                "preferred_instructor",
                "Participants who preferred the adaptive instructor",
                ("Of", "*n*", "Adaptive", "Share", f"{percent(1 - found.alpha)} CI", "*p*",
                 "*p* Holm"),
                tuple(
                    (str(row["of"]), str(row["n"]), str(row["adaptive"]), bounded(row["share"], 2),
                     bounded_interval(row["lower.CL"], row["upper.CL"]), p_value(row["p"]),
                     DASH if pd.isna(row.get("p_holm")) else p_value(row["p_holm"]))
                    for row in frame.to_dict("records")
                ),
                "Exact binomial tests against one half; people who preferred neither are not "
                "counted.",
            )
        )  # fmt: skip
        simulated, second = found.study.simulated, found.study.crossed.words[1]
        figures.append(preferred_figure(chosen, second, simulated=simulated, alpha=found.alpha))
    return "Preference (sections 5.3 and 5.5)", sentences, tables, figures


def robustness(found: Found) -> Part:
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
    more, figures = _checks(found)
    return "Beyond the paper", sentences, [*tables, *more], figures


def _checks(found: Found) -> tuple[list[ApaTable], list[Captioned]]:
    """Tests that assume less, other priors, and the specification curve."""
    study, alpha = found.study, found.alpha
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
            "The three-way effect on engagement over all specifications",
            ("Choice", "Option", "Specifications", f"Share with *p* < {bounded(alpha, 2)}",
             "Greatest *p*"),
            tuple(
                (row["choice"], row["option"], str(row["specifications"]),
                 bounded(row["below alpha"], 2), p_value(row["greatest p"]))
                for row in map(_numbers, survival(specifications, alpha))
            ),
            "Every combination of sample, grouping of knowledge, model, and correction over the "
            "four mental states.",
        ),
    ]  # fmt: skip
    if not specifications:
        return tables, []
    figure = specification_figure(specifications, simulated=study.simulated, alpha=alpha)
    return tables, [figure]


def _numbers(row: Row) -> Numbers:
    return row


PARTS: tuple[Callable[[Found], Part], ...] = (
    measures,
    participants,
    mental_states,
    performance,
    adaptivity,
    levels,
    preference,
    robustness,
)


def _drawn(make: Callable[..., Captioned], *arguments: object) -> list[Captioned]:
    figure = attempt(make, *arguments)
    return [] if isinstance(figure, Absent) else [figure]


def tables_of(sections: Sequence[Section]) -> Iterator[Numbered]:
    """All tables of a report."""
    return (table for section in sections for table in section.tables)


def figures_in(sections: Sequence[Section]) -> Iterator[Captioned]:
    """All figures of a report."""
    return (figure for section in sections for figure in section.figures)
