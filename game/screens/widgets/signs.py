"""The keys and the signs of a mission, for pages that explain it."""

from __future__ import annotations

from typing import ClassVar

from game.mission_words import ENGLISH, MissionWords
from game.screens.widgets.canvas import BLANK, Canvas
from game.screens.widgets.glyphs import PLAIN, SOLID, STYLES
from game.screens.widgets.howto import sign_rows, walking_rows
from game.world.settings import MissionSettings


class Signs(Canvas):
    """The keys of a mission and what stands on its screen, drawn as it draws them."""

    COMPONENT_CLASSES: ClassVar[set[str]] = {*STYLES, "key"}

    def __init__(self, rules: MissionSettings, words: MissionWords = ENGLISH) -> None:
        super().__init__(classes="signs")
        self._rules, self._words = rules, words

    def on_mount(self) -> None:
        glyphs = PLAIN if self.app.native_ansi_color else SOLID
        turning = self._rules.controls == "turn"
        keys = walking_rows(turning=turning, words=self._words)
        self.draw([*keys, BLANK, *sign_rows(glyphs, self._rules, self._words)])
