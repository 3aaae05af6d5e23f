"""What is read from the environment about the terminal's colours, and what is sent then."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

from game.screens.widgets.instruction_bar import FLASH_S
from game.screens.widgets.terminal import colours, ground, this_terminal
from game.screens.widgets.theme import theme_name
from tests.terminal import Terminal


@pytest.mark.parametrize(
    ("environ", "found", "theme"),
    [
        ({}, "16", "ana-terminal"),
        ({"TERM": "linux"}, "16", "ana-terminal"),
        ({"TERM": "xterm-256color"}, "256", "ana-dark-256"),
        ({"TERM": "xterm-kitty"}, "256", "ana-dark-256"),
        ({"TERM": "tmux-256color", "COLORTERM": "truecolor"}, "truecolor", "ana-dark"),
        ({"TERM": "screen", "COLORTERM": "truecolor"}, "16", "ana-terminal"),
        ({"TERM": "screen-256color-bce", "COLORTERM": "24bit"}, "256", "ana-dark-256"),
        ({"TERM": "screen.xterm-256color", "COLORTERM": "truecolor"}, "256", "ana-dark-256"),
        ({"TERM": "xterm", "COLORTERM": " TrueColor "}, "truecolor", "ana-dark"),
        ({"TERM": "xterm", "COLORTERM": "24bit", "COLORFGBG": "0;15"}, "truecolor", "ana-light"),
        (
            {"TERM": "xterm-256color", "COLORTERM": "truecolor", "NO_COLOR": ""},
            "none",
            "ana-terminal",
        ),
    ],
)
def test_colours_and_theme(environ: dict[str, str], found: str, theme: str) -> None:
    assert colours(environ) == found
    assert theme_name(environ) == theme


@pytest.mark.parametrize(
    ("environ", "found"),
    [
        ({"TERM": "screen", "COLORTERM": "truecolor"}, "16"),
        ({"TERM": "screen-256color-bce", "COLORTERM": "truecolor"}, "256"),
        ({"TERM": "xterm", "COLORTERM": "truecolor"}, "truecolor"),
    ],
)
def test_no_more_colours_are_sent_than_there_are(
    tmp_path: Path, environ: dict[str, str], found: str
) -> None:
    command = [
        sys.executable,
        "-m",
        "game",
        "play",
        "--now",
        "--building",
        "practice",
        "--coach",
        "static",
    ]
    with Terminal([*command, "--log", tmp_path], env=environ) as terminal:
        terminal.wait_for("left")
        terminal.read_for(FLASH_S + 0.5)
        terminal.press("q")
        terminal.wait_for("Leave the mission?")
    raw = b"".join(chunk.data for chunk in terminal.chunks)
    assert (b"8;2;" in raw) is (found == "truecolor")
    assert (b"8;5;" in raw) is (found == "256")
    assert (b";43m" in raw) is (found == "16")


def test_the_users_choice_of_ground_counts_more_than_the_terminals() -> None:
    environ = {"TERM": "xterm-256color", "COLORFGBG": "0;default;15"}
    assert ground(environ) == "light"
    assert theme_name(environ, "dark") == "ana-dark-256"


def test_a_terminal_is_described_by_its_own_words(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("TERM", "foot")
    monkeypatch.delenv("COLORTERM", raising=False)
    terminal = this_terminal(120, 40)
    assert (terminal.term, terminal.colorterm) == ("foot", "")
    assert (terminal.columns, terminal.rows) == (120, 40)
