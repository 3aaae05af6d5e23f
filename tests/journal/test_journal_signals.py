"""Signals that arrive while a journal is being written, at every possible moment."""

import sys
import threading
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from itertools import combinations
from random import Random
from types import CodeType, FrameType
from typing import Any

import pytest

from game.journal import writer as journal_module
from game.journal.clock import VirtualClock
from game.journal.journal_error import JournalError
from game.journal.reader import first_discontinuity, parse_journal
from game.journal.records import Interruption, Paused, QuizAnswer, Record, Unpaused
from game.journal.sink import MemorySink
from game.journal.writer import Journal
from tests.session.toy import opening

HANG_UP = Interruption("hang_up", signal="SIGHUP")
ENDED = Interruption("signal", signal="SIGTERM")


class InterruptedSink(MemorySink):
    """Each of its next writes is interrupted by a handler, after half of its bytes."""

    def __init__(self, *handlers: Callable[[], None]) -> None:
        super().__init__()
        self.handlers = list(handlers)

    def write(self, lines: bytes) -> None:
        half = len(lines) // 2
        self.data += lines[:half]
        if self.handlers:
            self.handlers.pop(0)()
        self.data += lines[half:]


class RefusingSink(MemorySink):
    """Refuses everything."""

    def write(self, lines: bytes) -> None:
        raise JournalError("the disk is full")


def records(data: bytes | bytearray) -> list[Record]:
    """The records after the first, checked to be whole lines in unbroken order."""
    transcript = parse_journal(bytes(data), "")
    assert transcript.torn_bytes == 0
    assert first_discontinuity(transcript.entries) is None
    return [entry.record for entry in transcript.entries[1:]]


def begun() -> tuple[Journal, InterruptedSink]:
    sink = InterruptedSink()
    journal = Journal(sink, VirtualClock())
    journal.append(opening())
    return journal, sink


def test_a_signal_during_a_write_is_recorded_right_after_it() -> None:
    journal, sink = begun()
    sink.handlers = [lambda: journal.interrupt("SIGHUP")]
    journal.extend((Paused(1), Unpaused(2)))
    assert records(sink.data) == [Paused(1), Unpaused(2), HANG_UP]
    journal.append(Paused(3))
    assert records(sink.data)[3:] == [Paused(3)]


def test_a_signal_during_the_writing_of_a_signal_is_too() -> None:
    journal, sink = begun()
    sink.handlers = [lambda: journal.interrupt("SIGHUP"), lambda: journal.interrupt("SIGTERM")]
    journal.append(Paused(1))
    assert records(sink.data) == [Paused(1), HANG_UP, ENDED]


def test_between_two_writes_a_signal_is_written_at_once() -> None:
    journal, sink = begun()
    journal.interrupt("SIGTERM")
    assert records(sink.data) == [ENDED]


def test_a_record_that_comes_during_a_write_awaits_the_disk_too() -> None:
    journal, sink = begun()
    answer = QuizAnswer("Stube", "Küche", correct=False, response_ms=900)
    sink.handlers = [lambda: journal.append(answer)]
    journal.append(Paused(1))
    assert records(sink.data) == [Paused(1), answer]
    assert journal.awaits_disk


def test_a_signal_while_a_journal_moves_out_of_memory_moves_with_it() -> None:
    journal, memory = begun()
    journal.append(Paused(1))
    kept = InterruptedSink(lambda: journal.interrupt("SIGHUP"))
    journal.keep(kept)
    assert records(kept.data) == [Paused(1), HANG_UP]
    assert records(memory.data) == [Paused(1)]


def test_another_thread_leaves_its_record_to_the_one_that_is_writing() -> None:
    journal, sink = begun()

    def from_another_thread() -> None:
        thread = threading.Thread(target=journal.interrupt, args=("SIGTERM",))
        thread.start()
        thread.join(5)
        assert not thread.is_alive()

    sink.handlers = [from_another_thread]
    journal.append(Paused(1))
    assert records(sink.data) == [Paused(1), ENDED]


def test_a_refused_record_is_followed_by_nothing() -> None:
    journal, _ = begun()
    journal.sink = RefusingSink()
    for _ in range(2):
        with pytest.raises(JournalError, match="the disk is full"):
            journal.append(Paused(1))
    with pytest.raises(JournalError, match="the disk is full"):
        journal.interrupt("SIGHUP")


def test_nothing_is_written_to_a_journal_that_is_closing(monkeypatch: pytest.MonkeyPatch) -> None:
    journal, sink = begun()
    monkeypatch.setattr(sink, "close", lambda: journal.interrupt("SIGHUP"))
    journal.close()
    assert records(sink.data) == []


@contextmanager
def breaking_in(handlers: dict[int, Callable[[], None]]) -> Iterator[list[CodeType]]:
    """Run each handler before the n-th instruction of the journal's code in this context, as Python
    runs signal handlers. Yields a list that holds one item per instruction at the end."""
    instructions: list[CodeType] = []

    def trace(frame: FrameType, event: str, _: Any) -> Any:
        if frame.f_code.co_filename != journal_module.__file__:
            return None
        frame.f_trace_opcodes = True
        if event == "opcode":
            handler = handlers.get(len(instructions))
            instructions.append(frame.f_code)
            if handler is not None:
                handler()
        return trace

    before = sys.gettrace()
    sys.settrace(trace)
    try:
        yield instructions
    finally:
        sys.settrace(before)


def written(*moments: int) -> tuple[list[Record], int]:
    """The records of one append interrupted by signals, and its number of instructions."""
    journal, sink = begun()
    names = iter(("SIGHUP", "SIGTERM"))
    handlers = {moment: lambda: journal.interrupt(next(names)) for moment in moments}
    with breaking_in(handlers) as instructions:
        journal.append(Paused(1))
    return records(sink.data), len(instructions)


def test_a_signal_at_any_moment_is_recorded_before_the_write_returns() -> None:
    undisturbed, instructions = written()
    assert undisturbed == [Paused(1)]
    assert instructions > 50
    places = set()
    for moment in range(instructions):
        kept, _ = written(moment)
        assert sorted(kept, key=str) == [HANG_UP, Paused(1)]
        places.add(kept.index(HANG_UP))
    assert places == {0, 1}


def check_pairs(pairs: Iterable[tuple[int, int]]) -> None:
    for first, second in pairs:
        kept, instructions = written(first, second)
        if second < instructions:
            assert [record for record in kept if record != Paused(1)] == [HANG_UP, ENDED]
            assert len(kept) == 3


def pairs_of_moments() -> list[tuple[int, int]]:
    _, instructions = written()
    return list(combinations(range(instructions), 2))


def test_two_signals_are_recorded_in_their_order() -> None:
    check_pairs(Random(1).sample(pairs_of_moments(), 400))


@pytest.mark.slow
def test_two_signals_at_any_two_moments_are_recorded() -> None:
    check_pairs(pairs_of_moments())
