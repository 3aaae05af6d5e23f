"""Plays a mission with a simulated rescuer on a virtual clock."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple, Protocol

from game.session.run import MissionRun
from game.world.events import Action
from game.world.observation import Observation


class Wait(NamedTuple):
    """Do nothing until `until_ms` of the mission's time, or until something happens before."""

    until_ms: int


class Rescuer(Protocol):
    """Somebody who decides from an Observation, as a person does at the screen."""

    def decide(self, observation: Observation) -> Action | Wait | None:
        """The next action, or how long to wait; None to wait until something happens."""
        ...


def drive(
    run: MissionRun,
    rescuer: Rescuer,
    *,
    passing: Callable[[int], None] = lambda _now_ms: None,
    done: Callable[[], bool] = lambda: False,
) -> None:
    """Play a run that has begun until it ends or is `done`.

    The rescuer acts once a pace at most, and waits where it wants to. `passing` is told each new
    time before anything happens at it, for callers that keep a clock.
    """
    pace_ms = run.mission.settings.pace_ms
    now_ms = run.mission.time_ms
    while (due_ms := run.next_due_ms) is not None and not done():
        decided = rescuer.decide(run.observation())
        if isinstance(decided, Action):
            run.press(decided, now_ms)
            now_ms += pace_ms
        elif decided is None:
            now_ms = due_ms
        else:
            now_ms = min(due_ms, max(decided.until_ms, now_ms + 1))
        passing(now_ms)
        run.advance(now_ms)
