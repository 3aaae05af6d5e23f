"""What the screens of free play come to need, imported while the first one is looked at.

So the first picture waits for nothing that it does not need, and yet nothing is looked for on disk
once a mission is under way, where an upgrade of the program may have put something else.
"""

from __future__ import annotations

from importlib import import_module
from typing import Any

from textual.screen import Screen

from game.screens.widgets.aside import aside

LATER = (
    "concurrent.futures.thread",
    "game.coach.kinds.ana",
    "game.coach.kinds.ana_by_belief",
    "game.coach.kinds.knowledge",
    "game.coach.kinds.pace",
    "game.coach.kinds.static",
    "game.coach.kinds.yoked",
    "game.screens.play.benchmark",
    "game.screens.play.free_play_screen",
    "game.screens.play.home",
    "game.screens.play.journal_list",
    "game.screens.play.map_screen",
    "game.screens.play.replay_screen",
    "game.screens.play.result",
    "game.screens.play.result_card",
    "game.screens.play.settings_screen",
    "game.screens.play.start_screen",
    "game.screens.play.teaching",
    "game.screens.play.watch_screen",
    "game.screens.widgets.howto",
    "game.session.playing",
    "game.world.generation.office",
    "html.entities",
)


def make_ready(screen: Screen[Any]) -> None:
    """Import the rest once `screen` has been painted, without holding it up."""
    screen.call_after_refresh(aside, screen, _import_later, lambda _: None)


def _import_later() -> None:
    for name in LATER:
        import_module(name)
