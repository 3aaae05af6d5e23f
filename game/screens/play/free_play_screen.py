"""A mission of free play: the mission screen with the keys at its foot, the bar explained, and the
deaths of red victims told."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path

from textual.app import ComposeResult
from textual.timer import Timer

from game.screens.play.live import LiveMission
from game.screens.play.mission_screen import ASKED_S, MissionScreen
from game.screens.widgets.howto import HasKeys
from game.screens.widgets.instruction_bar import announces
from game.screens.widgets.keyline import KeyLine
from game.screens.widgets.keymap import USUAL_KEYS, KeyMap
from game.screens.widgets.preferences import USUAL_PREFERENCES, Preferences
from game.world.observation import Guidance, Observation
from game.world.settings import MissionSettings

DIED_MS = 8_000
"""For how long the bar says that red victims died."""
_TREATING = re.compile(
    r"(Utilize medical equipment|(?:Approach and save|Triage) the (?:red|blue) victim)\."
)
"""The ways in which the bar asks for the one key."""


def glossed(text: str, key: str = "space") -> str:
    """A text of the bar with the key for treating named."""
    return _TREATING.sub(lambda found: f"{found[1]} ({key}).", text)


class Gloss:
    """Names the key for treating until the player has used it once."""

    def __init__(self, key: str = "space") -> None:
        self._key = key
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
        text = glossed(guidance.text, self._key)
        if text == guidance.text:
            return observation
        return observation._replace(guidance=replace(guidance, text=text))


class Repeats:
    """Tells a new instruction in the words of the one before it from that one."""

    def __init__(self) -> None:
        self._before = Guidance("")
        self.again = False
        """Whether the instruction shown last repeats the words before it."""

    def of(self, observation: Observation) -> Observation:
        """The observation with `Again` on its bar, where that is so."""
        guidance = observation.guidance
        if guidance is None:
            return observation
        repeated = guidance.repeats(self._before)
        if repeated or guidance.text != self._before.text:
            self.again, self._before = repeated, guidance
        if not self.again:
            return observation
        return observation._replace(guidance=replace(guidance, text=f"Again: {guidance.text}"))


def deaths_told(observation: Observation, rules: MissionSettings) -> Observation:
    """The observation with a notice on its bar, where red victims have just died."""
    lost = observation.lost
    if not lost or observation.time_ms >= rules.reds_expire_ms + DIED_MS or observation.ended:
        return observation
    guidance = observation.guidance or Guidance("")
    died = f"Time is up for red victims: {lost} died."
    notice = f"{died} {guidance.notice}".rstrip()
    return observation._replace(guidance=replace(guidance, notice=notice))


def mission_keys(rules: MissionSettings, keys: KeyMap = USUAL_KEYS) -> list[tuple[str, str]]:
    """The keys of a mission, as many as there are by its rules, each with what it does."""
    label = keys.label
    if rules.controls == "turn":
        walking = [(label("up"), "walk"), (f"{label('left')}{label('right')}", "turn")]
    else:
        walking = [(keys.walking or "↑↓←→", "walk")]
    words = [(f"{label('simpler')} {label('shorter')}", "detail")] if rules.level_key else []
    pause = [(label("pause"), "pause")] if rules.allow_pause else []
    others = [(label("treat"), "treat"), (label("help"), "help"), (label("leave"), "leave")]
    return [*walking, *others, *pause, *words]


class FreePlayScreen(MissionScreen):
    """A person plays outside a study."""

    def __init__(
        self, live: LiveMission, journal: Path, preferences: Preferences = USUAL_PREFERENCES
    ) -> None:
        super().__init__(live, journal)
        self._gloss = Gloss()
        self._repeats = Repeats()
        self._said = Guidance("")
        self._keys = KeyLine(id="keys")
        self._telling: Timer | None = None
        self.view.status.deaths = True
        self.prefer(preferences)

    def prefer(self, preferences: Preferences) -> None:
        """From now on the bar rings and flashes as preferred."""
        self._rings = preferences.bell
        self.view.bar.flashes = not preferences.still
        self.view.office.prefer(preferences.cells)

    def compose(self) -> ComposeResult:
        yield from super().compose()
        self._gloss = Gloss(self._keymap().label("treat").lower())
        self._name_keys()
        yield self._keys

    def _keymap(self) -> KeyMap:
        return self.app.keys if isinstance(self.app, HasKeys) else USUAL_KEYS

    def _name_keys(self) -> None:
        self._keys.set_keys(*mission_keys(self.live.settings, self._keymap()))

    def tell(self, text: str) -> None:
        """Show a text for a moment in place of the keys, where it covers nothing."""
        if self._telling is not None:
            self._telling.stop()
        self._keys.set_keys((text, ""))
        self._telling = self.set_timer(ASKED_S, self._name_keys)

    def action_act(self, name: str) -> None:
        super().action_act(name)
        if name != "triage" or self.live.paused or self.live.observation().treatment is not None:
            return
        near = self.live.run.mission.victim_in_reach()
        self.tell("Nobody is in reach" if near is None else "It is too late for this red victim")

    def show(self, observation: Observation) -> None:
        observation = deaths_told(self._repeats.of(observation), self.live.settings)
        said = observation.guidance or Guidance("")
        repeated = self._repeats.again and said.completed != self._said.completed
        if self._rings and (repeated or announces(said, self._said)):
            self.app.bell()
        if repeated:
            self.view.bar.stand_out()
        self._said = said
        super().show(self._gloss.of(observation))
