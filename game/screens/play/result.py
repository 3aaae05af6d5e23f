"""The page after a mission: totals, the way walked, rescues and levels over time."""

from __future__ import annotations

from pathlib import Path
from typing import ClassVar

from textual import events
from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.containers import VerticalScroll
from textual.message import Message
from textual.screen import Screen

from game.screens.play.mission_story import Fate, MissionStory
from game.screens.play.pathmap import legend_row, path_map, victim_pin
from game.screens.widgets.canvas import BLANK, Canvas, Row, beside, width
from game.screens.widgets.charts import area_chart, step_chart
from game.screens.widgets.keyline import KeyLine
from game.screens.widgets.minimap import PIN_STYLES, STYLES
from game.screens.widgets.statuspanel import clock_text
from game.world.building import Severity
from game.world.observation import VictimState

DEAF_S = 0.8
"""For so long keys do nothing, since the last ones were meant for the mission."""
NARROWEST_CHART = 26
HIGHEST_CHART = 24
_LOW_CHART = 5
_LEVEL_ROWS = ((9, 3), (16, 5), (30, 7))
"""Below how many rows for both charts the one of levels has how many: odd, so that C2 is halfway.
"""
_FRAME_ROWS = 3
"""What a chart takes besides its lines: title, axis and times."""
_FATE_COLUMNS = 31
_BELOW_ROWS = 2
"""What stands under the page: where the journal is, and the keys."""
_WAITING = VictimState.WAITING
_NAMES = {1: "C1", 2: "C2", 3: "C3"}


def rescue_chart(story: MissionStory, columns: int, rows: int) -> list[Row]:
    """Rescued victims over the mission's time."""
    return area_chart(
        "Rescued",
        story.rescues,
        max(4, story.rescued),
        story.until_ms,
        story.settings.duration_ms,
        columns=columns,
        rows=rows,
    )


def level_chart(story: MissionStory, columns: int, rows: int) -> list[Row]:
    """The level of the coach's words over time, as in the paper's Fig. 10."""
    return step_chart(
        "Level of the coach",
        story.levels,
        [(level, _NAMES[level]) for level in (1, 2, 3)],
        story.until_ms,
        story.settings.duration_ms,
        columns=columns,
        rows=rows,
    )


def constant_level(story: MissionStory) -> Row | None:
    """The level of the coach's words where it never changed, in words."""
    levels = {step.value for step in story.levels}
    if len(levels) > 1:
        return None
    said = f"stayed at {_NAMES[levels.pop()]}" if levels else "said nothing"
    return ((f"The coach {said}.", "quiet"),)


def total_rows(story: MissionStory) -> list[Row]:
    """What it came to, in words."""
    saved = {severity: story.count(severity, VictimState.RESCUED) for severity in Severity}
    lost = story.count(Severity.RED, VictimState.EXPIRED)
    total = len(story.building.victims)
    first: Row = (
        (f"{story.rescued} of {total} rescued", "big"),
        (f"   {saved[Severity.RED]} red, {saved[Severity.BLUE]} blue", "quiet"),
        (f"   {lost} not reached in time" if lost else "", "quiet"),
        ("   unseen victims are not shown" if len(story.revealed) < total else "", "quiet"),
    )
    if story.settings.show_score:
        first = (*first, (f"   {story.score} points", "big"))
    moves = len(story.path) - 1
    told = f"steps {moves} · instructions {story.instructions} · missteps {story.missteps}"
    left = f"Left after {clock_text(story.until_ms)}. " if story.left else ""
    where = ", ".join(filter(None, (story.building.name, story.unusual)))
    return [first, ((left, "big"), (f"{where} · {told}", "quiet"))]


