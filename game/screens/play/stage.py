"""The program, as far as they need it who lead from one screen to the next."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Protocol

from textual.geometry import Size
from textual.screen import Screen

from game.errors import AnaError
from game.screens.widgets.preferences import Preferences

if TYPE_CHECKING:
    from game.screens.play.live import LiveMission


class Stage(Protocol):
    """What shows one screen at a time; `live` is the mission that is played now."""

    live: LiveMission | None
    preferences: Preferences

    @property
    def size(self) -> Size: ...

    def replace(self, screen: Screen[Any]) -> None:
        """Show nothing but this screen."""

    def step_back(self) -> None:
        """Back to the home screen if it was the start, otherwise quit."""

    def say_or_fail(self, title: str, error: AnaError) -> None:
        """Tell of an error where the user can go on from; leave with it where nothing is shown."""
