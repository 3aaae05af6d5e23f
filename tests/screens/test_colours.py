"""What is read from the environment about the terminal's colours."""

from __future__ import annotations

import pytest

from game.screens.terminal import colours, ground, this_terminal
from game.screens.theme import theme_name


@pytest.mark.parametrize(
    ("environ", "found", "theme"),
    [
        ({}, "16", "ana-terminal"),
        ({"TERM": "linux"}, "16", "ana-terminal"),
        ({"TERM": "xterm-256color"}, "256", "ana-dark"),
        ({"TERM": "xterm-kitty"}, "256", "ana-dark"),
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


def test_the_users_choice_of_ground_counts_more_than_the_terminals() -> None:
    environ = {"TERM": "xterm-256color", "COLORFGBG": "0;default;15"}
    assert ground(environ) == "light"
    assert theme_name(environ, "dark") == "ana-dark"


def test_a_terminal_is_described_by_its_own_words(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("TERM", "foot")
    monkeypatch.delenv("COLORTERM", raising=False)
    terminal = this_terminal(120, 40)
    assert (terminal.term, terminal.colorterm) == ("foot", "")
    assert (terminal.columns, terminal.rows) == (120, 40)
