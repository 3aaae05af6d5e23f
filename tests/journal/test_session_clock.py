"""The mission's clock, and what a machine's two clocks say about sleep and changes of time."""

import time

import pytest

from game.journal.clock import MissionClock, Reading, SystemClock, VirtualClock
from game.journal.records import Interruption
from game.journal.writer import interruption, utc_text


def test_mission_time_counts_from_the_start_and_stops_in_a_pause() -> None:
    clock = VirtualClock(5_000)
    mission = MissionClock(clock)
    clock.now_ms = 6_000
    assert mission.now_ms() == 1_000
    mission.pause()
    clock.now_ms = 60_000
    mission.pause()
    assert (mission.paused, mission.now_ms()) == (True, 1_000)
    mission.unpause()
    clock.now_ms = 60_250
    mission.unpause()
    assert (mission.paused, mission.now_ms()) == (False, 1_250)


def test_the_machines_clock_counts_milliseconds() -> None:
    clock = SystemClock()
    before = clock.read()
    time.sleep(0.05)
    after = clock.read()
    assert 50 <= after.steady_ms - before.steady_ms < 5_000
    assert abs(after.utc_ms - time.time() * 1000) < 5_000
    assert interruption(before, after) is None


@pytest.mark.parametrize(
    ("now", "expected"),
    [
        (Reading(100, 0, 1_000_100), None),
        (Reading(100, 0, 1_001_900), None),
        (Reading(100, 60_000, 1_060_100), Interruption("suspended", jump_ms=60_000)),
        (Reading(100, 0, 1_000_100 - 3_600_000), Interruption("clock_step", jump_ms=-3_600_000)),
        (Reading(100, 0, 1_000_100 + 5_000), Interruption("clock_step", jump_ms=5_000)),
    ],
)
def test_sleep_and_a_set_clock_are_told_apart(now: Reading, expected: object) -> None:
    assert interruption(Reading(0, 0, 1_000_000), now) == expected


def test_utc_has_a_fixed_form() -> None:
    assert utc_text(946_684_800_000) == "2000-01-01T00:00:00.000Z"
    assert utc_text(1_700_000_000_007) == "2023-11-14T22:13:20.007Z"
