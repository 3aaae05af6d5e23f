"""The game in a real pseudo-terminal: keys as bytes, signals, and what is left behind."""

from __future__ import annotations

import fcntl
import os
import pty
import re
import select
import signal
import struct
import subprocess
import sys
import termios
import time
from collections.abc import Iterator
from pathlib import Path

import msgspec
import pyte
import pytest

ROOT = Path(__file__).resolve().parents[2]
ENTERED, LEFT = b"\x1b[?1049h", b"\x1b[?1049l"


class Terminal:
    """A pseudo-terminal with `ana play` in it, and what it shows."""

    def __init__(self, folder: Path, *args: str, size: tuple[int, int] = (80, 24)) -> None:
        self.folder = folder
        self.output = b""
        self.controller, terminal = pty.openpty()
        self.resize(*size)
        env = {key: value for key, value in os.environ.items() if key not in _UNSET}
        env |= {"TERM": "xterm-256color", "XDG_CONFIG_HOME": str(folder / "config")}
        command = [sys.executable, "-m", "game", "play", "--now", "--building", "practice"]
        self.process = subprocess.Popen(
            [*command, "--log", str(folder / "logs"), "--coach", "static", *args],
            stdin=terminal, stdout=terminal, stderr=terminal, env=env, cwd=ROOT,
            start_new_session=True,
        )  # fmt: skip
        os.close(terminal)

    def resize(self, columns: int, rows: int) -> None:
        window = struct.pack("HHHH", rows, columns, 0, 0)
        fcntl.ioctl(self.controller, termios.TIOCSWINSZ, window)
        self.size = columns, rows
        if hasattr(self, "process"):
            self.process.send_signal(signal.SIGWINCH)

    def read(self, seconds: float) -> None:
        end = time.monotonic() + seconds
        while (left := end - time.monotonic()) > 0:
            if select.select([self.controller], [], [], left)[0]:
                try:
                    self.output += os.read(self.controller, 65536)
                except OSError:
                    return

    def text(self) -> str:
        screen = pyte.Screen(*self.size)
        stream = pyte.ByteStream(screen)
        for query in (b"\x1b[?2026$p", b"\x1b[?2048$p", b"\x1b[>1u", b"\x1b[<u", b"\x1b[=0u"):
            self.output = self.output.replace(query, b"")
        stream.feed(self.output)
        return "\n".join(screen.display)

    def wait_for(self, text: str, seconds: float = 20) -> None:
        end = time.monotonic() + seconds
        while text not in self.text():
            assert time.monotonic() < end, f"{text!r} never came:\n{self.text()}"
            assert self.process.poll() is None, self.text()
            self.read(0.1)

    def type(self, *pieces: bytes, pause: float = 0.0) -> None:
        for piece in pieces:
            os.write(self.controller, piece)
            self.read(pause)

    def journal(self) -> list[dict[str, object]]:
        (path,) = (self.folder / "logs").glob("*/journal.jsonl")
        lines = path.read_bytes().split(b"\n")[:-1]
        return [msgspec.json.decode(line) for line in lines]

    def of_type(self, kind: str) -> list[dict[str, object]]:
        return [record for record in self.journal() if record["type"] == kind]

    def end(self, seconds: float = 5) -> int:
        """The exit status, as a shell would tell it."""
        stop = time.monotonic() + seconds
        while self.process.poll() is None and time.monotonic() < stop:
            self.read(0.05)
        self.read(0.1)
        return self.process.wait(1)

    def close(self) -> None:
        if self.process.poll() is None:
            self.process.kill()
            self.process.wait()
        os.close(self.controller)


_UNSET = ("COLORTERM", "NO_COLOR", "ESCDELAY", "TEXTUAL_FPS", "COLUMNS", "LINES")


@pytest.fixture
def playing(tmp_path: Path) -> Iterator[Terminal]:
    terminal = Terminal(tmp_path)
    try:
        terminal.wait_for("left")
        terminal.read(0.3)
        yield terminal
    finally:
        terminal.close()


def test_an_arrow_key_in_pieces_is_one_arrow_key(playing: Terminal) -> None:
    playing.type(b"\x1b", b"[", b"A", pause=0.2)
    playing.read(0.6)
    playing.type(b"\x1b", pause=0.4)
    playing.type(b"[D")
    playing.read(0.8)
    assert [record["action"] for record in playing.of_type("acted")] == ["north", "west"]


