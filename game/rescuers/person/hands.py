"""Hands at the keys: a pace of their own, and now and then a wrong key, which is then corrected."""

from __future__ import annotations

from collections import deque
from random import Random

from game.rescuers.driver import Wait
from game.rescuers.person.parameters import Traits
from game.world.events import Action
from game.world.observation import Observation
from game.world.settings import Controls

_OPPOSITE = {
    Action.NORTH: Action.SOUTH,
    Action.EAST: Action.WEST,
    Action.SOUTH: Action.NORTH,
    Action.WEST: Action.EAST,
    Action.TURN_LEFT: Action.TURN_RIGHT,
    Action.TURN_RIGHT: Action.TURN_LEFT,
}
_BESIDE = {
    Action.NORTH: (Action.WEST, Action.EAST),
    Action.EAST: (Action.NORTH, Action.SOUTH),
    Action.SOUTH: (Action.EAST, Action.WEST),
    Action.WEST: (Action.SOUTH, Action.NORTH),
    Action.FORWARD: (Action.TURN_LEFT, Action.TURN_RIGHT),
    Action.TURN_LEFT: (Action.TURN_RIGHT,),
    Action.TURN_RIGHT: (Action.TURN_LEFT,),
}
"""The keys that are hit instead of one."""


class Hands:
    """Press what is meant, one key after another."""

    def __init__(self, traits: Traits, controls: Controls, chance: Random) -> None:
        self._traits = traits
        self._controls: Controls = controls
        self._chance = chance
        self._meant: deque[Action] = deque()
        self._slip: tuple[Action, Action, Observation] | None = None
        self._busy_ms = 0
        self._last: Action | None = None
        self._last_ms = 0

    @property
    def idle(self) -> bool:
        """Whether nothing is left to be pressed."""
        return not self._meant

    @property
    def correcting(self) -> bool:
        """Whether a wrong key is being made good."""
        return len(self._meant) > 1

    def mean(self, action: Action) -> None:
        """Press this next."""
        self._meant.append(action)

    def let_go(self) -> None:
        """Forget what was meant."""
        self._meant.clear()
        self._slip = None

    def rest_until(self, at_ms: int) -> None:
        """Press nothing before that."""
        self._busy_ms = max(self._busy_ms, at_ms)

    def see(self, now: Observation, reaction_ms: int) -> None:
        """Look whether the last key was the right one; correct it where it was not."""
        if self._slip is None:
            return
        (wrong, right, before), self._slip = self._slip, None
        if self._controls == "turn":
            happened = now.heading is not before.heading
        else:
            happened = now.position != before.position
        self._meant.clear()
        if happened:
            self._meant.append(_OPPOSITE[wrong])
        self._meant.append(right)
        self.rest_until(now.time_ms + reaction_ms)

    def press(self, now: Observation, slips: float, slowness: float) -> Action | Wait:
        """The next key, when it is time for it; `slips` is the chance that it is a wrong one, and
        `slowness` multiplies the pauses between keys."""
        action = self._meant[0]
        traits = self._traits
        pause_ms = traits.step_ms if action is self._last else traits.key_change_ms
        ready_ms = self._busy_ms
        if self._last is not None:
            ready_ms = max(ready_ms, self._last_ms + round(pause_ms * slowness))
        if now.time_ms < ready_ms:
            return Wait(ready_ms)
        self._meant.popleft()
        if action is not Action.TRIAGE and self._chance.random() < slips:
            wrong = self._chance.choice(_BESIDE[action])
            self._slip = wrong, action, now
            action = wrong
        self._last, self._last_ms = action, now.time_ms
        return action
