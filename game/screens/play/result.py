"""The page after a mission: totals, the way walked, rescues and levels over time."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import ClassVar

from rich.cells import cell_len
from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.containers import VerticalScroll
from textual.message import Message
from textual.screen import Screen

from game.journal.folders import newest_journals
from game.places import shortened
from game.screens.play.benchmark import literal_rescues
from game.screens.play.mission_story import Fate, MissionStory
from game.screens.play.past_missions import (
    past_mission,
    past_missions,
    standing,
)
from game.screens.play.pathmap import fates_legend, path_map, victim_pin, way_legend
from game.screens.widgets.aside import aside
from game.screens.widgets.canvas import BLANK, Canvas, Row, Run, beside, width, wrapped
from game.screens.widgets.charts import area_chart, step_chart
from game.screens.widgets.keyline import KeyLine
from game.screens.widgets.minimap import PIN_STYLES, STYLES
from game.screens.widgets.pointing import ClickCanvas, Pointed, RowClicked
from game.screens.widgets.statuspanel import clock_text
from game.screens.widgets.stillness import DeafAtFirst
from game.world.building import Severity
from game.world.observation import VictimState

NARROWEST_CHART = 26
HIGHEST_CHART = 24
_LOW_CHART = 5
_LEVEL_ROWS = ((9, 3), (16, 5), (30, 7))
"""Below how many rows for both charts the one of levels has how many: odd, so that C2 is halfway.
"""
_FRAME_ROWS = 3
"""What a chart takes besides its lines: title, axis and times."""
_FATE_COLUMNS = 31
_AROUND_ROWS = 2
"""What stands around the page: the names of the pages, and the keys."""
_MARGIN_COLUMNS = 3
_SCROLLBAR_COLUMNS = 1
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
        (f"   {lost} died, not reached in time" if lost else "", "quiet"),
        ("   unseen victims are not shown" if len(story.revealed) < total else "", "quiet"),
    )
    if story.settings.show_score:
        first = (*first, (f"   {story.score} points", "big"))
    moves = len(story.path) - 1
    told = f"steps {moves} · instructions {story.instructions} · missteps {story.missteps}"
    where = ", ".join(filter(None, (story.building.name, story.unusual)))
    rows: list[Row] = [first, ((f"{where} · {told}", "quiet"),)]
    if story.left:
        rows.insert(1, ((f"Left after {clock_text(story.until_ms)}.", "big"),))
    return rows


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


def result_rows(
    story: MissionStory,
    columns: int,
    rows: int,
    *,
    filled: bool,
    remarks: Sequence[Row] = (),
) -> list[Row]:
    """The first page, `columns` wide, within `rows` wherever they can hold it; `remarks` stand
    under the totals. Where the way walked does not fit, it has a page of its own."""
    head = [*total_rows(story), *remarks]
    area = fitting_way(story, columns, rows - len(head), filled=filled)
    constant = constant_level(story)
    if area is None:
        lines = max(3, rows - len(head) - 2 - _FRAME_ROWS)
        return [BLANK, *head, BLANK, *_charts(story, columns, lines, constant)]
    area_columns = max(map(width, area)) + 2
    wide = columns - area_columns
    if wide < NARROWEST_CHART:
        lines = rows - len(head) - len(area) - _FRAME_ROWS
        return [*head, *area, *_charts(story, columns, lines, constant)]
    if len(head) + len(area) + 2 <= rows:
        head = [BLANK, *head, BLANK]
    lines = rows - len(head)
    beneath = lines - len(area) - 1
    if constant:
        more = _as_fits(said_rows(story, area_columns - 2), beneath, "Said")
    else:
        more = _as_fits(fate_rows(story, area_columns - 2), beneath, "People")
    left = [*area, BLANK, *more][:lines]
    right = _beside_the_map(story, wide, lines, constant)[:lines]
    return head + beside(left, right, area_columns)


def way_rows(story: MissionStory, columns: int, *, filled: bool) -> list[Row]:
    """The map with the way walked, and what its signs mean, no wider than the map."""
    way = path_map(story, columns=columns, filled=filled)
    across = max(map(width, way))
    return [*way_legend(story, across, filled=filled), *way]


def fitting_way(story: MissionStory, columns: int, rows: int, *, filled: bool) -> list[Row] | None:
    """The map as it stands on the first page, with charts beside it or below it: with names if
    that fits, else smaller, else not at all."""
    for most in (columns, min(columns, story.building.plan.width - 1)):
        area = way_rows(story, most, filled=filled)
        beside_it = columns - max(map(width, area)) - 2 >= NARROWEST_CHART
        if len(area) + (0 if beside_it else _LOW_CHART + _FRAME_ROWS) <= rows:
            return area
    return None


def _charts(story: MissionStory, columns: int, lines: int, constant: Row | None) -> list[Row]:
    """Both charts side by side, `lines` high without title and axis; where the level is
    `constant`, the rescues one by one in place of its chart."""
    lines = min(HIGHEST_CHART, lines)
    if constant is not None:
        across = max(1, (columns - NARROWEST_CHART - 1) // _FATE_COLUMNS)
        wide = columns - across * _FATE_COLUMNS
        chart = [*rescue_chart(story, wide - 2, max(3, lines - 2)), BLANK, constant]
        listed = _as_fits(fate_rows(story, columns - wide), lines + _FRAME_ROWS, "People")
        return beside(chart, listed, wide)
    half = columns // 2
    return beside(rescue_chart(story, half - 2, lines), level_chart(story, half - 1, lines), half)


def _as_fits(listed: list[Row], rows: int, page: str) -> list[Row]:
    """A list in so many rows; where it takes more, the last says on which page all of it is."""
    if len(listed) <= rows:
        return listed
    return [*listed[: max(0, rows - 1)], ((f"… all on the page {page}", "quiet"),)][: max(0, rows)]


def said_rows(story: MissionStory, columns: int) -> list[Row]:
    """What stood on the bar, when, and at which level."""
    rows: list[Row] = []
    for said in story.said:
        at, level = f"{clock_text(said.at_ms):>5}  ", f"{_NAMES[said.level]}  "
        lines = wrapped(said.text, max(20, columns - len(at) - len(level)))
        for line in wrapped(said.notice, max(20, columns - len(at) - len(level))):
            rows.append(((at, "quiet"), (" " * len(level), ""), (line, "notice")))
            at = " " * len(at)
        for line in lines:
            rows.append(((at, "quiet"), (level, "quiet"), (line, "strong")))
            at, level = " " * len(at), " " * len(level)
    return rows or [(("The coach said nothing.", "quiet"),)]


def result_pages(
    story: MissionStory,
    columns: int,
    rows: int,
    *,
    filled: bool,
    remarks: Sequence[Row] = (),
) -> dict[str, list[Row]]:
    """All pages by name; the first holds what matters most."""
    first = result_rows(story, columns, rows, filled=filled, remarks=remarks)
    pages = {"Result": first}
    left = rows - len(total_rows(story)) - len(remarks)
    if fitting_way(story, columns, left, filled=filled) is None:
        pages["Way"] = way_rows(story, columns, filled=filled)
    narrow = columns - _SCROLLBAR_COLUMNS
    pages["People"] = [BLANK, *fates_legend(story, narrow), BLANK, *fate_rows(story, narrow)]
    pages["Said"] = [BLANK, *said_rows(story, narrow)]
    return pages


def _beside_the_map(story: MissionStory, wide: int, rows: int, constant: Row | None) -> list[Row]:
    """Both charts, one below the other, over `rows`; where the level is `constant`, the rescues
    one by one in place of its chart."""
    if constant is not None:
        fates = fate_rows(story, wide)
        high = max(_LOW_CHART, min(HIGHEST_CHART, rows - 2 * _FRAME_ROWS - len(fates)))
        fates = _as_fits(fates, rows - 2 * _FRAME_ROWS - high, "People")
        return [*rescue_chart(story, wide, high), BLANK, constant, BLANK, *fates]
    lines = rows - 2 * _FRAME_ROWS - 1
    low = next((low for below, low in _LEVEL_ROWS if lines < below), 9)
    high = max(3, min(HIGHEST_CHART, lines - low))
    return [*rescue_chart(story, wide, high), BLANK, *level_chart(story, wide, low)]


class ResultPage(Canvas):
    """One of the pages as a widget."""

    COMPONENT_CLASSES: ClassVar[set[str]] = {
        *STYLES, *PIN_STYLES, "title", "quiet", "strong", "faint", "line", "area", "big", "notice",
    }  # fmt: skip


class PageNames(ClickCanvas):
    """The names of the pages, of which one is shown, and where the journal is: its path, or only
    the name of its folder where that does not fit."""

    COMPONENT_CLASSES: ClassVar[set[str]] = {"item", "selected"}

    def __init__(self, journal: Path) -> None:
        super().__init__(id="page-names")
        self._places = shortened(journal), journal.parent.name

    def name_at(self, column: int) -> str | None:
        """The name of a page at a column."""
        return next((name for name, end in self._ends.items() if column < end), None)

    def show(self, names: Sequence[str], shown: str) -> None:
        """Let the name of the page that is shown stand out."""
        row: list[Run] = [("  ", "item")]
        self._ends: dict[str, int] = {}
        for name in names:
            row += [(f" {name} ", "selected" if name == shown else "item"), (" ", "item")]
            self._ends[name] = width(tuple(row))
        room = self.size.width - width(tuple(row)) - 2
        place = next((it for it in self._places if cell_len(it) <= room), "")
        row.append((f"{place:>{max(0, room)}}", "item"))
        self.draw([tuple(row)])


class ResultScreen(DeafAtFirst, Pointed, Screen[None]):
    """Shows a finished mission on a few pages: totals and charts, the way, people, words."""

    class Wanted(Message):
        """What to do next: `again`, `replay`, `card` or `home`."""

        def __init__(self, what: str, sender: ResultScreen) -> None:
            super().__init__()
            self.what = what
            self.sender = sender

    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("enter,a,A", "want('again')", "Play again", id="result.again"),
        Binding("r,R", "want('replay')", "Replay this", id="result.replay"),
        Binding("c,C", "want('card')", "Card", id="result.card"),
        Binding("escape,q,Q,h,H,ctrl+q,ctrl+c", "want('home')", "Home", id="result.home"),
        Binding("right,tab", "turn(1)", "Next page", id="result.next"),
        Binding("left,shift+tab", "turn(-1)", "Page before", id="result.before"),
        Binding("down,j", "scroll(1)", id="result.down"),
        Binding("up,k", "scroll(-1)", id="result.up"),
        Binding("pagedown,space", "scroll(10)", id="result.page_down"),
        Binding("pageup", "scroll(-10)", id="result.page_up"),
    ]

    def __init__(self, story: MissionStory, journal: Path) -> None:
        super().__init__()
        self.story = story
        self.journal = journal
        self._standing = ""
        self._literal: int | None = None
        self._shown = "Result"
        self._names = PageNames(journal)
        self._page = ResultPage()
        self._keys = KeyLine(id="keys")

    def compose(self) -> ComposeResult:
        yield self._names
        with VerticalScroll(classes="page", can_focus=False):
            yield self._page
        yield self._keys

    def on_mount(self) -> None:
        aside(self, self._stand, self._have_stood)

    def on_resize(self) -> None:
        self._show()

    def _stand(self) -> str:
        """How the mission compares with those before it."""
        now = past_mission(self.journal)
        if isinstance(now, str):
            return ""
        return standing(now, past_missions(newest_journals(self.journal.parent.parent)))

    def _reader(self) -> int | None:
        """What a literal reader reaches in it."""
        story = self.story
        return literal_rescues(story.building, story.settings, story.spec, story.seed)

    def _have_stood(self, told: str) -> None:
        self._standing = told
        self._show()
        aside(self, self._reader, self._have_read)

    def _have_read(self, rescued: int | None) -> None:
        self._literal = rescued
        self._show()

    def _remarks(self, columns: int) -> list[Row]:
        obeying = f"Whoever does exactly as told rescues {self._literal}."
        reader = "" if self._literal is None else obeying
        lines = wrapped(f"{self._standing} {reader}".strip(), columns)
        return [((line, "strong"),) for line in lines or [""]]

    def _pages(self) -> dict[str, list[Row]]:
        columns = max(20, self.size.width - _MARGIN_COLUMNS)
        rows = self.size.height - _AROUND_ROWS
        filled = not self.app.native_ansi_color
        return result_pages(
            self.story, columns, rows, filled=filled, remarks=self._remarks(columns)
        )

    def _show(self) -> None:
        pages = self._pages()
        if self._shown not in pages:
            self._shown = next(iter(pages))
        self._names.show(list(pages), self._shown)
        self._page.draw(pages[self._shown])
        more = len(pages[self._shown]) > self.size.height - _AROUND_ROWS
        scroll = [("↑ ↓", "scroll")] if more else []
        self._keys.set_keys(
            ("Enter", "play again"), ("R", "replay"), ("C", "card"), ("← →", "pages"), *scroll,
            ("H", "home"),
        )  # fmt: skip

    def action_want(self, what: str) -> None:
        self.app.post_message(self.Wanted(what, self))

    def on_row_clicked(self, message: RowClicked) -> None:
        name = self._names.name_at(message.column)
        if name is not None:
            self._turn_to(name)

    def action_turn(self, way: int) -> None:
        names = list(self._pages())
        self._turn_to(names[(names.index(self._shown) + way) % len(names)])

    def _turn_to(self, name: str) -> None:
        self._shown = name
        self._show()
        self.query_one(VerticalScroll).scroll_home(animate=False)

    def action_scroll(self, rows: int) -> None:
        self.query_one(VerticalScroll).scroll_relative(y=rows, animate=False)
