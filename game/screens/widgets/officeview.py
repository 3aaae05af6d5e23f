"""The office in the middle of the screen."""

from __future__ import annotations

from typing import ClassVar

from textual import events
from textual.geometry import Offset

from game.screens.widgets.camera import Camera
from game.screens.widgets.canvas import Canvas, Row
from game.screens.widgets.glyphs import PLAIN, SOLID, STYLES
from game.screens.widgets.large_office import COLUMNS, ROWS, large_rows
from game.screens.widgets.office import Line, line_row, window_lines
from game.screens.widgets.preferences import CellSize
from game.world.observation import Observation

ROOMY = (24, 24)
"""Columns and rows of large cells from which on they are drawn by themselves."""
LEAST_LARGE = (15, 11)
"""Fewer show less than the rescuer sees."""


def cell_size(wanted: CellSize, columns: int, rows: int) -> tuple[int, int]:
    """Columns and rows of a cell in a view of this size."""
    if wanted != "small":
        least = ROOMY if wanted == "auto" else LEAST_LARGE
        if columns // COLUMNS >= least[0] and rows // ROWS >= least[1]:
            return COLUMNS, ROWS
    return 2, 1


class OfficeView(Canvas):
    """Shows an Observation; the terminal's cursor stands on the rescuer, for screen readers."""

    COMPONENT_CLASSES: ClassVar[set[str]] = {*STYLES, "label"}

    def __init__(self) -> None:
        super().__init__(id="office")
        self.cells: CellSize = "small"
        """How large cells are drawn."""
        self._observation: Observation | None = None
        self._camera: Camera | None = None
        self._lines: list[Line] = []
        self._drawn: dict[Line, tuple[Row, ...]] = {}

    def show(self, observation: Observation) -> None:
        """Draw what is seen now."""
        self._observation = observation
        wide, high = cell_size(self.cells, self.size.width, self.size.height)
        columns, rows = self.size.width // wide, self.size.height // high
        if not columns or not rows:
            return
        plan = observation.plan
        plan_size = (plan.width, plan.height)
        before = self._camera
        if before is None or (before.columns, before.rows) != (columns, rows):
            camera = Camera.centred(columns, rows, observation.position, plan_size)
        else:
            camera = before.follow(observation.position, plan_size)
        self._camera = camera
        known = self._drawn if camera == before else {}
        self._lines = window_lines(observation, camera)
        glyphs = PLAIN if self.app.native_ansi_color else SOLID
        large = high == ROWS
        self._drawn = {
            line: known.get(line)
            or (large_rows(line, camera, glyphs) if large else (line_row(line, camera, glyphs),))
            for line in self._lines
        }
        self.draw([row for line in self._lines for row in self._drawn[line]])
        x, y = observation.position
        offset = Offset(wide * (x - camera.left), high * (y - camera.top))
        self.app.cursor_position = self.region.offset + offset

    def notify_style_update(self) -> None:
        super().notify_style_update()
        self._drawn = {}

    def on_resize(self, event: events.Resize) -> None:
        if self._observation is not None:
            self.show(self._observation)
