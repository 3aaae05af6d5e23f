"""The bar, the office and the panel: what every mission looks like."""

from __future__ import annotations

from textual.app import ComposeResult
from textual.containers import Container
from textual.geometry import Size
from textual.widget import Widget

from game.mission_words import ENGLISH, MissionWords
from game.screens.widgets.instruction_bar import InstructionBar
from game.screens.widgets.minimap import MiniMap, Pins
from game.screens.widgets.officeview import OfficeView
from game.screens.widgets.statuspanel import StatusPanel
from game.world.observation import Observation
from game.world.settings import MissionSettings

MIDDLE_COLUMNS = 110
"""From here on the whole building fits the mini-map in quarter-blocks."""
WIDE_COLUMNS = 180
"""From here on it fits in half-blocks."""
CROWDED_ROWS = 44
"""Below this another widget leaves the numbers but one row, so that there is room for the whole of
a building 52 cells high on the mini-map, or for more of it."""


class MissionView(Container):
    """Draws Observations. `extra`, if any, stands between the numbers and the mini-map.

    A grid without inner containers: each would be composed again at every paint.
    """

    def __init__(
        self,
        settings: MissionSettings,
        extra: Widget | None = None,
        words: MissionWords = ENGLISH,
    ) -> None:
        super().__init__()
        self._extra = extra
        self.bar = InstructionBar()
        self.office = OfficeView()
        self.status = StatusPanel(settings, words)
        self.minimap = MiniMap()

    def compose(self) -> ComposeResult:
        yield from (self.bar, self.office, self.status)
        if self._extra is not None:
            yield self._extra
        yield self.minimap

    def show(self, observation: Observation, pins: Pins | None = None) -> None:
        """Draw what the rescuer sees now, with `pins` on the mini-map."""
        self.bar.show(observation.guidance)
        self.office.show(observation)
        self.status.show(observation)
        self.minimap.show(observation, pins)

    @property
    def panel_columns(self) -> int:
        return self.status.size.width

    def on_mount(self) -> None:
        self.divide(self.app.size)

    def divide(self, size: Size | None = None) -> None:
        """Divide the space of `size`, or of the widget as it is now, as when the extra widget has
        come or gone."""
        columns, rows = size or self.size
        extra = self._extra is not None and self._extra.display
        self.set_class(extra, "extra")
        self.set_class((columns >= MIDDLE_COLUMNS or extra) and columns < WIDE_COLUMNS, "middle")
        self.set_class(columns >= WIDE_COLUMNS, "wide")
        self.set_class(extra and rows < CROWDED_ROWS, "crowded")

    def on_resize(self) -> None:
        self.divide()