def fate_rows(story: MissionStory, columns: int) -> list[Row]:
    """Whom the rescuer reached and when, then who was not reached in time and who still waits, in
    as many columns as fit."""
    order = (VictimState.RESCUED, VictimState.EXPIRED, VictimState.WAITING)
    fates = sorted(
        (fate for fate in story.fates.values() if fate.victim.id in story.revealed),
        key=lambda fate: (order.index(fate.state), fate.at_ms or 0, fate.victim.id),
    )
    across = max(1, columns // _FATE_COLUMNS)
    down = -(-len(fates) // across) or 1
    rows: list[Row] = []
    for first in range(0, len(fates), down):
        lines = [
            _fate_row(story, fate, min(columns, _FATE_COLUMNS))
            for fate in fates[first : first + down]
        ]
        rows = beside(rows, lines, first // down * _FATE_COLUMNS) if rows else lines
    return rows


def _fate_row(story: MissionStory, fate: Fate, columns: int) -> Row:
    site, reached = fate.victim, fate.state is VictimState.RESCUED
    room = story.building.room_of(site)
    name = room.name if room is not None else "hallway"
    at = clock_text(fate.at_ms) if fate.at_ms is not None else ""
    (mark, ink), (victim, colour) = victim_pin(site, fate.state), victim_pin(site, _WAITING)
    return (
        (mark if fate.at_ms is not None else " ", f"{ink}/dark"),
        (" ", ""), (victim, f"{colour}/dark"),
        (f" {at:>4}  ", "quiet"), (name[: columns - 11], "strong" if reached else "quiet"),
    )  # fmt: skip


def result_rows(story: MissionStory, columns: int, rows: int, *, filled: bool) -> list[Row]:
    """The whole page, `columns` wide; what matters most is within the first `rows`."""
    area = [*path_map(story, columns=columns, filled=filled), legend_row(story)]
    area_columns = max(map(width, area)) + 2
    head = [BLANK, *total_rows(story), BLANK]
    constant = constant_level(story)
    wide = columns - area_columns
    if wide >= NARROWEST_CHART:
        right = _beside_the_map(story, wide, rows - len(head), constant)
        left = area if constant else [*area, BLANK, *fate_rows(story, area_columns - 2)]
        return head + beside(left, right, area_columns)
    if constant is not None:
        across = max(1, (columns - NARROWEST_CHART - 1) // _FATE_COLUMNS)
        wide = columns - across * _FATE_COLUMNS
        chart = [*rescue_chart(story, wide - 2, _LOW_CHART), BLANK, constant]
        lower = beside(chart, fate_rows(story, columns - wide), wide)
        return [*head[1:], *area, *lower]
    half = columns // 2
    charts = beside(
        rescue_chart(story, half - 2, _LOW_CHART), level_chart(story, half - 1, _LOW_CHART), half
    )
    return [*head[1:], *area, *charts, BLANK, *fate_rows(story, columns)]


def _beside_the_map(story: MissionStory, wide: int, rows: int, constant: Row | None) -> list[Row]:
    """Both charts, one below the other, over `rows`; where the level is `constant`, the rescues
    one by one in place of its chart."""
    if constant is not None:
        listed = [BLANK, constant, BLANK, *fate_rows(story, wide)]
        high = max(_LOW_CHART, min(HIGHEST_CHART, rows - _FRAME_ROWS - len(listed)))
        return [*rescue_chart(story, wide, high), *listed]
    lines = rows - 2 * _FRAME_ROWS - 1
    low = next((low for below, low in _LEVEL_ROWS if lines < below), 9)
    high = max(3, min(HIGHEST_CHART, lines - low))
    return [*rescue_chart(story, wide, high), BLANK, *level_chart(story, wide, low)]


class ResultPage(Canvas):
    """The page as a widget."""

    COMPONENT_CLASSES: ClassVar[set[str]] = {
        *STYLES, *PIN_STYLES, "title", "quiet", "strong", "faint", "line", "area", "big",
    }  # fmt: skip

    def __init__(self, story: MissionStory) -> None:
        super().__init__()
        self._story = story

    def on_resize(self, event: events.Resize) -> None:
        filled = not self.app.native_ansi_color
        rows = self.screen.size.height - _BELOW_ROWS
        self.draw(result_rows(self._story, event.size.width, rows, filled=filled))


class ResultScreen(Screen[None]):
    """Shows a finished mission and where its journal is."""

    class Wanted(Message):
        """What to do next: `again`, `replay` or `home`."""

        def __init__(self, what: str, journal: Path) -> None:
            super().__init__()
            self.what = what
            self.journal = journal

    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("enter,a,A", "want('again')", "Play again", id="result.again"),
        Binding("r,R", "want('replay')", "Replay this", id="result.replay"),
        Binding("escape,q,Q,h,H", "want('home')", "Home", id="result.home"),
    ]

    def __init__(self, story: MissionStory, journal: Path) -> None:
        super().__init__()
        self._story = story
        self._journal = journal
        self._deaf = True

    def compose(self) -> ComposeResult:
        with VerticalScroll(classes="page"):
            yield ResultPage(self._story)
        yield Canvas([((f" Journal: {self._journal}", ""),)], id="where")
        yield KeyLine(
            ("Enter", "play again"), ("R", "replay this"), ("H", "home"), ("↑ ↓", "scroll"),
            id="keys",
        )  # fmt: skip

    def on_mount(self) -> None:
        self.set_timer(DEAF_S, self._listen)

    def _listen(self) -> None:
        self._deaf = False

    def action_want(self, what: str) -> None:
        if not self._deaf:
            self.app.post_message(self.Wanted(what, self._journal))
