"""`ana doctor`: can this computer and this terminal play, and what to do where they cannot."""

from __future__ import annotations

import os
import platform
import select
import shutil
import sys
import tempfile
import termios
import time
import tty
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

import click
import msgspec

from game import places
from game.screens.widgets.terminal import colours

Status = Literal["ok", "warn", "fail"]

PLAY_SIZE = (80, 24)
STUDY_SIZE = (120, 40)
ESCDELAY_MS = 500
"""How long the game waits for the rest of a key's bytes, unless ESCDELAY says otherwise."""
FREE_BYTES = 50_000_000
CLOCK_RESOLUTION_S = 0.001
KEY_WAIT_S = 15.0
KEY_PIECES_S = 3.0

_ARROWS = {
    lead + letter: name
    for lead in (b"\x1b[", b"\x1bO")
    for letter, name in ((b"A", "up"), (b"B", "down"), (b"C", "right"), (b"D", "left"))
}


_INDENT = " " * 18


class Check(msgspec.Struct, frozen=True):
    """One thing looked at. `fail` means the game cannot be played so; `warn`, that it can."""

    name: str
    status: Status
    found: str
    mend: str = ""


class Report(msgspec.Struct, frozen=True):
    """All checks, in the order they were made."""

    playable: bool
    checks: tuple[Check, ...]


@dataclass(frozen=True)
class KeyReading:
    """The bytes one key press sent, and the time between its first and its last piece."""

    data: bytes
    spread_ms: float


def check_python(version: tuple[int, int, int]) -> Check:
    """Python 3.11 or newer."""
    found = ".".join(map(str, version))
    if version >= (3, 11, 0):
        return Check("python", "ok", found)
    return Check("python", "fail", found, "Install Python 3.11 or newer and set ana up with it.")


def check_terminal(*, interactive: bool, term: str) -> Check:
    """A terminal that can move its cursor on both ends of the game."""
    if not interactive:
        return Check(
            "terminal",
            "fail",
            "not a terminal",
            "Run ana in a terminal window, not through a pipe; over ssh, use `ssh -t`.",
        )
    if term in ("", "dumb", "unknown"):
        return Check(
            "terminal",
            "fail",
            f"TERM is {term!r}",
            "Set TERM to what your terminal is, such as TERM=xterm-256color.",
        )
    return Check("terminal", "ok", term)


def check_colours(env: Mapping[str, str]) -> Check:
    """How many colours the terminal says it has; every number of them can be played."""
    found = colours(env)
    if found == "none":
        return Check("colours", "ok", "none, as NO_COLOR asks; shapes tell everything apart")
    if found != "16":
        return Check("colours", "ok", found)
    return Check(
        "colours",
        "warn",
        found,
        "It can be played, but looks better with more: put `term screen-256color` into .screenrc, "
        "if this is GNU screen; else set TERM=xterm-256color, or COLORTERM=truecolor if the "
        "terminal has it (ssh passes it on only by SendEnv).",
    )


def check_size(size: tuple[int, int] | None) -> Check:
    """Columns and rows: `PLAY_SIZE` to play, `STUDY_SIZE` for a session of a study."""
    if size is None:
        return Check("size", "warn", "unknown", "Run ana doctor in the terminal you will play in.")
    found = f"{size[0]} x {size[1]}"
    if size[0] < PLAY_SIZE[0] or size[1] < PLAY_SIZE[1]:
        return Check(
            "size",
            "fail",
            found,
            f"Enlarge the window, or make its letters smaller, to {PLAY_SIZE[0]} x {PLAY_SIZE[1]}.",
        )
    if size[0] < STUDY_SIZE[0] or size[1] < STUDY_SIZE[1]:
        return Check(
            "size",
            "warn",
            found,
            f"Enough to play; for a study enlarge it to {STUDY_SIZE[0]} x {STUDY_SIZE[1]}.",
        )
    return Check("size", "ok", found)


def check_encoding(encoding: str) -> Check:
    """The map is drawn in characters that only UTF-8 carries."""
    if encoding.lower().replace("-", "").replace("_", "") == "utf8":
        return Check("encoding", "ok", "UTF-8")
    return Check(
        "encoding",
        "fail",
        encoding or "unknown",
        "Use a UTF-8 locale, such as LANG=C.UTF-8, and leave PYTHONIOENCODING unset.",
    )


def check_keys(reading: KeyReading | None, escdelay_ms: float) -> Check:
    """An arrow key's bytes must arrive within `escdelay_ms` (None: no key was read)."""
    if reading is None:
        return Check("keys", "warn", "no key came", "Run ana doctor again and press an arrow key.")
    name = _ARROWS.get(reading.data)
    if name is None:
        return Check(
            "keys",
            "warn",
            f"{reading.data!r} is no arrow key",
            "Run ana doctor again and press one arrow key; if you did, set the terminal's keys to "
            "those of xterm, or play with WASD or hjkl.",
        )
    spread = f"{reading.spread_ms:.0f} ms"
    if reading.spread_ms > escdelay_ms:
        return Check(
            "keys",
            "fail",
            f"the {name} arrow came in pieces over {spread}",
            f"The link is slow: set ESCDELAY={2 * round(reading.spread_ms)} (milliseconds).",
        )
    return Check("keys", "ok", f"{name} arrow, whole within {spread}")


