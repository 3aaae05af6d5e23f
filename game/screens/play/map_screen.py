"""The map of the building with its rooms' names, before a mission of free play."""

from __future__ import annotations

from typing import ClassVar

from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.containers import ScrollableContainer
from textual.message import Message
from textual.screen import Screen

from game.journal.clock import Clock, MissionClock, SystemClock
from game.screens.widgets.keyline import KeyLine
from game.screens.widgets.planmap import PlanMap
from game.screens.widgets.timed import TICK_S, TimeLine
from game.world.building import Building


class MapScreen(Screen[None]):
    """Shows the map for `limit_ms`, or until Enter says that it is enough. Its time stands still
    while something else covers it. Where it is larger than the window, the arrows move it."""

    class Seen(Message):
        """The map was shown for so long; None where somebody went back."""

        def __init__(self, shown_ms: int | None) -> None:
            super().__init__()
            self.shown_ms = shown_ms

    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("enter", "enough", "Enough", id="map.enough"),
        Binding("escape,q,Q,ctrl+q,ctrl+c", "back", "Back", id="map.back"),
        Binding("up,k,w", "move(0,-1)", id="map.up"),
        Binding("down,j,s", "move(0,1)", id="map.down"),
        Binding("left,h,a", "move(-1,0)", id="map.left"),
        Binding("right,l,d", "move(1,0)", id="map.right"),
    ]

    def __init__(self, building: Building, limit_ms: int, clock: Clock | None = None) -> None:
        super().__init__()
        self._building = building
        self._limit_ms = limit_ms
        self._clock = MissionClock(clock or SystemClock())
        self._clock.pause()
        self._line = TimeLine(f"Memorise the map of {building.name}", "left", limit_ms)
        self._over = False
        self._frame = ScrollableContainer(can_focus=False, classes="map")

    def compose(self) -> ComposeResult:
        yield self._line
        with self._frame:
            yield PlanMap(self._building)
        yield KeyLine(id="keys")

    def on_mount(self) -> None:
        self.call_after_refresh(self._begin)

    def _begin(self) -> None:
        if self.is_current:
            self._clock.unpause()
        self._name_keys()
        self._tick()
        self.set_interval(TICK_S, self._tick)

    def on_resize(self) -> None:
        self.call_after_refresh(self._name_keys)

    def on_screen_suspend(self) -> None:
        self._clock.pause()

    def on_screen_resume(self) -> None:
        self._clock.unpause()

    def _name_keys(self) -> None:
        larger = self._frame.max_scroll_x or self._frame.max_scroll_y
        move = [("↑↓←→", "move the map")] if larger else []
        self.query_one(KeyLine).set_keys(("Enter", "enough"), *move, ("Q", "back"))

    def _tick(self) -> None:
        seen_ms = min(self._limit_ms, self._clock.now_ms())
        self._line.show(self._limit_ms - seen_ms)
        if seen_ms == self._limit_ms and self.is_current:
            self._finish(seen_ms)

    def _finish(self, shown_ms: int | None) -> None:
        if not self._over:
            self._over = True
            self.app.post_message(self.Seen(shown_ms))

    def action_enough(self) -> None:
        self._finish(min(self._limit_ms, self._clock.now_ms()))

    def action_back(self) -> None:
        self._finish(None)

    def action_move(self, right: int, down: int) -> None:
        self._frame.scroll_relative(8 * right, 4 * down, animate=False)
