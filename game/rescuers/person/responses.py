"""How a simulated person answers: a stated model, driven by what happened to that person.

For each item the meaning is a weighted sum of what the mission was like, plus the person's mood,
plus a leaning of the person towards that item, plus noise; then it is rounded as this person rounds
and cut to the scale. The weights are judgements in the direction of the paper's sections 5.4 and
5.5: what is too hard for one's knowledge confuses, frustrates and disengages; what is too easy
bores. Answers made by this model are evidence about software and design, never about people.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal

from game.rescuers.person.experience import Experience, Style
from game.rescuers.person.parameters import Population, Traits
from game.rescuers.person.randomness import clipped, normal, stream

DEMAND: dict[Style, float] = {1: 0.2, 2: 0.55, 3: 0.9}
"""The knowledge at which each way of talking is right: LOW for C1, MED for C2, HIGH for C3."""

SLIDER_RANGE = 1, 100
LIKERT_RANGE = 1, 5
_MINUTE_MS = 60_000
_LEANING = 6.0
_MOOD = 7.0
_POINTS_A_STEP = 20.0
"""Points of 1 to 100 that make one step of a five-point scale."""


@dataclass(frozen=True)
class Strain:
    """What a mission was like, in five numbers.

    `overload` and `underload` are time-weighted distances between the knowledge that the
    instructor's way of talking asks for and the person's own, by their sign; `hindered` is the
    share of time lost; the others are counts a minute.
    """

    overload: float
    underload: float
    hindered: float
    corrections: float
    switches: float


def strain_of(experience: Experience) -> Strain:
    """Sum a mission up."""
    talked_ms = max(1, sum(experience.style_ms.values()))
    gaps = {style: demand - experience.knowledge for style, demand in DEMAND.items()}
    shares = {style: ms / talked_ms for style, ms in experience.style_ms.items()}
    total_ms = max(1, experience.total_ms)
    minutes = total_ms / _MINUTE_MS
    return Strain(
        overload=sum(shares[style] * max(0.0, gap) for style, gap in gaps.items()),
        underload=sum(shares[style] * max(0.0, -gap) for style, gap in gaps.items()),
        hindered=(experience.searching_ms + experience.puzzled_ms) / total_ms,
        corrections=experience.corrections / minutes,
        switches=experience.switches / minutes,
    )


@dataclass(frozen=True)
class Weights:
    """What one item's meaning depends on, in points of 1 to 100. `valence` is the sign of mood."""

    middle: float
    valence: int
    overload: float
    underload: float
    hindered: float
    corrections: float
    switches: float


WEIGHTS: Mapping[str, Weights] = {
    "engagement": Weights(62, 1, -35, -45, -10, 0, -0.5),
    "confidence": Weights(65, 1, -35, -5, -20, -2, -0.5),
    "frustration": Weights(28, -1, 30, 15, 30, 2, 1),
    "confusion": Weights(26, -1, 35, 0, 30, 2, 1.5),
    "pref1": Weights(55, 1, -45, 0, -20, -1, -1),
    "pref2": Weights(55, 1, -30, -20, -15, 0, -0.5),
    "pref3": Weights(52, 1, -40, -40, -10, -1, -0.5),
    "pref4": Weights(52, 1, -25, -25, -15, 0, 0),
}
"""By the identifiers of items.toml. An item that is not here is answered by mood alone."""

_BY_MOOD = Weights(50, 1, 0, 0, 0, 0, 0)


class Respondent:
    """Answers questionnaires for one person. `seed` names the person."""

    def __init__(self, population: Population, traits: Traits, *seed: object) -> None:
        self._population = population
        self._traits = traits
        self._seed = seed

    def slider(self, item: str, round_: int, experience: Experience) -> int:
        """An answer from 1 to 100, rounded as this person rounds."""
        meant = self._meant(item, experience) + self._noise(item, round_)
        coarse = self._traits.coarseness
        grain = 1 if coarse < 1 / 3 else 5 if coarse < 2 / 3 else 10
        low, high = SLIDER_RANGE
        return round(clipped(grain * round(meant / grain), low, high))

    def likert(self, item: str, round_: int, experience: Experience) -> int:
        """An answer from 1 to 5."""
        meant = self._meant(item, experience) + self._noise(item, round_)
        low, high = LIKERT_RANGE
        return round(clipped((low + high) / 2 + (meant - 50) / _POINTS_A_STEP, low, high))

    def preferred(self, first: Experience, second: Experience) -> Literal[1, 2]:
        """The round, 1 or 2, whose instructor was liked better on the whole."""
        liked = [
            sum(self._meant(item, experience) for item in ("pref1", "pref2", "pref3", "pref4")) / 4
            + self._noise("preferred", round_)
            for round_, experience in ((1, first), (2, second))
        ]
        return 1 if liked[0] > liked[1] else 2

    def _meant(self, item: str, experience: Experience) -> float:
        weights = WEIGHTS.get(item, _BY_MOOD)
        strain = strain_of(experience)
        caused = (
            weights.overload * strain.overload
            + weights.underload * strain.underload
            + weights.hindered * strain.hindered
            + weights.corrections * strain.corrections
            + weights.switches * strain.switches
        )
        leaning = _LEANING * normal(stream(*self._seed, "leaning", item))
        mood = weights.valence * _MOOD * self._traits.mood
        return weights.middle + mood + leaning + self._population.effect * caused

    def _noise(self, item: str, round_: int) -> float:
        return self._population.noise * normal(stream(*self._seed, "noise", item, round_))