def check_folder(folder: Path) -> Check:
    """Journals can be written and made durable in `folder`, which is created if it is missing."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=folder) as probe:
            probe.write(b"ana\n")
            os.fsync(probe.fileno())
    except OSError as error:
        return Check(
            "log folder",
            "fail",
            f"{folder}: {error.strerror}",
            "Make the folder writable, or choose another: ana play --log DIR.",
        )
    return Check("log folder", "ok", str(folder))


def check_space(free_bytes: int) -> Check:
    """Room on the disk for many sessions."""
    found = f"{free_bytes / 1e9:.1f} GB free"
    if free_bytes >= FREE_BYTES:
        return Check("disk", "ok", found)
    mend = f"Free at least {FREE_BYTES // 1_000_000} MB, or choose another: ana play --log DIR."
    return Check("disk", "fail", found, mend)


def check_clock(*, monotonic: bool, resolution_s: float) -> Check:
    """Mission times are whole milliseconds of a clock that never goes back."""
    found = f"resolution {resolution_s * 1e3:.6f} ms"
    if monotonic and resolution_s <= CLOCK_RESOLUTION_S:
        return Check("clock", "ok", found)
    return Check("clock", "fail", found, "Play on a computer whose monotonic clock counts in ms.")


@contextmanager
def _listening(descriptor: int) -> Iterator[None]:
    """A terminal that hands keys on one by one and shows none of them."""
    before = termios.tcgetattr(descriptor)
    tty.setcbreak(descriptor)
    try:
        yield
    finally:
        termios.tcsetattr(descriptor, termios.TCSADRAIN, before)


def _read_key(descriptor: int, *, wait_s: float, pieces_s: float) -> KeyReading | None:
    """One key press from a listening terminal, or None if none comes within `wait_s`.

    Bytes that may still become an arrow key are waited for, up to `pieces_s` after the first.
    """
    if not select.select([descriptor], [], [], wait_s)[0]:
        return None
    data = os.read(descriptor, 32)
    first = last = time.monotonic()
    while any(arrow != data and arrow.startswith(data) for arrow in _ARROWS):
        left_s = max(0.0, first + pieces_s - time.monotonic())
        if not select.select([descriptor], [], [], left_s)[0]:
            break
        data += os.read(descriptor, 32)
        last = time.monotonic()
    return KeyReading(data, (last - first) * 1e3)


def examine(folder: Path, *, ask_key: bool) -> Report:
    """Look at this process's own surroundings; `folder` is where journals would go."""
    env = os.environ
    interactive = sys.stdin.isatty() and sys.stderr.isatty()
    clock = time.get_clock_info("monotonic")
    checks = [
        check_python(sys.version_info[:3]),
        check_terminal(interactive=interactive, term=env.get("TERM", "")),
        check_colours(env),
        check_size(_terminal_size()),
        check_encoding(sys.stderr.encoding),
        check_folder(folder),
        check_space(shutil.disk_usage(_nearest_existing(folder)).free),
        check_clock(monotonic=clock.monotonic, resolution_s=clock.resolution),
    ]
    if ask_key and interactive:
        checks.append(check_keys(_ask_for_arrow(), _escdelay_ms(env)))
    return Report(all(check.status != "fail" for check in checks), tuple(checks))


def _ask_for_arrow() -> KeyReading | None:
    terminal = sys.stdin.fileno()
    with _listening(terminal):
        click.echo("Press an arrow key ...", err=True)
        return _read_key(terminal, wait_s=KEY_WAIT_S, pieces_s=KEY_PIECES_S)


def _escdelay_ms(env: Mapping[str, str]) -> int:
    given = env.get("ESCDELAY", "")
    return int(given) if given.isdecimal() else ESCDELAY_MS


def _terminal_size() -> tuple[int, int] | None:
    for stream in (sys.stderr, sys.stdin, sys.stdout):
        try:
            size = os.get_terminal_size(stream.fileno())
        except (OSError, ValueError):
            continue
        return size.columns, size.lines
    return None


def _nearest_existing(folder: Path) -> Path:
    return next(path for path in (folder, *folder.parents) if path.exists())


def _lines(report: Report) -> Iterable[str]:
    colour = {"ok": "green", "warn": "yellow", "fail": "red"}
    for check in report.checks:
        mark = click.style(f"{check.status:<4}", fg=colour[check.status])
        yield f"{mark}  {check.name:<10}  {check.found}"
        if check.mend:
            yield click.wrap_text(check.mend, PLAY_SIZE[0], _INDENT + "-> ", _INDENT + "   ")
    verdict = "This can be played" if report.playable else "This cannot be played yet"
    yield f"\n{verdict} ({platform.system()} {platform.machine()})."


@click.command("doctor")
@click.option("--json", "as_json", is_flag=True, help="Print the report as JSON.")
@click.option("--keys/--no-keys", default=True, help="Ask for an arrow key, in a terminal.")
def command(*, as_json: bool, keys: bool) -> int:
    """Check that this computer and terminal can play, and say what to do where they cannot.

    The exit status is 0 when the game can be played, else 1.
    """
    report = examine(places.sessions_folder(), ask_key=keys)
    if as_json:
        click.echo(msgspec.json.format(msgspec.json.encode(report), indent=2))
    else:
        click.echo("\n".join(_lines(report)))
    return 0 if report.playable else 1
