"""A mission with its coach: pacing, the order of records, and ticks that change nothing."""

from collections.abc import Callable, Sequence
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from game.coach.acts import PosteriorEvaluated
from game.journal.records import RunRecord
from game.session.playing import assemble
from game.session.run import MissionRun
from game.world.events import Acted, Action, Expired, MissionEnded, Rescued
from game.world.settings import MissionSettings
from tests.session.toy import COMPASS, HUT, SETTINGS, SPEC, TURN, toy

END = SETTINGS.duration_ms


def begun(settings: MissionSettings = SETTINGS) -> tuple[MissionRun, list[RunRecord]]:
    records: list[RunRecord] = []
    run = assemble(HUT, settings, SPEC, 0, records.extend, build=toy)
    run.begin()
    return run, records


def acts(records: Sequence[RunRecord]) -> list[tuple[int, int, Action]]:
    return [(r.at_ms, r.pressed_ms, r.action) for r in records if isinstance(r, Acted)]


def test_the_first_move_is_made_at_once_and_the_next_waits_for_the_pace() -> None:
    run, records = begun()
    run.press(Action.NORTH, 100)
    run.press(Action.EAST, 150)
    assert acts(records) == [(100, 100, Action.NORTH)]
    assert run.next_due_ms == 300
    run.advance(350)
    assert acts(records) == [(100, 100, Action.NORTH), (300, 150, Action.EAST)]


def test_a_newer_key_replaces_the_waiting_one() -> None:
    run, records = begun()
    for at_ms, action in ((0, Action.NORTH), (50, Action.EAST), (90, Action.SOUTH)):
        run.press(action, at_ms)
    run.advance(1_000)
    assert acts(records) == [(0, 0, Action.NORTH), (200, 90, Action.SOUTH)]


def test_triage_is_not_paced() -> None:
    run, records = begun()
    run.press(Action.NORTH, 0)
    run.press(Action.TRIAGE, 10)
    assert acts(records)[-1] == (10, 10, Action.TRIAGE)


def test_a_held_key_walks_at_the_pace_and_stops_within_one_move() -> None:
    run, records = begun()
    for at_ms in range(0, 1_000, 30):
        run.press(Action.EAST, at_ms)
    run.advance(2_000)
    times = [at_ms for at_ms, _, _ in acts(records)]
    assert times == [0, 200, 400, 600, 800, 1_000]


@given(st.lists(st.integers(80, 400), min_size=1, max_size=12), st.integers(5, 12))
def test_single_taps_are_steps_as_long_as_three_wait_at_most(gaps: list[int], pace: int) -> None:
    run, records = begun(MissionSettings(moves_per_second=pace))
    pressed, waiting, next_ms = [0], 0, run.mission.settings.pace_ms
    for gap in gaps:
        pressed.append(pressed[-1] + gap)
    expected = 0
    for at_ms in pressed:
        while waiting and next_ms <= at_ms:
            waiting, next_ms = waiting - 1, next_ms + run.mission.settings.pace_ms
        if at_ms == 0 or at_ms >= next_ms:
            next_ms, expected = at_ms + run.mission.settings.pace_ms, expected + 1
        elif waiting < 3:
            waiting, expected = waiting + 1, expected + 1
        run.press(Action.EAST, at_ms)
    run.advance(END)
    assert len(acts(records)) == expected


@pytest.mark.parametrize("gap_ms", [80, 100, 120, 199, 200, 300])
def test_five_taps_are_five_steps(gap_ms: int) -> None:
    run, records = begun()
    for number in range(5):
        run.press(Action.EAST, number * gap_ms)
    run.advance(5_000)
    assert len(acts(records)) == 5


def test_six_taps_in_600_ms_are_six_steps() -> None:
    run, records = begun()
    for number in range(6):
        run.press(Action.EAST, number * 120)
    run.advance(5_000)
    assert [at_ms for at_ms, _, _ in acts(records)] == [0, 200, 400, 600, 800, 1_000]


