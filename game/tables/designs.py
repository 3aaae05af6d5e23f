"""Which of the paper's tests a design supports, and why not, in words (paper 5.3, 5.4)."""

from __future__ import annotations

from collections.abc import Collection, Iterator
from typing import NamedTuple

from game.forms.form import Forms
from game.tables.asked import outcomes_of

PAPER_LEVELS = ("C1", "C2", "C3")


class PaperTest(NamedTuple):
    """A test of the paper. `lacking` is what a design does not have for it; empty if nothing."""

    name: str
    lacking: tuple[str, ...]

    @property
    def possible(self) -> bool:
        return not self.lacking

    @property
    def told(self) -> str:
        """What is lacking, to follow the name."""
        return f": {'; '.join(self.lacking)}" if self.lacking else ""


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
    static = any(name.partition(":")[0] == "static" for name in pair)
    missing = [level for level in PAPER_LEVELS if level not in levels]
    no_levels = [f"no static level {', '.join(missing)}"] if static and missing else []
    if not static:
        no_levels = ["no static instructor, so no complexity"]
    no_states = [] if asked.mental_states else ["no item has the role mental_state"]
    no_sum = [] if "preference" in asked.composites else ["forms.toml has no composite preference"]
    yield PaperTest(
        "knowledge x complexity x adaptivity, mixed ANOVA and post-hoc tests",
        (*one_round, *no_groups, *no_levels),
    )
    yield PaperTest("the same for mental states", (*one_round, *no_groups, *no_levels, *no_states))
    yield PaperTest("one instructor against the other, paired", tuple(one_round))
    yield PaperTest("Cronbach's alpha of the four preference items", tuple(no_sum))
    yield PaperTest(
        "the preferred instructor, exact binomial test",
        (*one_round, *([] if preference else ["the phase preference is left out"])),
    )
    yield PaperTest("alignment of level and knowledge", (*no_groups, *no_levels))
