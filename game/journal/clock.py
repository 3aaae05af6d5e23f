"""Clocks: the machine's, a virtual one for simulations, and the mission's."""

from __future__ import annotations

import sys
import time
from typing import NamedTuple, Protocol

SIMULATED_EPOCH_MS = 946_684_800_000
"""2000-01-01T00:00:00Z, the start of every simulated session."""


class Reading(NamedTuple):
    """One reading of a clock, in milliseconds.

    `steady_ms` never goes back and stops while the machine sleeps; `asleep_ms` is how long it has
    slept, if the system reports that; `utc_ms` counts from 1970 and can be changed at any time.
    """

    steady_ms: int
    asleep_ms: int
    utc_ms: int


class Clock(Protocol):
    """A source of times."""

    def read(self) -> Reading: ...


class SystemClock:
    """The clocks of this machine."""

    def read(self) -> Reading:
        steady_ns = time.monotonic_ns()
        return Reading(
            steady_ns // 1_000_000,
            max(0, _since_boot_ns() - steady_ns) // 1_000_000,
            time.time_ns() // 1_000_000,
        )


class VirtualClock:
    """A clock that moves only when it is set; `now_ms` counts from the simulated epoch."""

    def __init__(self, now_ms: int = 0) -> None:
        self.now_ms = now_ms

    def read(self) -> Reading:
        return Reading(self.now_ms, 0, SIMULATED_EPOCH_MS + self.now_ms)


class MissionClock:
    """Mission time in milliseconds, from when it is created; it can be paused."""

    def __init__(self, clock: Clock) -> None:
        self._clock = clock
        self._zero_ms = clock.read().steady_ms
        self._paused_at_ms: int | None = None

    @property
    def paused(self) -> bool:
        return self._paused_at_ms is not None

    def now_ms(self) -> int:
        if self._paused_at_ms is not None:
            return self._paused_at_ms
        return self._clock.read().steady_ms - self._zero_ms

    def pause(self) -> None:
        """Stop the clock; no effect if it is stopped already."""
        self._paused_at_ms = self.now_ms()

    def unpause(self) -> None:
        """Continue from where the clock stopped; no effect if it is running."""
        if self._paused_at_ms is not None:
            self._zero_ms = self._clock.read().steady_ms - self._paused_at_ms
            self._paused_at_ms = None


def _since_boot_ns() -> int:
    """Nanoseconds since boot, which include sleep, unlike those of `time.monotonic_ns`."""
    clock = time.CLOCK_MONOTONIC if sys.platform == "darwin" else time.CLOCK_BOOTTIME
    return time.clock_gettime_ns(clock)
