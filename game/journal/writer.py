"""Writing a journal: one JSON object per line, one file per session."""

from __future__ import annotations

import asyncio
import sys
import threading
from collections import deque
from collections.abc import Sequence
from datetime import UTC, datetime, timedelta
from functools import lru_cache
from importlib.util import find_spec
from pathlib import Path
from typing import Self

import msgspec

from game import __version__
from game.journal.clock import Clock, Reading, SystemClock
from game.journal.journal_error import JournalError
from game.journal.reader import parse_journal
from game.journal.records import (
    SCHEMA_VERSION,
    Allocated,
    AnswerCleared,
    ChoicesGiven,
    Consented,
    Envelope,
    FreeText,
    Interruption,
    MissionAbandoned,
    Phase,
    PhaseEnded,
    PracticeChecked,
    PreferenceGiven,
    QuestionnaireAnswer,
    QuizAnswer,
    QuizSubmitted,
    Record,
    Resumed,
    SessionStarted,
    Terminal,
    Versions,
    Withdrawn,
)
from game.journal.sink import FileSink, MemorySink, Sink
from game.world.events import MissionEnded, Rescued

CLOCK_JUMP_MS = 2_000
"""Wall clock and steady clock disagree by more than this only if the machine slept or the wall
clock was set; a time service makes smaller corrections."""

LASTING = frozenset(
    {
        Rescued,
        MissionEnded,
        MissionAbandoned,
        Consented,
        PracticeChecked,
        Allocated,
        PhaseEnded,
        QuizAnswer,
        QuizSubmitted,
        QuestionnaireAnswer,
        ChoicesGiven,
        AnswerCleared,
        PreferenceGiven,
        FreeText,
        Withdrawn,
    }
)
"""The records that must be on disk before the session continues."""

_EPOCH = datetime(1970, 1, 1, tzinfo=UTC)
_encoder = msgspec.json.Encoder()


