"""A mission of free play: the mission screen with the keys at its foot, and the bar explained."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path

from textual.app import ComposeResult

from game.screens.play.live import LiveMission
from game.screens.play.mission_screen import MissionScreen
from game.screens.widgets.keyline import KeyLine
from game.world.observation import Guidance, Observation
from game.world.settings import MissionSettings

_TREATING = re.compile(
    r"(Utilize medical equipment|(?:Approach and save|Triage) the (?:red|blue) victim)\."
)
"""The ways in which the bar asks for the one key."""


def glossed(text: str) -> str:
    """A text of the bar with the key for treating named."""
    return _TREATING.sub(r"\1 (space).", text)


class Gloss:
    """Names the key for treating until the player has used it once."""

    def __init__(self) -> None:
        self._learned = False
        self._kept = ""

    def of(self, observation: Observation) -> Observation:
        """The observation with its bar explained, where that is still needed. What has been
        explained stays so as long as it stands on the bar."""
        self._learned |= observation.treatment is not None
        guidance = observation.guidance
        if guidance is None or (self._learned and guidance.text != self._kept):
            return observation
        self._kept = guidance.text
        text = glossed(guidance.text)
        if text == guidance.text:
            return observation
        return replace(observation, guidance=Guidance(text, guidance.notice))


def mission_keys(rules: MissionSettings) -> list[tuple[str, str]]:
    """The keys of a mission, as many as there are by its rules, each with what it does."""
    turning = rules.controls == "turn"
    walking = [("↑", "walk"), ("←→", "turn")] if turning else [("↑↓←→", "walk")]
    words = [("+ -", "wording")] if rules.level_key else []
    pause = [("P", "pause")] if rules.allow_pause else []
    return [*walking, ("Space", "treat"), ("?", "help"), ("Q", "leave"), *pause, *words]


class FreePlayScreen(MissionScreen):
    """A person plays outside a study."""

    def __init__(self, live: LiveMission, journal: Path) -> None:
        super().__init__(live, journal)
        self._gloss = Gloss()

    def compose(self) -> ComposeResult:
        yield from super().compose()
        yield KeyLine(*mission_keys(self.live.settings), id="keys")

    def show(self, observation: Observation) -> None:
        super().show(self._gloss.of(observation))
