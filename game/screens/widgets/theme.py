"""Colours: a dark and a light theme of many colours, and one of the terminal's own.

A theme gives the names that the style sheets use; nothing else in the screens names a colour. The
first two exist in each look: a study keeps the one it was made with. Those of today's look have a
version for 256 colours.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Literal

from textual.theme import Theme

from game.screens.widgets.preferences import Ground
from game.screens.widgets.terminal import colours, ground

Look = Literal[1, 2]
"""How the mission looks: a study keeps the look it was made with."""
LOOK: Look = 2
"""The look of today. In look 1, doors were filled, and reds and unseen floor had less contrast."""

_DARK = {
    "dark": "#121316",
    "unseen": "#121316",
    "door-ground": "#d7870f",
    "seen-door-ground": "#875f00",
    "on-red-ground": "#ff5f52",
    "on-blue-ground": "#62b6ff",
    "wall": "#b4b7be",
    "floor": "#44474d",
    "dots": "#7c8087",
    "door": "#d7870f",
    "seen-wall": "#5f6268",
    "seen-floor": "#26272b",
    "seen-door": "#875f00",
    "red": "#ff5f52",
    "blue": "#62b6ff",
    "rescued": "#4fd58a",
    "expired": "#9aa1b0",
    "seen-red": "#c2493f",
    "seen-blue": "#3f86c4",
    "seen-rescued": "#348a5b",
    "seen-expired": "#666d7c",
    "player": "#ffffff",
    "player-tile": "#8a3ffc",
    "treated": "#f5d90a",
    "treated-red": "#a8071a",
    "treated-blue": "#0b3fb5",
    "name": "#f3e9c9",
    "text": "#eaebee",
    "quiet": "#b0b3ba",
    "faint": "#6c7077",
    "hurry": "#d92d20",
    "on-hurry": "#ffffff",
    "bar": "#f5d90a",
    "bar-text": "#000000",
    "bar-fresh": "#fff7b0",
    "notice": "#8f1d12",
    "on-notice": "#ffffff",
    "map-wall": "#4c4f55",
    "map-door": "#875f00",
    "map-floor": "#121316",
    "known-wall": "#b4b7be",
    "known-door": "#d7870f",
    "known-floor": "#303237",
    "trail-0": "#5d5620",
    "trail-1": "#8d811c",
    "trail-2": "#c0ad12",
    "trail-3": "#f5d90a",
    "box": "#1d1e22",
    "line": "#4c4f55",
    "accent": "#f5d90a",
    "on-accent": "#14161b",
    "low": "#ff8a5c",
    "high": "#4fd58a",
}

_LIGHT = {
    "dark": "#e9e5dc",
    "unseen": "#e9e5dc",
    "door-ground": "#d9822b",
    "seen-door-ground": "#cfa878",
    "on-red-ground": "#c8102e",
    "on-blue-ground": "#0b5fc2",
    "wall": "#454c5a",
    "floor": "#ffffff",
    "dots": "#c3beb3",
    "door": "#d9822b",
    "seen-wall": "#a19d93",
    "seen-floor": "#dcd7cb",
    "seen-door": "#cfa878",
    "red": "#c8102e",
    "blue": "#0b5fc2",
    "rescued": "#067a46",
    "expired": "#6b6f78",
    "seen-red": "#b05560",
    "seen-blue": "#5b84b5",
    "seen-rescued": "#548a6d",
    "seen-expired": "#8d8f94",
    "player": "#ffffff",
    "player-tile": "#6929c4",
    "treated": "#f5d90a",
    "treated-red": "#a8071a",
    "treated-blue": "#0b3fb5",
    "name": "#5a3d00",
    "text": "#1d2129",
    "quiet": "#4d535f",
    "faint": "#a19d93",
    "hurry": "#c8102e",
    "on-hurry": "#ffffff",
    "bar": "#f5d90a",
    "bar-text": "#000000",
    "bar-fresh": "#fffbe0",
    "notice": "#8f1d12",
    "on-notice": "#ffffff",
    "map-wall": "#b3aea3",
    "map-door": "#cfa878",
    "map-floor": "#e9e5dc",
    "known-wall": "#454c5a",
    "known-door": "#d9822b",
    "known-floor": "#ffffff",
    "trail-0": "#e6cc93",
    "trail-1": "#cda24e",
    "trail-2": "#a87a16",
    "trail-3": "#754d00",
    "box": "#f5f2ea",
    "line": "#b3aea3",
    "accent": "#8f6a00",
    "on-accent": "#ffffff",
    "low": "#b5460f",
    "high": "#067a46",
}

_DARK_2 = _DARK | {
    "unseen": "#000000",
    "wall": "#c4c7cd",
    "floor": "#37393e",
    "dots": "#9aa0a9",
    "door-ground": "#37393e",
    "seen-wall": "#74777e",
    "seen-floor": "#2e2f33",
    "seen-door": "#a87400",
    "seen-door-ground": "#2e2f33",
    "red": "#ff937e",
    "on-red-ground": "#a8071a",
    "on-blue-ground": "#0b3fb5",
    "expired": "#a9b0bf",
    "seen-red": "#dd7263",
    "seen-blue": "#4a90cd",
    "seen-rescued": "#3f9a68",
    "seen-expired": "#7d8493",
    "known-wall": "#c4c7cd",
    "known-floor": "#383a40",
}
_LIGHT_2 = _LIGHT | {
    "unseen": "#aba69a",
    "door": "#c26a12",
    "door-ground": "#ffffff",
    "seen-wall": "#777369",
    "seen-door": "#9c6222",
    "seen-door-ground": "#dcd7cb",
    "seen-red": "#a03a47",
    "seen-blue": "#3a6ca8",
    "seen-rescued": "#33754f",
    "seen-expired": "#6a6c72",
    "map-wall": "#8d887d",
    "map-door": "#a86d2c",
    "map-floor": "#ccc7bc",
    "known-door": "#c26a12",
}

# The nearest of 256 colours can be too near another: these are entries of xterm's palette that keep
# the distances.
_DARK_256 = _DARK_2 | {
    "red": "#ffaf87",
    "player-tile": "#8700d7",
    "treated-blue": "#000087",
}
_LIGHT_256 = _LIGHT_2 | {
    "box": "#ffffff",
    "red": "#af0000",
    "on-red-ground": "#af0000",
    "treated-blue": "#000087",
    "seen-rescued": "#00875f",
    "wall": "#444444",
    "known-wall": "#444444",
    "player-tile": "#8700d7",
}

_TERMINAL = {
    "dark": "ansi_default",
    "unseen": "ansi_default",
    "door-ground": "ansi_yellow",
    "seen-door-ground": "ansi_default",
    "on-red-ground": "ansi_bright_red",
    "on-blue-ground": "ansi_bright_blue",
    "wall": "ansi_default",
    "floor": "ansi_default",
    "dots": "ansi_default",
    "door": "ansi_yellow",
    "seen-wall": "ansi_bright_black",
    "seen-floor": "ansi_default",
    "seen-door": "ansi_default",
    "red": "ansi_bright_red",
    "blue": "ansi_bright_blue",
    "rescued": "ansi_green",
    "expired": "ansi_bright_black",
    "seen-red": "ansi_bright_red",
    "seen-blue": "ansi_bright_blue",
    "seen-rescued": "ansi_green",
    "seen-expired": "ansi_bright_black",
    "player": "ansi_bright_white",
    "player-tile": "ansi_magenta",
    "treated": "ansi_yellow",
    "treated-red": "ansi_red",
    "treated-blue": "ansi_blue",
    "name": "ansi_magenta",
    "text": "ansi_default",
    "quiet": "ansi_default",
    "faint": "ansi_bright_black",
    "hurry": "ansi_red",
    "on-hurry": "ansi_bright_white",
    "bar": "ansi_yellow",
    "bar-text": "ansi_black",
    "bar-fresh": "ansi_bright_yellow",
    "notice": "ansi_red",
    "on-notice": "ansi_bright_white",
    "map-wall": "ansi_bright_black",
    "map-door": "ansi_default",
    "map-floor": "ansi_default",
    "known-wall": "ansi_default",
    "known-door": "ansi_yellow",
    "known-floor": "ansi_default",
    "trail-0": "ansi_bright_black",
    "trail-1": "ansi_bright_black",
    "trail-2": "ansi_magenta",
    "trail-3": "ansi_magenta",
    "box": "ansi_default",
    "line": "ansi_bright_black",
    "accent": "ansi_default",
    "on-accent": "ansi_default",
    "low": "ansi_red",
    "high": "ansi_green",
}


_TERMINAL_VARIABLES = {
    "ansi-background": "ansi_black",
    "ansi-foreground": "ansi_white",
    "border-blurred": "ansi_default",
    "scrollbar": "ansi_bright_black",
    "scrollbar-hover": "ansi_bright_black",
    "scrollbar-active": "ansi_bright_black",
    "scrollbar-background": "ansi_default",
    "scrollbar-background-hover": "ansi_default",
    "scrollbar-background-active": "ansi_default",
    "block-cursor-foreground": "ansi_black",
    "block-cursor-background": "ansi_white",
    "input-cursor-background": "ansi_black",
    "input-cursor-foreground": "ansi_bright_white",
    "input-cursor-text-style": "none",
    "input-selection-background": "ansi_bright_blue",
    "input-selection-foreground": "ansi_black",
    "screen-selection-background": "ansi_bright_blue",
    "screen-selection-foreground": "ansi_black",
}
"""What Textual's own style sheet asks of a theme that uses the terminal's colours."""


def _theme(name: str, inks: Mapping[str, str], *, dark: bool, ansi: bool = False) -> Theme:
    return Theme(
        name=name,
        primary=inks["accent"],
        secondary=inks["quiet"],
        accent=inks["accent"],
        foreground=inks["text"],
        background=inks["dark"],
        surface=inks["box"],
        panel=inks["box"],
        boost=inks["box"],
        warning=inks["treated"],
        error=inks["red"],
        success=inks["rescued"],
        dark=dark,
        ansi=ansi,
        variables={
            **{f"ana-{key}": value for key, value in inks.items()},
            **(_TERMINAL_VARIABLES if ansi else {}),
        },
    )


THEMES = (
    _theme("ana-dark", _DARK_2, dark=True),
    _theme("ana-light", _LIGHT_2, dark=False),
    _theme("ana-dark-256", _DARK_256, dark=True),
    _theme("ana-light-256", _LIGHT_256, dark=False),
    _theme("ana-dark-1", _DARK, dark=True),
    _theme("ana-light-1", _LIGHT, dark=False),
    _theme("ana-terminal", _TERMINAL, dark=True, ansi=True),
)


def theme_name(environ: Mapping[str, str], wanted: Ground | None = None, look: Look = LOOK) -> str:
    """The theme for this terminal: its own colours where it has 16 or fewer. `wanted` is the user's
    own choice of ground."""
    found = colours(environ)
    if found in ("none", "16"):
        return "ana-terminal"
    kind = f"-{look}" if look != LOOK else "-256" if found == "256" else ""
    return f"ana-{wanted or ground(environ)}{kind}"
