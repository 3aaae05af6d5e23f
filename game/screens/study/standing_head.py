"""What stays above a form when its own title has scrolled away."""

from __future__ import annotations

from typing import ClassVar

from game.screens.widgets.canvas import BLANK, Canvas, Row, wrapped

ROWS = 3
MORE = "…"


class StandingHead(Canvas):
    """The title of a form and the heading of the questions in view, a line each; blank while they
    stand on the page themselves."""

    COMPONENT_CLASSES: ClassVar[set[str]] = {"title", "heading"}

    def say(self, title: str, heading: str) -> None:
        """Show both, as far as each has room on its line; of an empty one nothing."""
        rows = [self._line(title, "title"), self._line(heading, "heading")]
        self.draw([*(row for row in rows if row), *([BLANK] * ROWS)][:ROWS])

    def _line(self, text: str, style: str) -> Row:
        lines = wrapped(text, max(10, self.size.width - len(MORE)))
        if not lines:
            return BLANK
        return ((lines[0] + (MORE if len(lines) > 1 else ""), style),)
