"""Plays a mission with a simulated rescuer on a virtual clock."""

from __future__ import annotations

from typing import Protocol

from game.session.run import MissionRun
from game.world.events import Action
from game.world.observation import Observation


class Rescuer(Protocol):
    """Whoever decides from an Observation, as a person does at the screen."""

    def decide(self, observation: Observation) -> Action | None:
        """The next action, or None to wait until something happens."""
        ...


def play(run: MissionRun, rescuer: Rescuer) -> None:
    """Play a run that has begun, and stands at 0 ms, to its end: one action a pace, waiting where
    the rescuer waits."""
    pace_ms = run.mission.settings.pace_ms
    now_ms = 0
    while (due_ms := run.next_due_ms) is not None:
        action = rescuer.decide(run.observation())
        if action is None:
            now_ms = due_ms
        else:
            run.press(action, now_ms)
            now_ms += pace_ms
        run.advance(now_ms)
