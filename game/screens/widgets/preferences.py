"""What the home screen remembers from one time to the next."""

from __future__ import annotations

import os
from contextlib import suppress
from pathlib import Path
from typing import Literal

import msgspec
from platformdirs import user_config_path

from game.world.settings import Controls
from game.world.variant import Difficulty, Victims

Ground = Literal["dark", "light"]
Cells = Literal["auto", "normal", "large"]
"""Cells of the office: large ones take 4 x 2 of the terminal's, normal ones 2 x 1; `auto` goes by
the room there is."""


class Preferences(msgspec.Struct, frozen=True):
    """The last choices. `ground` is None while the user has not chosen one."""

    building: Literal["harbour", "foundry", "practice", "generated"] = "harbour"
    """`generated` is another office each time."""
    victims: Victims = "drawn"
    difficulty: Difficulty = "standard"
    coach: Literal["ana", "knowledge", "static-1", "static-2", "static-3"] = "ana"
    ground: Ground | None = None
    controls: Controls = "compass"
    cells: Cells = "auto"
    bell: bool = False
    """Whether new words on the bar ring the terminal's bell."""
    still: bool = False
    """Whether new words stand out by themselves alone, without a flash of the bar."""
    memorise: Literal[0, 60, 180] = 0
    """For how many seconds the map is shown before a mission."""

    def replaced(self, **changes: str | int | None) -> Preferences:
        """These with some choices changed. Raises msgspec.ValidationError for an unknown one."""
        return msgspec.convert(msgspec.to_builtins(self) | changes, Preferences)


USUAL_PREFERENCES = Preferences()


def preferences_file() -> Path:
    """Where they are kept: beside the user's other settings."""
    return user_config_path("ana", appauthor=False) / "home.json"


def keys_file(preferences: Path) -> Path:
    """Where keys are changed: beside the preferences."""
    return preferences.with_name("keys.toml")


def load_preferences(path: Path) -> Preferences:
    """What was kept at `path`; the defaults where there is nothing that can be read."""
    with suppress(OSError, msgspec.DecodeError):
        return msgspec.json.decode(path.read_bytes(), type=Preferences)
    return USUAL_PREFERENCES


def save_preferences(path: Path, preferences: Preferences) -> None:
    """Keep them, where that is possible: a choice forgotten is no reason to stop a game."""
    with suppress(OSError):
        path.parent.mkdir(parents=True, exist_ok=True)
        beside = path.with_suffix(f".{os.getpid()}")
        beside.write_bytes(msgspec.json.encode(preferences))
        beside.replace(path)
