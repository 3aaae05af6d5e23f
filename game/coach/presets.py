"""What the paper leaves open about the adaptive cycle, fixed as data.

The rule of Algorithm 1 is the paper's. The likelihood, the prior, the window, when to evaluate,
when a change takes effect and the first level are not in it; a `Preset` fixes them all, and the
journal holds it whole.
"""

from __future__ import annotations

from types import MappingProxyType
from typing import Literal

import msgspec

from game.coach.acts import Level
from game.coach.goals import MAX_BETA, Likelihood


class Preset(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """One complete choice. Raises ValueError, naming the field, for one that makes no sense."""

    name: str
    likelihood: Likelihood
    beta: float = 1.0
    """Rationality in 1 / cells; `released` has none and ignores it."""
    prior: Literal["uniform", "instructed"]
    prior_mass: float | None = None
    """P(instructed goal, or its room) before any move; only for the instructed prior."""
    prior_below_threshold: bool = False
    """Declared: before any move the coach already holds less than `lower_below`, so that standing
    still is read as not understanding. Must be true exactly where it is so; a uniform prior over
    a building full of victims always is."""
    aggregation: Literal["victim", "room"]
    """Whether comprehension is P of the instructed victim, or of all waiting ones in its room."""
    window_moves: int | None = None
    """The last so many moves within the goal; None: all moves since the goal was set."""
    evaluate: Literal["every", "instruction", "step", "goal"]
    """Every `every_ms`; when an instruction is completed or a misstep made; at each move; or when a
    goal is set."""
    every_ms: int | None = None
    minimum_moves: int = 1
    """With fewer moves in the window there is no evaluation."""
    skip_without_evidence: bool = True
    """No evaluation where it tells nothing: one victim waits, all wait in one room, or the leg
    began in the goal's room."""
    certain_in_goal_room: bool = False
    """Comprehension is 1 whenever the rescuer is in the goal's room."""
    rule: Literal["step", "absolute"] = "step"
    """`step`: one level up or down (Algorithm 1). `absolute`: C1 below, C3 above, else C2."""
    highest_only_in_goal_room: bool = False
    """The absolute rule gives C3 only in the goal's room."""
    judges: Literal["path", "belief"] = "path"
    """By what a level is chosen: P(g* | path), or b^HR(the goal's room) as `knowledge` learns it.
    With `belief`, what this says about goal inference is of no use."""
    lower_below: float = 0.3
    raise_above: float = 0.8
    told_way: bool = False
    """Steps that go the way that was told count as nearer to the goals of the room that was told,
    so that only leaving that way speaks against them; needs `cost_difference`, whose factors are
    at most 1."""
    lowers_when_lost: bool = False
    """One level down when the rescuer has not come nearer for too long, or goes astray at C3, where
    to be told the name again is no help."""
    agreement: int = 1
    """So many consecutive evaluations within a goal must agree before the level changes."""
    raise_only_at_goal_end: bool = False
    """Down at any time, up only when the goal ends and nothing went down within it."""
    after_rescue: Literal["keep", "first_level"] = "keep"
    first_level: Level = Level.C2

    def __post_init__(self) -> None:
        _require(0 <= self.beta <= MAX_BETA, "beta", f"must lie between 0 and {MAX_BETA:g}")
        _require(0 < self.lower_below < 1, "lower_below", "must lie between 0 and 1")
        _require(
            self.lower_below < self.raise_above < 1,
            "raise_above",
            "must lie between lower_below and 1",
        )
        if self.prior == "instructed":
            inside = self.prior_mass is not None and 0 < self.prior_mass < 1
            _require(inside, "prior_mass", "must lie between 0 and 1 for an instructed prior")
        else:
            _require(self.prior_mass is None, "prior_mass", "belongs to an instructed prior only")
        _require(
            self.prior_below_threshold is self._starts_below(),
            "prior_below_threshold",
            f"must be {str(self._starts_below()).lower()}: it declares whether the prior starts "
            f"below lower_below",
        )
        moves = self.window_moves
        _require(self.minimum_moves >= 0, "minimum_moves", "must be at least 0")
        _require(
            moves is None or moves >= max(1, self.minimum_moves),
            "window_moves",
            "must be at least 1 and at least minimum_moves",
        )
        if self.evaluate == "every":
            positive = self.every_ms is not None and self.every_ms > 0
            _require(positive, "every_ms", "must be a positive number of milliseconds")
        else:
            _require(self.every_ms is None, "every_ms", "belongs to evaluate = 'every' only")
        instructed = self.likelihood == "cost_difference" and self.prior_mass is not None
        _require(
            not self.told_way or instructed,
            "told_way",
            "needs the likelihood cost_difference and an instructed prior",
        )
        _require(self.agreement >= 1, "agreement", "must be at least 1")
        if self.rule == "absolute":
            _require(not self.raise_only_at_goal_end, "raise_only_at_goal_end", "needs steps")
        else:
            _require(
                not self.highest_only_in_goal_room,
                "highest_only_in_goal_room",
                "needs the absolute rule",
            )

    def _starts_below(self) -> bool:
        return self.prior_mass is None or self.prior_mass < self.lower_below


def _require(condition: bool, field: str, what: str) -> None:
    if not condition:
        raise ValueError(f"preset field {field} {what}")


FLOODFILL = Preset(
    name="floodfill",
    likelihood="cost_difference",
    beta=0.5,
    prior="instructed",
    prior_mass=0.5,
    aggregation="room",
    window_moves=15,
    evaluate="every",
    every_ms=3_000,
    minimum_moves=3,
    told_way=True,
    lowers_when_lost=True,
    raise_only_at_goal_end=True,
)
"""The default. A rescuer who does just as told is never lowered: no step of theirs speaks against
the room that was told, so its probability never falls below its prior mass."""

CALIBRATED = Preset(
    name="calibrated",
    likelihood="boltzmann",
    prior="instructed",
    prior_mass=0.5,
    aggregation="room",
    window_moves=15,
    evaluate="every",
    every_ms=3_000,
    minimum_moves=3,
    raise_only_at_goal_end=True,
)
"""The step-wise likelihood, which counts a step that is one of two shortest as half as likely: a
straight walk through an open room looks like a walk to whatever lies straight ahead. For earlier
journals, and to compare."""

LITERAL = Preset(
    name="literal",
    likelihood="boltzmann",
    prior="uniform",
    prior_below_threshold=True,
    aggregation="victim",
    evaluate="instruction",
    skip_without_evidence=False,
)
"""What the text of the paper says, with as little added as can be: the goals are the victims, none
is preferred (5.2.1), and an interaction ends when an instruction does. Its levels follow the
geometry of the way more than what the rescuer knows."""

FIG10 = Preset(
    name="fig10",
    likelihood="boltzmann",
    prior="instructed",
    prior_mass=0.2,
    prior_below_threshold=True,
    aggregation="room",
    window_moves=15,
    evaluate="every",
    every_ms=5_000,
    minimum_moves=3,
    agreement=2,
)
"""Prior, interval and agreement fitted to the level traces of the paper's Fig. 10, and so never
evidence for them; window and least moves are those of `calibrated`."""

RELEASED = Preset(
    name="released",
    likelihood="released",
    prior="instructed",
    prior_mass=0.8,
    aggregation="victim",
    window_moves=20,
    evaluate="step",
    skip_without_evidence=False,
    certain_in_goal_room=True,
    rule="absolute",
    highest_only_in_goal_room=True,
    after_rescue="first_level",
)
"""As the public code of the original study did it, which differs from its text: the level follows
from P alone at every step, C3 is given only inside the goal's room, and each rescue leads back
to C2. Its floodfill wrote 100 for walls; here walls are infinitely far."""

BELIEF = Preset(
    name="belief",
    judges="belief",
    likelihood="boltzmann",
    prior="uniform",
    prior_below_threshold=True,
    aggregation="room",
    evaluate="goal",
    rule="absolute",
)
"""The paper's thresholds, applied to what the rescuer is held to know of the goal's room, with a
bonus for uncertainty (`game.coach.knowledge.assumed`)."""

PRESETS = MappingProxyType(
    {p.name: p for p in (FLOODFILL, CALIBRATED, LITERAL, FIG10, RELEASED, BELIEF)}
)


def preset(name: str) -> Preset:
    """The preset called `name`. Raises ValueError with the names there are."""
    if name not in PRESETS:
        raise ValueError(f"there is no preset {name!r}; there are {', '.join(PRESETS)}")
    return PRESETS[name]
