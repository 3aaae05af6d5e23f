"""What a key costs on the screen, measured from outside over a pseudo-terminal."""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import cycle, islice
from pathlib import Path
from statistics import median, quantiles

import pyte

from tests.terminal import Shown, Terminal

COLUMNS, ROWS = 120, 40
SETTLE_S = 0.4
IDLE_S = 2.0
FIRST_PAINT_BYTES = 400


@dataclass(frozen=True)
class KeyCosts:
    """Of the keys that changed the screen: milliseconds to the last changed cell, bytes, and CPU
    milliseconds a key beyond what the program takes when left alone; `answered` of `pressed` keys
    changed anything."""

    p50_ms: float
    p95_ms: float
    bytes_a_key: float
    cpu_ms_a_key: float
    answered: int
    pressed: int


def key_costs(
    command: Sequence[str | Path],
    keys: Sequence[str],
    *,
    count: int = 150,
    per_second: float = 10,
    opening: Sequence[str] = (),
    ignored_rows: Sequence[int] = (),
) -> KeyCosts:
    """Press `count` of `keys` in turn and watch the screen; `ignored_rows` hold a clock."""
    with Terminal(command, columns=COLUMNS, rows=ROWS) as terminal:
        _settle(terminal)
        for key in opening:
            terminal.press(key)
            _settle(terminal)
        before = len(terminal.chunks)
        cpu_before = _cpu_s(terminal.pid)
        pressed: list[float] = []
        start = time.perf_counter()
        for number, key in enumerate(islice(cycle(keys), count)):
            terminal.read_for(start + number / per_second - time.perf_counter())
            pressed.append(time.perf_counter())
            terminal.press(key)
        terminal.read_for(0.5)
        cpu_s, driven_s = _cpu_s(terminal.pid) - cpu_before, time.perf_counter() - start
        latencies, painted = answers(terminal, pressed, before, frozenset(ignored_rows))
        cpu_before = _cpu_s(terminal.pid)
        terminal.read_for(IDLE_S)
        idle = (_cpu_s(terminal.pid) - cpu_before) / IDLE_S
    return KeyCosts(
        p50_ms=median(latencies),
        p95_ms=quantiles(latencies, n=20)[-1],
        bytes_a_key=painted / count,
        cpu_ms_a_key=1000 * (cpu_s - idle * driven_s) / count,
        answered=len(latencies),
        pressed=count,
    )


def first_paints_ms(*commands: Sequence[str | Path], runs: int = 9) -> list[float]:
    """Median milliseconds from spawn to the first real paint of each command, taken in turn, so
    that whatever else the machine does falls on all of them."""
    rounds = [[_first_paint_ms(command) for command in commands] for _ in range(runs)]
    return [median(paints) for paints in zip(*rounds, strict=True)]


def _first_paint_ms(command: Sequence[str | Path]) -> float:
    with Terminal(command, columns=COLUMNS, rows=ROWS) as terminal:
        while True:
            if not terminal.read_for(0.01):
                raise RuntimeError(f"{command[0]} ended before it painted:\n{terminal.text()}")
            for chunk in terminal.chunks:
                if len(chunk.data) > FIRST_PAINT_BYTES:
                    return 1000 * (chunk.at - terminal.started)


def _settle(terminal: Terminal) -> None:
    """Wait until the program has painted and then been silent."""
    deadline = time.perf_counter() + 20
    while time.perf_counter() < deadline:
        seen = len(terminal.chunks)
        terminal.read_for(SETTLE_S)
        if seen and len(terminal.chunks) == seen:
            return


def answers(
    terminal: Shown, pressed: Sequence[float], before: int, ignored: frozenset[int]
) -> tuple[list[float], int]:
    """For each key that changed a cell, the time to the chunk that changed the last one."""
    screen = pyte.Screen(COLUMNS, ROWS)
    stream = pyte.ByteStream(screen)
    for chunk in terminal.chunks[:before]:
        terminal.feed(stream, chunk.data)
    latencies: list[float] = []
    painted = 0
    chunks = terminal.chunks[before:]
    ends = [*pressed[1:], float("inf")]
    for at, end in zip(pressed, ends, strict=True):
        last = 0.0
        while chunks and chunks[0].at < end:
            chunk, chunks = chunks[0], chunks[1:]
            painted += len(chunk.data)
            if _changes(screen, stream, chunk.data, ignored):
                last = chunk.at
        if last:
            latencies.append(1000 * (last - at))
    return latencies, painted


def _changes(
    screen: pyte.Screen, stream: pyte.ByteStream, data: bytes, ignored: frozenset[int]
) -> bool:
    watched = [row for row in range(ROWS) if row not in ignored]
    before = [dict(screen.buffer[row]) for row in watched]
    Terminal.feed(stream, data)
    return before != [dict(screen.buffer[row]) for row in watched]


def _cpu_s(pid: int) -> float:
    """CPU seconds of all threads of a process."""
    tasks = Path(f"/proc/{pid}/task").glob("*/schedstat")
    return sum(int(task.read_text().split()[0]) for task in tasks) / 1e9
