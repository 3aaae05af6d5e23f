"""The tutorial as it is gone through: which screen follows which."""

from __future__ import annotations

from collections.abc import Generator
from pathlib import Path

from textual.screen import Screen

from game.errors import AnaError
from game.screens.play.stage import Stage
from game.screens.play.tutorial import LegScreen, Tutorial
from game.screens.widgets.terminal import this_terminal
from game.world.settings import MissionSettings


class Teaching:
    """Shows the tutorial's screens on `stage`, one after the other."""

    def __init__(self, stage: Stage, log_dir: Path, rules: MissionSettings) -> None:
        self._stage = stage
        tutorial = Tutorial(log_dir, this_terminal(*stage.size), rules)
        self._lessons: Generator[Screen[None]] = tutorial.screens()

    def go_on(self) -> None:
        """Show what comes next, or step back after the last."""
        stage = self._stage
        try:
            screen = next(self._lessons, None)
        except AnaError as error:
            stage.say_or_fail("The tutorial cannot go on", error)
            return
        if screen is None:
            self.stop()
            return
        stage.live = screen.live if isinstance(screen, LegScreen) else None
        stage.replace(screen)

    def stop(self) -> None:
        """Leave it."""
        self._lessons.close()
        self._stage.step_back()
