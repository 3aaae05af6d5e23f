"""A simulated rescuer plays live, in the very screen a person plays in."""

from __future__ import annotations

from pathlib import Path
from typing import ClassVar

from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.widget import Widget

from game.rescuers.catalogue import Character
from game.rescuers.driver import Rescuer
from game.screens.play.coachpanel import CoachPanel, OverheardCoach, coach_pins
from game.screens.play.live import LiveMission
from game.screens.play.mission_screen import LiveScreen
from game.screens.widgets.keyline import KeyLine
from game.world.events import Action
from game.world.observation import Observation

SPEEDS = (1, 2, 4, 8)
SUMMARY_COLUMNS = 110
"""From this width on, the rescuer's name fits beside the keys."""


class WatchScreen(LiveScreen):
    """Asks a rescuer where a person would press a key: once a pace, or when something happens
    while it waits."""

    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("space", "pause", "Pause", id="watch.pause"),
        Binding("up,plus,equals_sign", "speed(1)", "Faster", id="watch.faster"),
        Binding("down,minus", "speed(-1)", "Slower", id="watch.slower"),
        Binding("c,C", "coach", "Coach's panel", id="watch.coach"),
    ]

    def __init__(
        self,
        live: LiveMission,
        journal: Path,
        rescuer: Rescuer,
        coach: OverheardCoach,
        who: Character,
    ) -> None:
        self._panel = CoachPanel(live.run.mission.building, coach.spec)
        super().__init__(live, journal)
        self.view.status.deaths = True
        self._rescuer = rescuer
        self._who = who
        self._coach = coach
        self._turn_ms = 0
        self._keys = KeyLine(id="keys")

    def extra(self) -> Widget:
        return self._panel

    def compose(self) -> ComposeResult:
        yield from super().compose()
        yield self._keys

    def show(self, observation: Observation) -> None:
        thoughts = self._coach.thoughts
        pins = coach_pins(thoughts, self.live.run.mission.building)
        self.view.show(observation, pins if self._panel.display else None)
        self._panel.show(thoughts)
        who = f"{self._who.summary}, " if self.size.width >= SUMMARY_COLUMNS else ""
        self._keys.set_keys(
            ("SIMULATED", f"{who}{self.live.pace.speed}x"),
            ("P", "pause"),
            ("↑ ↓", "speed"),
            ("C", "coach"),
            ("Q", "leave"),
        )

    def refresh_view(self) -> None:
        if not self.live.paused:
            self.wait_for(self._turn_ms)
        super().refresh_view()

    def woken(self) -> None:
        run = self.live.run
        now_ms = self.live.now_ms()
        if now_ms < self._turn_ms or run.ended:
            return
        decided = self._rescuer.decide(run.observation())
        if isinstance(decided, Action):
            self.live.press(decided)
            self._turn_ms = now_ms + run.mission.settings.pace_ms
        else:
            due_ms = run.next_due_ms or now_ms
            self._turn_ms = due_ms if decided is None else min(due_ms, decided.until_ms)

    def action_speed(self, way: int) -> None:
        place = SPEEDS.index(self.live.pace.speed) + way
        self.live.pace.speed = SPEEDS[max(0, min(place, len(SPEEDS) - 1))]
        self.rearm()
        self.refresh_view()

    def action_coach(self) -> None:
        self._panel.display = not self._panel.display
        self.view.divide()
        self.refresh_view()
