"""The office in the middle of the screen."""

from __future__ import annotations

from typing import ClassVar

from textual import events
from textual.geometry import Offset, Size

from game.screens.widgets.camera import Camera
from game.screens.widgets.canvas import Canvas, Row
from game.screens.widgets.glyphs import LARGE, NORMAL, PLAIN, SOLID, STYLES, rows_of
from game.screens.widgets.office import Line, line_rows, window_lines
from game.screens.widgets.preferences import Cells
from game.screens.widgets.program import Program
from game.world.observation import Observation

LARGE_FROM = Size(80, 46)
"""From this size on, cells are large: 20 x 23 of them are in view, nearly twice the sight."""


class OfficeView(Canvas):
    """Shows an Observation; the terminal's cursor stands on the rescuer, for screen readers."""

    COMPONENT_CLASSES: ClassVar[set[str]] = {*STYLES, "label"}

    def __init__(self) -> None:
        super().__init__(id="office")
        self._wanted: Cells | None = None
        self._cells = NORMAL
        self._observation: Observation | None = None
        self._camera: Camera | None = None
        self._lines: list[Line] = []
        self._drawn: list[tuple[Row, ...]] = []

    def show(self, observation: Observation) -> None:
        """Draw what is seen now."""
        self._observation = observation
        cells = self._cells
        columns, rows = self.size.width // cells.columns, -(-self.size.height // cells.rows)
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
        known = dict(zip(self._lines, self._drawn, strict=True)) if camera == before else {}
        self._lines = window_lines(observation, camera, cells)
        glyphs = rows_of(PLAIN if self.app.native_ansi_color else SOLID, cells)
        self._drawn = [
            known.get(line) or line_rows(line, camera, glyphs, cells) for line in self._lines
        ]
        self.draw([row for rows in self._drawn for row in rows])
        x, y = observation.position
        offset = Offset(cells.columns * (x - camera.left), cells.rows * (y - camera.top))
        self.app.cursor_position = self.region.offset + offset

    def notify_style_update(self) -> None:
        super().notify_style_update()
        self._lines, self._drawn = [], []

    def prefer(self, cells: Cells) -> None:
        """Draw cells of this size from now on, rather than of the program's."""
        self._wanted = cells
        if self.is_mounted:
            self._measure(self.size)

    def on_resize(self, event: events.Resize) -> None:
        self._measure(event.size)

    def _measure(self, size: Size) -> None:
        usual = self.app.cells if isinstance(self.app, Program) else "auto"
        wanted = self._wanted or usual
        roomy = size.width >= LARGE_FROM.width and size.height >= LARGE_FROM.height
        self._cells = LARGE if wanted == "large" or (wanted == "auto" and roomy) else NORMAL
        self._camera, self._lines, self._drawn = None, [], []
        if self._observation is not None:
            self.show(self._observation)
