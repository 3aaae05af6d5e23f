"""Participants who take part at once, in missions of a study: what a key costs each of them."""

from __future__ import annotations

import select
import time
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from statistics import fmean, median, quantiles

from game.study.folder import Identity, Study
from tests.bench.screen import answers
from tests.study.people import small_study, take_part
from tests.terminal import Watched

PARTICIPANTS = 12
NAMES = tuple(f"p{number:02}" for number in range(PARTICIPANTS))
PER_SECOND = 8.0
KEYS_EACH = 80
PATIENCE_S = 60.0
BEFORE, WITHIN = "Your mission", "for reds"
"""On the page before the mission, and on its panel."""


@dataclass(frozen=True)
class SharedCosts:
    """Of the keys of all participants that changed a screen: milliseconds to the last changed
    cell; and megabytes of memory a participant's program takes, shared pages shared out."""

    p50_ms: float
    p95_ms: float
    answered: int
    pressed: int
    pss_mb: float


def in_missions(
    study: Study,
    terminals: Sequence[Watched],
    keys: Sequence[str],
    *,
    ignored_rows: Sequence[int] = (),
) -> SharedCosts:
    """Have everybody begin the mission whose page they are on, and press keys; `ignored_rows` hold
    a clock."""
    everybody_shows(terminals, BEFORE)
    _enter(terminals)
    return keys_at_once(terminals, keys, ignored_rows=ignored_rows, folder=study.folder)


def keys_at_once(
    terminals: Sequence[Watched],
    keys: Sequence[str],
    *,
    ignored_rows: Sequence[int] = (),
    folder: Path | None = None,
) -> SharedCosts:
    """Press keys on all terminals; the memory is that of the programs of the study in `folder`."""
    watch_for(terminals, 2)
    before = [len(terminal.chunks) for terminal in terminals]
    pressed = _press(terminals, keys)
    pss_mb = 0.0 if folder is None else fmean(_pss_mb(folder))
    latencies = [
        latency
        for terminal, times, start in zip(terminals, pressed, before, strict=True)
        for latency in answers(terminal, times, start, frozenset(ignored_rows))[0]
    ]
    return SharedCosts(
        p50_ms=median(latencies),
        p95_ms=quantiles(latencies, n=20)[-1],
        answered=len(latencies),
        pressed=KEYS_EACH * PARTICIPANTS,
        pss_mb=pss_mb,
    )


def long_study(folder: Path) -> Study:
    """A study whose missions last four minutes, at pace 20."""
    return small_study(
        folder,
        memorise_seconds="[1, 2]",
        label_seconds="2",
        duration_ms="240000",
        moves_per_second="20",
    )


class _Here(Exception):
    """Cuts a scripted participant off."""


def up_to_the_mission(study: Study, identity: Identity) -> None:
    """Let a scripted participant come to the page before the first mission."""
    labelled = False

    def moment(now: str) -> None:
        nonlocal labelled
        labelled |= now == "label"
        if labelled and now == "read":
            raise _Here

    try:
        take_part(study, identity, moment=moment)
    except _Here:
        return
    raise RuntimeError(f"{identity.participant} never came to the mission")


def _enter(terminals: Sequence[Watched]) -> None:
    """Begin everybody's mission; the page before it is deaf for a moment."""
    until = time.perf_counter() + PATIENCE_S
    while outside := [it for it in terminals if WITHIN not in it.text()]:
        if time.perf_counter() > until:
            raise TimeoutError(outside[0].text())
        for terminal in outside:
            terminal.press("enter")
        watch_for(terminals, 0.5)


def everybody_shows(terminals: Sequence[Watched], text: str) -> None:
    """Wait until `text` is on every screen; all are read meanwhile. Raises TimeoutError."""
    until = time.perf_counter() + PATIENCE_S
    while without := [it for it in terminals if text not in it.text()]:
        if time.perf_counter() > until:
            raise TimeoutError(without[0].text())
        watch_for(terminals, 0.1)


def _press(terminals: Sequence[Watched], keys: Sequence[str]) -> list[list[float]]:
    """Press keys on all of them, out of step; when each was pressed, by terminal."""
    pressed: list[list[float]] = [[] for _ in terminals]
    start, gap_s = time.perf_counter(), 1 / PER_SECOND / len(terminals)
    for number in range(KEYS_EACH * len(terminals)):
        turn, who = divmod(number, len(terminals))
        watch_for(terminals, start + number * gap_s - time.perf_counter())
        pressed[who].append(time.perf_counter())
        terminals[who].press(keys[turn % len(keys)])
    watch_for(terminals, 0.5)
    return pressed


def watch_for(terminals: Sequence[Watched], seconds: float) -> None:
    """Collect what all of them show for a while. Raises RuntimeError when one has ended."""
    end = time.perf_counter() + seconds
    while (left := end - time.perf_counter()) > 0:
        for terminal in select.select(terminals, [], [], left)[0]:
            if not terminal.take():
                raise RuntimeError(f"a session ended:\n{terminal.text()}")


def _pss_mb(folder: Path) -> list[float]:
    """The memory of each program that plays a session of the study in `folder`."""
    found = []
    for process in Path("/proc").glob("[0-9]*"):
        try:
            words = (process / "cmdline").read_bytes().split(b"\0")
            if b"login" in words and str(folder).encode() in words:
                rollup = (process / "smaps_rollup").read_text()
                found.append(int(rollup.split("\nPss:")[1].split()[0]) / 1024)
        except OSError:
            continue
    return found
