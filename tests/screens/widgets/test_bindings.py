"""The keys of the screens of play."""

from __future__ import annotations

import pytest
from textual.binding import Binding
from textual.screen import Screen

from game.screens.play.home import HomeScreen
from game.screens.play.journal_list import JournalsScreen
from game.screens.play.lesson_screen import LessonScreen
from game.screens.play.map_screen import MapScreen
from game.screens.play.mission_screen import MissionScreen
from game.screens.play.replay_screen import ReplayScreen
from game.screens.play.result import ResultScreen
from game.screens.play.start_screen import StartScreen
from game.screens.play.watch_screen import WatchScreen
from game.screens.widgets.dialogs import Help, Notice, Pause, Question
from game.screens.widgets.howto import HowToScreen

MOVING = frozenset("hjklwasd")
"""Letters that are other names of the arrows."""
SCREENS = [
    Help, HomeScreen, HowToScreen, JournalsScreen, LessonScreen, MapScreen, MissionScreen, Notice,
    Pause, Question, ReplayScreen, ResultScreen, StartScreen, WatchScreen,
]  # fmt: skip


@pytest.mark.parametrize("screen", SCREENS, ids=lambda screen: screen.__name__)
def test_a_letter_means_the_same_with_caps_lock(screen: type[Screen[object]]) -> None:
    bindings = [binding for binding in screen.BINDINGS if isinstance(binding, Binding)]
    assert bindings
    for keys in (binding.key.split(",") for binding in bindings):
        letters = {key for key in keys if len(key) == 1 and key.islower()} - MOVING
        assert {letter.upper() for letter in letters} <= set(keys)
