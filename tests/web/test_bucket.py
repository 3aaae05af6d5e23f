"""How much a visitor may send."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from game.web.bucket import TokenBucket

amounts = st.floats(0, 50, allow_nan=False)


class Clock:
    now = 0.0

    def __call__(self) -> float:
        return self.now


@given(st.lists(st.tuples(st.floats(0, 5), amounts)), st.floats(0.1, 100), st.floats(0.1, 100))
def test_no_more_passes_than_the_burst_and_what_time_gave(
    steps: list[tuple[float, float]], per_second: float, burst: float
) -> None:
    clock = Clock()
    bucket = TokenBucket(per_second, burst, clock)
    passed = 0.0
    for pause, amount in steps:
        clock.now += pause
        passed += amount * bucket.take(amount)
        assert passed <= burst + clock.now * per_second + 1e-6


@given(st.lists(amounts, max_size=20))
def test_what_is_refused_takes_nothing(refused: list[float]) -> None:
    bucket = TokenBucket(1, 10, Clock())
    for amount in refused:
        assert not bucket.take(10.5 + amount)
    assert bucket.take(10)


def test_a_visitor_who_waits_may_send_again() -> None:
    clock = Clock()
    bucket = TokenBucket(2, 4, clock)
    assert [bucket.take(1) for _ in range(5)] == [True] * 4 + [False]
    clock.now = 1
    assert [bucket.take(1) for _ in range(3)] == [True, True, False]
