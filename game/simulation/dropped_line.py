"""Simulated people whose line drops in the middle of a session."""

from __future__ import annotations

from collections.abc import Callable

from game.journal.clock import VirtualClock
from game.rescuers.person import Population
from game.rescuers.person.randomness import stream

EARLIEST_MS, LATEST_MS = 4 * 60_000, 18 * 60_000
"""Between these times of a session the line drops: from the first map on, in the paper's protocol.
"""
AWAY_MS = 90_000
"""How long it takes to log in again."""


class HungUp(BaseException):
    """The line has dropped. No error of the program's: nothing that handles those may stop it."""


class DroppingClock(VirtualClock):
    """Calls `hang_up` and raises HungUp when it comes to `drop_ms`, once."""

    def __init__(self, drop_ms: int) -> None:
        self._now_ms = 0
        self._drop_ms: int | None = drop_ms
        self.hang_up: Callable[[], None] = lambda: None

    @property
    def now_ms(self) -> int:
        return self._now_ms

    @now_ms.setter
    def now_ms(self, value: int) -> None:
        if self._drop_ms is not None and value >= self._drop_ms:
            self._now_ms, self._drop_ms = self._drop_ms, None
            self.hang_up()
            raise HungUp
        self._now_ms = value


def drop_of(seed: int, population: Population) -> int | None:
    """When in a session with this seed the line drops; None for those whose line holds."""
    chance = stream(seed, "line")
    drops = chance.random() < population.cut_off
    return chance.randrange(EARLIEST_MS, LATEST_MS) if drops else None