class Journal:
    """One segment of one journal. Every method but `enter` raises JournalError.

    When `append` or `extend` returns, the operating system has the record. If `awaits_disk` is
    true, something was appended that must survive a power cut as well (an answer, a rescue, the
    end of a phase): call `wait_durable` before the next paint. If the wall clock and the steady
    clock disagree between two records, an `interruption` is put between them.

    A signal handler may append at any moment: a record that arrives during a write is written
    right after it, by the code that is writing. A record that the sink refused stays first in the
    queue, so everything after it is refused as well.
    """

    def __init__(self, sink: Sink, clock: Clock, *, seq: int = 0, segment: int = 0) -> None:
        self.sink = sink
        self.awaits_disk = False
        self.phase: Phase = "session"
        self.round = 0
        self._clock = clock
        self._began = self._latest = clock.read()
        self._seq = seq
        self._segment = segment
        self._waiting: deque[Sequence[Record]] = deque()
        self._writing = threading.Lock()

    @classmethod
    def create(cls, path: Path, started: SessionStarted, clock: Clock | None = None) -> Self:
        """Begin the journal at `path`. A file without one complete line is overwritten."""
        sink = FileSink.begin(path)
        try:
            journal = cls(sink, clock or SystemClock())
            journal.append(started)
        except BaseException:
            sink.close()
            raise
        return journal

    @classmethod
    def buffered(cls, path: Path | None, started: SessionStarted, clock: Clock) -> Self:
        """Begin a journal in memory, written to `path` (None: nowhere) when it is closed."""
        journal = cls(MemorySink(path), clock)
        journal.append(started)
        return journal

    @classmethod
    def resume(cls, path: Path, terminal: Terminal | None, clock: Clock | None = None) -> Self:
        """Begin a new segment of the journal at `path`, in the phase and round where it broke off.

        A last record that lacks only its newline gets one, and so counts.
        """
        sink = FileSink(path, create=False)
        try:
            contents = sink.contents()
            newline = b"" if contents.endswith(b"\n") else b"\n"
            before = parse_journal(contents + newline, str(path))
            last = before.entries[-1].envelope
            segment = last.segment + 1
            journal = cls(sink, clock or SystemClock(), seq=last.seq + 1, segment=segment)
            journal.enter(last.phase, last.round)
            resumed = Resumed(
                torn_bytes=before.torn_bytes, versions=versions(terminal), terminal=terminal
            )
            sink.write(newline + journal._lines([resumed]))
        except BaseException:
            sink.close()
            raise
        return journal

    def enter(self, phase: Phase, round_: int = 0) -> None:
        """Records belong to this phase and round from here on."""
        self.phase, self.round = phase, round_

    def append(self, record: Record) -> None:
        self.extend((record,))

    def extend(self, records: Sequence[Record]) -> None:
        """Append records that belong together, in one write."""
        self._waiting.append(records)
        self._write_waiting()

    def interrupt(self, signal: str) -> None:
        """Append the record of a signal, given its name."""
        self.append(Interruption("hang_up" if signal == "SIGHUP" else "signal", signal=signal))

    def keep(self, sink: Sink) -> None:
        """Write to `sink` from here on, beginning with everything this journal has in memory."""
        with self._writing:
            assert isinstance(self.sink, MemorySink)
            sink.write(bytes(self.sink.data))
            self.sink = sink
        self._write_waiting()

    def flush_durably(self) -> None:
        """Wait for the disk. This takes milliseconds, so never call it on an event loop."""
        self.awaits_disk = False
        self.sink.flush_durably()

    async def wait_durable(self) -> None:
        """`flush_durably` off the event loop; memory has nothing to wait for."""
        if isinstance(self.sink, MemorySink):
            self.flush_durably()
            return
        await asyncio.to_thread(self.flush_durably)

    def close(self) -> None:
        """Flush durably and end the segment. Closing twice does no harm.

        What a signal handler appends in the meantime is no longer recorded.
        """
        with self._writing:
            self.sink.close()

    def _write_waiting(self) -> None:
        """Write the queue, unless a write is in progress: that one continues until it is empty.

        A handler may run between any two steps here, so the queue is checked once more after the
        lock is released.
        """
        while self._waiting and self._writing.acquire(blocking=False):
            try:
                while self._waiting:
                    records = self._waiting[0]
                    self._write(records)
                    self.awaits_disk |= not LASTING.isdisjoint(map(type, records))
                    self._waiting.popleft()
            finally:
                self._writing.release()

    def _write(self, records: Sequence[Record]) -> None:
        """Write the first records of the queue. They leave it if they cannot be written down: then
        it is no fault of the sink's, and what follows must not fail with them."""
        seq = self._seq
        try:
            self.sink.write(self._lines(records))
        except JournalError:
            raise
        except Exception:
            self._seq = seq
            self._waiting.popleft()
            raise

    def _lines(self, records: Sequence[Record]) -> bytes:
        now = self._clock.read()
        broke_in = interruption(self._latest, now)
        self._latest = now
        t_ms, utc = now.steady_ms - self._began.steady_ms, utc_text(now.utc_ms)
        envelope = Envelope(0, self._segment, t_ms, utc, self.phase, self.round)
        rest = _encoder.encode(envelope)[len(b'{"seq":0') : -1]
        lines = bytearray()
        for record in (broke_in, *records) if broke_in else records:
            lines += b'{"seq":%d%b,%b\n' % (self._seq, rest, _encoder.encode(record)[1:])
            self._seq += 1
        return bytes(lines)


def utc_text(utc_ms: int) -> str:
    """Milliseconds since 1970 as journals write them: 2000-01-01T00:00:00.000Z."""
    seconds, ms = divmod(utc_ms, 1000)
    return f"{_second_text(seconds)}.{ms:03}Z"


@lru_cache(maxsize=16)
def _second_text(seconds: int) -> str:
    return (_EPOCH + timedelta(seconds=seconds)).isoformat().removesuffix("+00:00")


def interruption(before: Reading, now: Reading) -> Interruption | None:
    """What happened to the machine between two readings: it slept, or its clock was set."""
    slept_ms = now.asleep_ms - before.asleep_ms
    if slept_ms > CLOCK_JUMP_MS:
        return Interruption("suspended", jump_ms=slept_ms)
    set_ms = (now.utc_ms - before.utc_ms) - (now.steady_ms - before.steady_ms) - slept_ms
    if abs(set_ms) > CLOCK_JUMP_MS:
        return Interruption("clock_step", jump_ms=set_ms)
    return None


def versions(terminal: Terminal | None) -> Versions:
    """The versions that write this segment; Textual's only if there is a terminal."""
    return Versions(
        game=__version__,
        schema=SCHEMA_VERSION,
        python=".".join(map(str, sys.version_info[:3])),
        textual=_installed("textual") if terminal else "",
    )


def _installed(package: str) -> str:
    """The version of an installed package, from the name of its `dist-info` folder.

    The standard library's importlib.metadata could tell, but takes longer to import than the whole
    game may take for its first picture.
    """
    spec = find_spec(package)
    if spec is None or spec.origin is None:
        return ""
    site = Path(spec.origin).parents[1]
    folders = site.glob(f"{package}-*.dist-info")
    return next((name.stem.partition("-")[2] for name in folders), "")
