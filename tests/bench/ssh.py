"""What a key costs when many take part at once over a real OpenSSH server on the loopback."""

from __future__ import annotations

import re
import select
import shlex
import tempfile
import time
from collections.abc import Sequence
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path
from statistics import fmean, median, quantiles

from game.study.folder import Identity, Study
from tests.bench.screen import COLUMNS, ROWS, answers
from tests.study.people import small_study, take_part
from tests.study.server import BY_KEY, Server
from tests.terminal import Terminal

PARTICIPANTS = 12
PER_SECOND = 8.0
KEYS_EACH = 80
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


def at_once(
    command: Sequence[str] | None, keys: Sequence[str], *, ignored_rows: Sequence[int] = ()
) -> SharedCosts:
    """Let `PARTICIPANTS` press keys at the same time, each in a mission of a study, or in
    `command` of a shell instead; `ignored_rows` hold a clock."""
    names = [f"p{number:02}" for number in range(PARTICIPANTS)]
    with tempfile.TemporaryDirectory() as folder, ExitStack() as stack:
        study = _study(Path(folder) / "study")
        keyring = {name: BY_KEY.format(name) for name in names}
        server = Server(study.folder, Path(folder) / "keys", keyring)
        if command is not None:
            _serve_instead(server.configuration, command)
        stack.enter_context(server)
        terminals = []
        for name in names:
            if command is None:
                _up_to_the_mission(study, Identity("live", name))
            login = Terminal(server.ssh(name), columns=COLUMNS, rows=ROWS)
            terminals.append(stack.enter_context(login))
            if command is None:
                login.wait_for(BEFORE)
            else:
                _wait(terminals, 0.5)
        if command is None:
            for terminal in terminals:
                _enter(terminal)
        _wait(terminals, 2)
        before = [len(terminal.chunks) for terminal in terminals]
        pressed = _press(terminals, keys)
        pss_mb = fmean(_pss_mb(study.folder)) if command is None else 0.0
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


def _study(folder: Path) -> Study:
    """A study whose missions last four minutes, at pace 20."""
    return small_study(
        folder,
        memorise_seconds="[1, 2]",
        label_seconds="2",
        duration_ms="240000",
        moves_per_second="20",
    )


def _serve_instead(configuration: Path, command: Sequence[str]) -> None:
    words = " ".join(word if word == "&&" else shlex.quote(word) for word in command)
    text = re.sub(
        r"^( *ForceCommand) .*$",
        lambda found: f"{found[1]} {words}",
        configuration.read_text(),
        flags=re.MULTILINE,
    )
    configuration.write_text(text)


class _Here(Exception):
    """Cuts a scripted participant off."""


def _up_to_the_mission(study: Study, identity: Identity) -> None:
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


def _enter(terminal: Terminal) -> None:
    """Begin the mission; the page before it is deaf for a moment."""
    until = time.perf_counter() + 20
    while WITHIN not in terminal.text():
        if time.perf_counter() > until:
            raise TimeoutError(terminal.text())
        terminal.press("enter")
        terminal.read_for(0.3)


def _press(terminals: Sequence[Terminal], keys: Sequence[str]) -> list[list[float]]:
    """Press keys on all of them, out of step; when each was pressed, by terminal."""
    pressed: list[list[float]] = [[] for _ in terminals]
    start, gap_s = time.perf_counter(), 1 / PER_SECOND / len(terminals)
    for number in range(KEYS_EACH * len(terminals)):
        turn, who = divmod(number, len(terminals))
        _wait(terminals, start + number * gap_s - time.perf_counter())
        pressed[who].append(time.perf_counter())
        terminals[who].press(keys[turn % len(keys)])
    _wait(terminals, 0.5)
    return pressed


def _wait(terminals: Sequence[Terminal], seconds: float) -> None:
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
