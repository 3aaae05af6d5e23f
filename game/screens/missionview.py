"""The bar, the office and the panel: what a mission looks like, whoever plays it."""

from __future__ import annotations

from textual import events
from textual.app import ComposeResult
from textual.containers import Container
from textual.widget import Widget

from game.screens.bar import InstructionBar
from game.screens.minimap import MiniMap, Pins
from game.screens.officeview import OfficeView
from game.screens.status import StatusPanel
from game.world.observation import Observation
from game.world.settings import MissionSettings

MIDDLE_COLUMNS = 110
"""From here on the whole building fits the mini-map in quarter-blocks."""
WIDE_COLUMNS = 180
"""From here on it fits in half-blocks."""
CROWDED_ROWS = 28
"""Below this there is no room for the numbers beside other widgets."""


class MissionView(Container):
    """Draws Observations. `extra`, if any, stands between the numbers and the mini-map.

    A grid without inner containers: each would be composed again at every paint.
    """

    def __init__(self, settings: MissionSettings, extra: Widget | None = None) -> None:
        super().__init__()
        self._extra = [] if extra is None else [extra]
        self.bar = InstructionBar()
        self.office = OfficeView()
        self.status = StatusPanel(settings)
        self.minimap = MiniMap()

    def compose(self) -> ComposeResult:
        yield from (self.bar, self.office, self.status, *self._extra, self.minimap)

    def show(self, observation: Observation, pins: Pins | None = None) -> None:
        """Draw what the rescuer sees now, with `pins` on the mini-map."""
        self.bar.show(observation.guidance)
        self.office.show(observation)
        self.status.show(observation)
        self.minimap.show(observation, pins)

    @property
    def panel_columns(self) -> int:
        return self.status.size.width

    def on_resize(self, event: events.Resize) -> None:
        columns, rows = event.size
        extra = bool(self._extra)
        self.set_class(extra, "extra")
        self.set_class((columns >= MIDDLE_COLUMNS or extra) and columns < WIDE_COLUMNS, "middle")
        self.set_class(columns >= WIDE_COLUMNS, "wide")
        self.set_class(extra and rows < CROWDED_ROWS, "crowded")
