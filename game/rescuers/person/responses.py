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

from game.forms.items import Weights
from game.rescuers.person.experience import Experience, Style
from game.rescuers.person.parameters import Population, Traits
from game.rescuers.person.randomness import clipped, normal, stream

DEMAND: dict[Style, float] = {1: 0.2, 2: 0.55, 3: 0.9}
"""The knowledge at which each way of talking is right: LOW for C1, MED for C2, HIGH for C3."""

SLIDER_RANGE = 1, 100
_MINUTE_MS = 60_000
_LEANING = 6.0
_MOOD = 7.0
_POINTS = 100.0
"""What a step of a scale is worth: these, parted among its points."""


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


WEIGHTS: Mapping[str, Weights] = {
    "engagement": Weights(
        middle=62, valence=1, overload=-35, underload=-45, hindered=-10, switches=-0.5
    ),
    "confidence": Weights(
        middle=65,
        valence=1,
        overload=-35,
        underload=-5,
        hindered=-20,
        corrections=-2,
        switches=-0.5,
    ),
    "frustration": Weights(
        middle=28, valence=-1, overload=30, underload=15, hindered=30, corrections=2, switches=1
    ),
    "confusion": Weights(
        middle=26, valence=-1, overload=35, hindered=30, corrections=2, switches=1.5
    ),
    "pref1": Weights(middle=55, valence=1, overload=-45, hindered=-20, corrections=-1, switches=-1),
    "pref2": Weights(
        middle=55, valence=1, overload=-30, underload=-20, hindered=-15, switches=-0.5
    ),
    "pref3": Weights(
        middle=52,
        valence=1,
        overload=-40,
        underload=-40,
        hindered=-10,
        corrections=-1,
        switches=-0.5,
    ),
    "pref4": Weights(middle=52, valence=1, overload=-25, underload=-25, hindered=-15),
}
"""By the identifiers of items; forms.toml may give others. An item without is answered by mood
alone."""

_BY_MOOD = Weights()


class Respondent:
    """Answers questionnaires for one person. `seed` names the person."""

    def __init__(self, population: Population, traits: Traits, *seed: object) -> None:
        self._population = population
        self._traits = traits
        self._seed = seed

    def slider(
        self,
        item: str,
        occasion: int | str,
        experience: Experience | None,
        ends: tuple[int, int] = SLIDER_RANGE,
        weights: Weights | None = None,
    ) -> int:
        """An answer between two ends, rounded as this person rounds. `occasion` tells several
        answers to an item apart; without an experience nothing has happened that could move it."""
        meant = self._meant(item, experience, weights) + self._noise(item, occasion)
        coarse = self._traits.coarseness
        grain = 1 if coarse < 1 / 3 else 5 if coarse < 2 / 3 else 10
        low, high = SLIDER_RANGE
        share = (round(clipped(grain * round(meant / grain), low, high)) - low) / (high - low)
        return round(ends[0] + share * (ends[1] - ends[0]))

    def scale(
        self,
        item: str,
        occasion: int | str,
        experience: Experience | None,
        points: int,
        weights: Weights | None = None,
    ) -> int:
        """An answer from 1 to `points`."""
        meant = self._meant(item, experience, weights) + self._noise(item, occasion)
        middle = (1 + points) / 2
        return round(clipped(middle + (meant - 50) / (_POINTS / points), 1, points))

    def preferred(self, first: Experience, second: Experience) -> Literal[1, 2]:
        """The round, 1 or 2, whose instructor was liked better on the whole."""
        liked = [
            sum(self._meant(item, experience) for item in ("pref1", "pref2", "pref3", "pref4")) / 4
            + self._noise("preferred", round_)
            for round_, experience in ((1, first), (2, second))
        ]
        return 1 if liked[0] > liked[1] else 2

    def _meant(
        self, item: str, experience: Experience | None, given: Weights | None = None
    ) -> float:
        weights = given or WEIGHTS.get(item, _BY_MOOD)
        caused = 0.0 if experience is None else _caused(weights, strain_of(experience))
        leaning = _LEANING * normal(stream(*self._seed, "leaning", item))
        mood = weights.valence * _MOOD * self._traits.mood
        return weights.middle + mood + leaning + self._population.effect * caused

    def _noise(self, item: str, occasion: int | str) -> float:
        return self._population.noise * normal(stream(*self._seed, "noise", item, occasion))


def _caused(weights: Weights, strain: Strain) -> float:
    return (
        weights.overload * strain.overload
        + weights.underload * strain.underload
        + weights.hindered * strain.hindered
        + weights.corrections * strain.corrections
        + weights.switches * strain.switches
    )