NO_KEYS = (
    b"\x80",
    b"\xe4 ",
    b"\x9bA",
    b"\x1b[M \x85!",
    b"\x1b[<64;10;10M",
    b"\x1b[?62;1;4c",
    b"\x1b]10;rgb:dddd/aaaa/dddd\x1b\\",
    b"\x1b]11;rgb:dddd/aaaa/dddd\x07",
    b"\x1bP>|XTerm(370)\x1b\\",
    b"\x1b[I\x1b[O",
    b"\x1b[99999999999u",
    b"\x1b[200~kkk jjj\r\x1b[201~",
)


def test_bytes_that_are_no_keys_do_nothing(playing: Terminal) -> None:
    for data in NO_KEYS:
        half = len(data) // 2
        playing.type(data[:half], data[half:], data, pause=0.05)
    playing.type(b"k")
    playing.read(0.5)
    acted = [record["action"] for record in playing.of_type("acted")]
    assert acted == ["triage", "triage", "north"]
    assert "Traceback" not in playing.text()


def test_the_wheel_is_no_key_while_the_game_runs(playing: Terminal) -> None:
    assert playing.output.count(b"\x1b[?1007l") == 1
    playing.type(b"\x03")
    playing.wait_for("Leave the mission?")
    playing.type(b"y")
    assert playing.end() == 0
    assert playing.output.rindex(b"\x1b[?1007h") > playing.output.rindex(b"\x1b[?1007l")


def test_too_small_then_enlarged_goes_on(playing: Terminal) -> None:
    playing.resize(60, 15)
    playing.wait_for("too small: 60 x 15")
    playing.resize(90, 30)
    playing.wait_for("facing")
    playing.type(b"k")
    playing.read(0.5)
    assert len(playing.of_type("acted")) == 1
    assert [len(playing.of_type(kind)) for kind in ("paused", "unpaused")] == [1, 1]


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGHUP])
def test_a_signal_is_recorded_and_leaves_a_clean_terminal(
    playing: Terminal, number: signal.Signals
) -> None:
    playing.type(b"k")
    playing.read(0.3)
    playing.process.send_signal(number)
    assert playing.end() == 128 + number
    assert playing.output.count(ENTERED) == playing.output.count(LEFT) == 1
    assert playing.output.rindex(b"\x1b[?25h") > playing.output.rindex(ENTERED)
    (interruption,) = playing.of_type("interruption")
    assert interruption["signal"] == number.name


def test_a_stalled_terminal_does_not_keep_the_process(playing: Terminal) -> None:
    for _ in range(40):
        os.write(playing.controller, b"\x1b[A\x1b[B")
        time.sleep(0.02)
    acted = len(playing.of_type("acted"))
    assert acted > 0
    playing.process.send_signal(signal.SIGHUP)
    assert playing.process.wait(4) == 128 + signal.SIGHUP
    assert playing.of_type("interruption")


def test_killed_outright_every_action_painted_is_in_the_journal(playing: Terminal) -> None:
    for number in range(1, 4):
        playing.type(b"k")
        playing.read(0.4)
        assert len(playing.of_type("acted")) == number
    playing.process.kill()
    playing.process.wait()
    assert [record["action"] for record in playing.of_type("acted")] == ["north"] * 3


def test_leaving_ends_with_status_0(playing: Terminal) -> None:
    playing.type(b"q")
    playing.wait_for("Leave the mission?")
    playing.type(b"y")
    assert playing.end() == 0
    assert playing.journal()[-1]["type"] == "session_ended"


def test_an_unwritable_log_folder_is_told_after_the_screen_is_left(tmp_path: Path) -> None:
    (tmp_path / "logs").write_text("in the way")
    terminal = Terminal(tmp_path)
    try:
        assert terminal.end(20) == 2
        told = terminal.output.rpartition(LEFT)[2].decode()
        assert "ana: " in told and "logs" in told and "Traceback" not in told
        assert terminal.output.count(ENTERED) == terminal.output.count(LEFT)
    finally:
        terminal.close()


def test_no_colour_means_no_colour_codes(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(f"{__name__}._UNSET", tuple(name for name in _UNSET if name != "NO_COLOR"))
    monkeypatch.setenv("NO_COLOR", "1")
    terminal = Terminal(tmp_path)
    try:
        terminal.wait_for("left")
        terminal.read(0.5)
        codes = {
            code
            for found in re.findall(rb"\x1b\[([0-9;]*)m", terminal.output)
            for code in found.split(b";")
        }
        assert codes <= {b"", b"0", b"1", b"2", b"7", b"22", b"27", b"39", b"49"}, codes
    finally:
        terminal.close()
