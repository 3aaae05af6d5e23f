"""Which of the paper's tests a design supports, and why not, in words (paper 5.3, 5.4)."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from typing import Literal, NamedTuple

from game.forms.form import Forms
from game.tables.asked import outcomes_of

PAPER_LEVELS = ("C1", "C2", "C3")
Correction = Literal["none", "bonferroni", "sidak", "holm"]
PRIMARY_OUTCOMES = ("engagement", "victims")
PRIMARY_CORRECTION: Correction = "holm"
"""The primary outcomes of a study whose settings do not say, and the correction over them."""
KNOWLEDGE_GROUPS = 3
LABELLED_LATE = (
    "rooms are labelled after the mission, so the scores that form the knowledge groups also hold "
    "what the mission taught"
)


def labelled_late(round_phases: Sequence[str]) -> bool:
    """Whether the rooms of a round are labelled after its mission."""
    phases = [phase for phase in round_phases if phase in ("label", "mission")]
    return phases == ["mission", "label"]


class PaperTest(NamedTuple):
    """A test of the paper. `lacking` is what a design does not have for it; empty if nothing.
    `cells` is how many cells of knowledge group and static level people must fill for it; 0 where
    there are none."""

    name: str
    lacking: tuple[str, ...]
    cells: int = 0

    @property
    def possible(self) -> bool:
        return not self.lacking

    @property
    def told(self) -> str:
        """What is lacking, to follow the name."""
        return f": {'; '.join(self.lacking)}" if self.lacking else ""


def levels_given(pair: tuple[str, str], levels: Sequence[int]) -> tuple[str, ...]:
    """The static levels that people are given: those of study.toml, or one where no instructor
    takes its level from the design."""
    if "static" in pair:
        return tuple(f"C{level}" for level in levels)
    return (f"C{levels[0]}",) if len(levels) == 1 else ("C2",)


def supported(
    *,
    pair: tuple[str, str],
    levels: Collection[str],
    rounds: int,
    labels: bool,
    preference: bool,
    forms: Forms,
) -> Iterator[PaperTest]:
    """Every test of the paper for a design: `pair` are the instructors as study.toml names them,
    `levels` the static levels, `labels` and `preference` whether rooms are labelled and the
    preferred instructor is asked."""
    asked = outcomes_of(forms)
    one_round = ["there is one round"] if rounds < 2 else []
    no_groups = [] if labels else ["without labelling rooms there are no knowledge groups"]
    missing = [level for level in PAPER_LEVELS if level not in levels]
    fewer = f" (static levels {', '.join(levels)})" if missing and len(levels) > 1 else ""
    no_levels = ["one static level, so no complexity"] if len(levels) < 2 else []
    if "static" not in pair:
        no_levels = ["no instructor takes a static level, so no complexity"]
    no_states = [] if asked.mental_states else ["no item has the role mental_state"]
    no_sum = [] if "preference" in asked.composites else ["forms.toml has no composite preference"]
    if no_levels:
        yield PaperTest("the factor complexity", tuple(no_levels))
    crossed = "knowledge x adaptivity" if no_levels else "knowledge x complexity x adaptivity"
    lacking = (*one_round, *no_groups)
    cells = KNOWLEDGE_GROUPS * max(1, 0 if no_levels else len(levels))
    yield PaperTest(f"{crossed}, mixed ANOVA and post-hoc tests{fewer}", lacking, cells)
    yield PaperTest("the same for mental states", (*lacking, *no_states), cells)
    yield PaperTest("one instructor against the other, paired", tuple(one_round))
    yield PaperTest("Cronbach's alpha of the four preference items", tuple(no_sum))
    yield PaperTest(
        "the preferred instructor, exact binomial test",
        (*one_round, *([] if preference else ["the phase preference is left out"])),
    )
    yield PaperTest("alignment of level and knowledge", (*no_groups, *no_levels), cells)
