"""`ana doctor`: can you play on this computer and terminal, and if not, what to do."""

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
    """One thing that was checked. `fail`: it prevents playing; `warn`: it does not."""

    name: str
    status: Status
    found: str
    hint: str = ""


class Report(msgspec.Struct, frozen=True):
    """All checks, in order."""

    playable: bool
    checks: tuple[Check, ...]


@dataclass(frozen=True)
class KeyReading:
    """The bytes that one key press sent, and the time from the first to the last of them."""

    data: bytes
    spread_ms: float


def _check(name: str, ok: bool, found: str, hint: str, otherwise: Status = "fail") -> Check:
    """The check of something that is `ok`, or has the status `otherwise` and needs the hint."""
    return Check(name, "ok", found) if ok else Check(name, otherwise, found, hint)


def check_python(version: tuple[int, int, int]) -> Check:
    """Python 3.11 or newer."""
    hint = "Install Python 3.11 or newer and set up ana with it."
    return _check("python", version >= (3, 11, 0), ".".join(map(str, version)), hint)


def check_terminal(*, interactive: bool, term: str) -> Check:
    """A terminal for input and output that can move its cursor."""
    if not interactive:
        hint = "Run ana in a terminal window, not through a pipe; over ssh, use `ssh -t`."
        return Check("terminal", "fail", "not a terminal", hint)
    known = term not in ("", "dumb", "unknown")
    hint = "Set TERM to your terminal's type, for example TERM=xterm-256color."
    return _check("terminal", known, term if known else f"TERM is {term!r}", hint)


def check_colours(env: Mapping[str, str]) -> Check:
    """How many colours the terminal says it has; any number is playable."""
    found = colours(env)
    if found == "none":
        return Check("colours", "ok", "none (NO_COLOR is set); shapes tell everything apart")
    hint = (
        "Playable; more colours look better. Try TERM=xterm-256color, or COLORTERM=truecolor if "
        "the terminal supports it (over ssh, with SendEnv COLORTERM). In GNU screen, put "
        "`term screen-256color` into .screenrc."
    )
    return _check("colours", found != "16", found, hint, "warn")


def check_size(size: tuple[int, int] | None) -> Check:
    """Columns and rows: `PLAY_SIZE` to play, `STUDY_SIZE` to take part in a study."""
    if size is None:
        hint = "Run ana doctor in the terminal that you will play in."
        return Check("size", "warn", "unknown", hint)
    found, to_play, to_study = ("{} x {}".format(*each) for each in (size, PLAY_SIZE, STUDY_SIZE))
    if size[0] < PLAY_SIZE[0] or size[1] < PLAY_SIZE[1]:
        hint = f"Make the window larger or reduce the font size, to {to_play}."
        return Check("size", "fail", found, hint)
    enough = size[0] >= STUDY_SIZE[0] and size[1] >= STUDY_SIZE[1]
    hint = f"Large enough to play; a study needs {to_study}."
    return _check("size", enough, found, hint, "warn")


def check_encoding(encoding: str) -> Check:
    """The map is drawn in characters that need UTF-8."""
    ok = encoding.lower().replace("-", "").replace("_", "") == "utf8"
    hint = "Use a UTF-8 locale, for example LANG=C.UTF-8, and unset PYTHONIOENCODING."
    return _check("encoding", ok, "UTF-8" if ok else encoding or "unknown", hint)


def check_keys(reading: KeyReading | None, escdelay_ms: float) -> Check:
    """An arrow key's bytes must arrive within `escdelay_ms` (None: no key was read)."""
    if reading is None:
        hint = "Run ana doctor again and press an arrow key."
        return Check("keys", "warn", "no key was pressed", hint)
    name = _ARROWS.get(reading.data)
    if name is None:
        hint = (
            "Run ana doctor again and press one arrow key. If you did, set the terminal to send "
            "xterm keys, or play with WASD or hjkl."
        )
        return Check("keys", "warn", f"{reading.data!r} is not an arrow key", hint)
    whole = reading.spread_ms <= escdelay_ms
    how = "complete within" if whole else "in pieces over"
    hint = f"The connection is slow: set ESCDELAY={2 * round(reading.spread_ms)} (milliseconds)."
    return _check("keys", whole, f"{name} arrow, {how} {reading.spread_ms:.0f} ms", hint)


def check_folder(folder: Path) -> Check:
    """Journals can be written and synced in `folder`, which is created if it is missing."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=folder) as probe:
            probe.write(b"ana\n")
            os.fsync(probe.fileno())
    except OSError as error:
        hint = "Make the folder writable, or choose another one: ana play --log DIR."
        return Check("log folder", "fail", f"{folder}: {error.strerror}", hint)
    return Check("log folder", "ok", str(folder))


def check_space(free_bytes: int) -> Check:
    """Disk space for many sessions."""
    hint = f"Free {FREE_BYTES // 1_000_000} MB, or use another folder: ana play --log DIR."
    return _check("disk", free_bytes >= FREE_BYTES, f"{free_bytes / 1e9:.1f} GB free", hint)


def check_clock(*, monotonic: bool, resolution_s: float) -> Check:
    """Mission times are whole milliseconds of a clock that never goes backwards."""
    found = f"resolution {resolution_s * 1e3:.6f} ms"
    hint = "Play on a computer whose monotonic clock resolves milliseconds."
    return _check("clock", monotonic and resolution_s <= CLOCK_RESOLUTION_S, found, hint)


@contextmanager
def _listening(descriptor: int) -> Iterator[None]:
    """A terminal that passes on each key at once and shows none of them."""
    before = termios.tcgetattr(descriptor)
    tty.setcbreak(descriptor)
    try:
        yield
    finally:
        termios.tcsetattr(descriptor, termios.TCSADRAIN, before)


def _read_key(descriptor: int, *, wait_s: float, pieces_s: float) -> KeyReading | None:
    """One key press from a listening terminal, or None if there is none within `wait_s`.

    Waits up to `pieces_s` after the first byte for the rest of an arrow key.
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
    """Check the environment of this process; `folder` is where journals would go."""
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
        if check.hint:
            yield click.wrap_text(check.hint, PLAY_SIZE[0], _INDENT + "-> ", _INDENT + "   ")
    verdict = "You can play here" if report.playable else "You cannot play here yet"
    yield f"\n{verdict} ({platform.system()} {platform.machine()})."


@click.command("doctor")
@click.option("--json", "as_json", is_flag=True, help="Print the report as JSON.")
@click.option("--keys/--no-keys", default=True, help="Ask for an arrow key (in a terminal).")
def doctor_command(*, as_json: bool, keys: bool) -> int:
    """Check whether you can play on this computer and terminal, and if not, say what to do.

    The exit status is 0 if you can play, else 1.
    """
    report = examine(places.sessions_folder(), ask_key=keys)
    if as_json:
        click.echo(msgspec.json.format(msgspec.json.encode(report), indent=2))
    else:
        click.echo("\n".join(_lines(report)))
    return 0 if report.playable else 1
