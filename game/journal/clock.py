"""Clocks: the machine's, a virtual one for simulations, and the one a mission is played by."""

from __future__ import annotations

import sys
import time
from typing import NamedTuple, Protocol

SIMULATED_EPOCH_MS = 946_684_800_000
"""2000-01-01T00:00:00Z: when every simulated session begins."""


class Reading(NamedTuple):
    """One look at a clock, in milliseconds.

    `steady_ms` never goes back and stands still while the machine sleeps; `asleep_ms` is how long
    it has slept, where the system tells; `utc_ms` counts from 1970 and may be set by anyone.
    """

    steady_ms: int
    asleep_ms: int
    utc_ms: int


class Clock(Protocol):
    """Where times come from."""

    def read(self) -> Reading: ...


class SystemClock:
    """This machine's clocks."""

    def read(self) -> Reading:
        steady_ns = time.monotonic_ns()
        return Reading(
            steady_ns // 1_000_000,
            max(0, _since_boot_ns() - steady_ns) // 1_000_000,
            time.time_ns() // 1_000_000,
        )


class VirtualClock:
    """A clock that stands where it is put; `now_ms` counts from the simulated epoch."""

    def __init__(self, now_ms: int = 0) -> None:
        self.now_ms = now_ms

    def read(self) -> Reading:
        return Reading(self.now_ms, 0, SIMULATED_EPOCH_MS + self.now_ms)


class MissionClock:
    """Mission milliseconds of a mission that begins now; it can be paused."""

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
        """Stand still. Has no effect on a clock that does."""
        self._paused_at_ms = self.now_ms()

    def unpause(self) -> None:
        """Run on from where it stood. Has no effect on a clock that runs."""
        if self._paused_at_ms is not None:
            self._zero_ms = self._clock.read().steady_ms - self._paused_at_ms
            self._paused_at_ms = None


def _since_boot_ns() -> int:
    """Nanoseconds that count on while the machine sleeps, unlike those of `time.monotonic_ns`."""
    clock = time.CLOCK_MONOTONIC if sys.platform == "darwin" else time.CLOCK_BOOTTIME
    return time.clock_gettime_ns(clock)
