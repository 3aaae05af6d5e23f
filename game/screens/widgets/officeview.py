"""The office in the middle of the screen."""

from __future__ import annotations

from typing import ClassVar

from textual import events
from textual.geometry import Offset

from game.screens.widgets.camera import Camera
from game.screens.widgets.canvas import Canvas, Row
from game.screens.widgets.glyphs import PLAIN, SOLID, STYLES
from game.screens.widgets.office import Line, line_row, window_lines
from game.world.observation import Observation


class OfficeView(Canvas):
    """Shows an Observation; the terminal's cursor stands on the rescuer, for screen readers."""

    COMPONENT_CLASSES: ClassVar[set[str]] = {*STYLES, "label"}

    def __init__(self) -> None:
        super().__init__(id="office")
        self._observation: Observation | None = None
        self._camera: Camera | None = None
        self._lines: list[Line] = []

    def show(self, observation: Observation) -> None:
        """Draw what is seen now."""
        self._observation = observation
        columns, rows = self.size.width // 2, self.size.height
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
        known = dict(zip(self._lines, self.rows, strict=False)) if camera == before else {}
        self._lines = window_lines(observation, camera)
        glyphs = PLAIN if self.app.native_ansi_color else SOLID
        fresh: list[Row] = [
            known.get(line) or line_row(line, camera, glyphs) for line in self._lines
        ]
        self.draw(fresh)
        x, y = observation.position
        offset = Offset(2 * (x - camera.left), y - camera.top)
        self.app.cursor_position = self.region.offset + offset

    def notify_style_update(self) -> None:
        super().notify_style_update()
        self._lines = []

    def on_resize(self, event: events.Resize) -> None:
        if self._observation is not None:
            self.show(self._observation)