@given(st.integers(10, 79), st.integers(1, 60), st.integers(5, 12))
def test_a_held_key_stops_within_one_move(gap_ms: int, repeats: int, pace: int) -> None:
    run, records = begun(MissionSettings(moves_per_second=pace))
    for number in range(repeats + 1):
        run.press(Action.EAST, number * gap_ms)
    before = len(acts(records))
    run.advance(END)
    assert len(acts(records)) - before <= 1


@given(st.lists(st.integers(80, 120), max_size=4), st.integers(1, 79))
def test_another_direction_at_once_replaces_all_that_waits(taps: list[int], gap_ms: int) -> None:
    run, records = begun(MissionSettings(moves_per_second=1))
    now_ms = 0
    run.press(Action.EAST, now_ms)
    for tap in taps:
        now_ms += tap
        run.press(Action.EAST, now_ms)
    now_ms += gap_ms
    run.press(Action.SOUTH, now_ms)
    run.advance(END)
    assert [action for _, _, action in acts(records)] == [Action.EAST, Action.SOUTH]


def test_treating_forgets_what_waits() -> None:
    run, records = begun()
    for at_ms in (0, 100, 200, 300):
        run.press(Action.EAST, at_ms)
    run.press(Action.TRIAGE, 310)
    run.advance(2_000)
    assert [action for _, _, action in acts(records)] == [Action.EAST] * 2 + [Action.TRIAGE]


def test_things_due_at_the_same_time_happen_in_a_fixed_order() -> None:
    settings = MissionSettings(duration_ms=3_500, red_expiry_ms=3_500, treat_blue_ms=3_500)
    run, records = begun(settings)
    run.press(Action.TRIAGE, 0)
    run.advance(10_000)
    kinds = (Rescued, Expired, PosteriorEvaluated, MissionEnded)
    assert [type(r) for r in records if r.at_ms == 3_500 and isinstance(r, kinds)] == list(kinds)
    assert run.next_due_ms is None


def test_each_call_records_once_and_before_it_returns() -> None:
    batches: list[Sequence[RunRecord]] = []
    run = assemble(HUT, SETTINGS, SPEC, 0, batches.append, build=toy)
    run.begin()
    run.advance(100)
    run.press(Action.TRIAGE, 200)
    run.advance(3_300)
    assert [[type(record).__name__ for record in batch] for batch in batches] == [
        ["GoalSet", "InstructionIssued"],
        ["Acted", "TreatmentStarted"],
        [*["PosteriorEvaluated"] * 4, "Rescued", "GoalSet", "InstructionIssued"],
    ]


def test_an_error_while_recording_reaches_the_caller() -> None:
    def full(_: Sequence[RunRecord]) -> None:
        raise OSError("full")

    run = assemble(HUT, SETTINGS, SPEC, 0, full, build=toy)
    with pytest.raises(OSError, match="full"):
        run.begin()


def keys(actions: Sequence[Action]) -> st.SearchStrategy[list[tuple[int, Action]]]:
    return st.lists(st.tuples(st.integers(0, 900), st.sampled_from(actions)), max_size=40)


@pytest.mark.parametrize("controls", ["compass", "turn"])
@given(data=st.data())
def test_extra_ticks_change_nothing(controls: Any, data: st.DataObject) -> None:
    settings = MissionSettings(duration_ms=9_000, red_expiry_ms=7_000, controls=controls)
    pressed = data.draw(keys(COMPASS if controls == "compass" else TURN))
    ticks = data.draw(st.lists(st.integers(0, 12_000), max_size=30))

    def play(tick: Callable[[MissionRun, int, int], None]) -> list[RunRecord]:
        run, records = begun(settings)
        now_ms = 0
        for wait_ms, action in pressed:
            tick(run, now_ms, now_ms + wait_ms)
            now_ms += wait_ms
            run.press(action, now_ms)
        tick(run, now_ms, END)
        run.advance(END)
        assert run.ended
        return records

    def ticked(run: MissionRun, after_ms: int, until_ms: int) -> None:
        for at_ms in sorted(ticks):
            if after_ms <= at_ms <= until_ms:
                run.advance(at_ms)

    assert play(ticked) == play(lambda *_: None)
