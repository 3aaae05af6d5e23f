"""The map to be memorised: the whole time, and then gone by itself."""

from __future__ import annotations

from textual.containers import Center

from game.screens.study.base import Frame, StudyScreen
from game.screens.widgets.planmap import PlanMap
from game.screens.widgets.timed import TICK_S, TimeLine
from game.study.protocol.tasks import Memorising


class MemoriseScreen(StudyScreen[bool]):
    """Shows the map until the exposure is over."""

    def __init__(self, frame: Frame, title: str, task: Memorising) -> None:
        line = TimeLine(title, frame.words.left, task.exposure.limit_ms)
        super().__init__(frame, [line, Center(PlanMap(task.building), classes="middle")])
        self._exposure = task.exposure
        self._line = line

    def cover(self) -> str:
        self._exposure.cover()
        return self.frame.words.clock_stopped

    def uncover(self) -> None:
        self._exposure.uncover()

    def on_mount(self) -> None:
        self.call_after_refresh(self._begin)

    def _begin(self) -> None:
        self._exposure.begin()
        self._tick()
        self.set_interval(TICK_S, self._tick)

    def _tick(self) -> None:
        with self.kept():
            self._exposure.tick()
            self._line.show(self._exposure.left_ms)
            if self._exposure.over:
                self.finish(True)
