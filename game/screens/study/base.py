"""What all screens of a session share: a stage of fixed size, and one way to stop taking part."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from time import monotonic
from typing import ClassVar, Generic, TypeVar

from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.containers import Vertical, VerticalScroll
from textual.screen import Screen
from textual.widget import Widget

from game.errors import AnaError
from game.mission_words import KeyNames
from game.screens.widgets.dialogs import Question
from game.screens.widgets.keyline import KeyLine
from game.screens.widgets.prose import body, heading
from game.study.study_settings import ScreenSize
from game.study.texts import Page, ScreenWords

Result = TypeVar("Result")


@dataclass(frozen=True)
class Frame:
    """What a study gives all its screens: their size and their small words."""

    size: ScreenSize
    words: ScreenWords

    @property
    def keys(self) -> KeyNames:
        """What stands on the keys."""
        return self.words.mission.keys

    def stop_question(self) -> Question:
        """Asks whether to stop taking part."""
        words = self.words
        return self._question(words.stop_title, words.stop_text, words.stop_yes, words.stop_no)

    def decline_question(self) -> Question:
        """Asks whether someone really does not want to take part."""
        words = self.words
        return self._question(words.decline_title, words.decline_text, words.yes, words.no)

    def finish_question(self, unnamed: int) -> Question:
        """Asks whether labelling is finished, with so many rooms that have no name."""
        words = self.words
        text = words.finish_text.replace("{count}", str(unnamed))
        return self._question(words.finish_title, text, words.yes, words.no)

    def busy_question(self) -> Question:
        """Asks whether to continue here a session that is open elsewhere."""
        busy = self.words.busy
        return self._question(busy.title, busy.body.strip(), self.words.go_on, self.words.no)

    def _question(self, title: str, text: str, yes: str, no: str) -> Question:
        """A question that is answered by the study's own letters, too."""
        return Question(title, text, yes=yes, no=no, keys=self.keys)


class FixedStage(Vertical):
    """Holds a screen's widgets, in the middle of the terminal and never larger than the study
    says: a larger terminal has blank margins. In a smaller one, where only the last pages are
    shown, they take the room there is."""

    def __init__(self, frame: Frame, *content: Widget) -> None:
        super().__init__(*content, classes="stage")
        self.styles.width, self.styles.max_width = frame.size.columns, "100%"
        self.styles.height, self.styles.max_height = frame.size.rows, "100%"


class TextColumn(VerticalScroll):
    """A page in the middle of the stage, with `below` under its text; it scrolls where there is
    more than fits."""

    def __init__(self, page: Page, *below: Widget, wide: bool = False) -> None:
        super().__init__(heading(page), body(page), *below, classes="wide" if wide else None)

    @property
    def rows_in_view(self) -> range:
        """Which of its rows are in view."""
        top = round(self.scroll_y)
        return range(top, top + self.scrollable_content_region.height)

    def span(self, widget: Widget, rows: range) -> range:
        """Where rows of a widget in it stand."""
        top = widget.virtual_region.y
        return range(top + rows.start, top + rows.stop)

    def holds(self, widget: Widget, rows: range) -> bool:
        """Whether rows of a widget are in view, all of them, or as many as can be."""
        wanted, seen = self.span(widget, rows), self.rows_in_view
        most = min(len(wanted), len(seen))
        return len(wanted) > 0 and wanted.start >= seen.start and wanted.start + most <= seen.stop

    def bring(self, widget: Widget, rows: range) -> None:
        """Scroll as little as brings rows of a widget into view, from the first of them on."""
        wanted, seen = self.span(widget, rows), self.rows_in_view
        if wanted.start < seen.start or len(wanted) > len(seen):
            self.scroll_to(y=wanted.start, animate=False, immediate=True)
        elif wanted.stop > seen.stop:
            self.scroll_to(y=wanted.stop - len(seen), animate=False, immediate=True)

    def page(self, way: int) -> None:
        """Scroll by as much as is in view, but for two rows."""
        step = max(1, len(self.rows_in_view) - 2)
        self.scroll_to(y=self.scroll_y + way * step, animate=False, immediate=True)


class StudyScreen(Screen["Result | AnaError | None"], Generic[Result]):
    """Shows `content` on the stage, from top to bottom.

    Dismissed with its result, with None when the participant stops taking part, or with the error
    that keeps it from going on.
    """

    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("ctrl+c,ctrl+q", "stop", "Stop", id="study.stop", priority=True),
    ]
    DEAF_S: ClassVar[float] = 0.0
    """For so long keys do nothing, where the last ones were meant for something else."""

    def __init__(self, frame: Frame, content: Sequence[Widget]) -> None:
        super().__init__()
        self.frame = frame
        self._content = content
        self._deaf_until = 0.0
        self._done = False

    def compose(self) -> ComposeResult:
        yield FixedStage(self.frame, *self._content)

    def on_mount(self) -> None:
        self._deaf_until = monotonic() + self.DEAF_S

    def check_action(self, action: str, parameters: tuple[object, ...]) -> bool | None:
        return monotonic() >= self._deaf_until

    def finish(self, result: Result | AnaError | None) -> None:
        """Leave this screen and whatever stands over it; the first result counts."""
        if self._done:
            return
        self._done = True
        while self.app.screen is not self:
            self.app.pop_screen()
        self.dismiss(result)

    def cover(self) -> str:
        """The window has become too small to show it; what to say of the clock meanwhile."""
        return ""

    def uncover(self) -> None:
        """It can be seen again."""

    @property
    def scrolls(self) -> bool:
        """Whether there is more than fits."""
        return any(column.max_scroll_y > 0 for column in self.query(TextColumn))

    def show_keys(self, *keys: tuple[str, str], remark: str = "") -> None:
        """Name the keys, and those that scroll where there is more than fits."""
        more = ((self.frame.keys.page, self.frame.words.scroll),) if self.scrolls else ()
        self.query_one("#keys", KeyLine).set_keys(*keys, *more, remark=remark)

    @contextmanager
    def kept(self) -> Iterator[None]:
        """What is recorded within is kept, or the session cannot go on."""
        try:
            yield
        except AnaError as error:
            self.finish(error)

    def action_stop(self) -> None:
        self.app.push_screen(self.frame.stop_question(), self._stopped)

    def _stopped(self, stop: bool | None) -> None:
        if stop:
            self.finish(None)
