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
