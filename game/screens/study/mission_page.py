"""A mission of a study: the mission screen at the study's size, without pause, and left only for
good reason."""

from __future__ import annotations

from typing import ClassVar

from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.containers import Vertical, VerticalScroll
from textual.screen import ModalScreen

from game.errors import AnaError
from game.journal.folders import JOURNAL
from game.screens.play.live import LiveMission, PacedClock
from game.screens.play.mission_screen import Failed, MissionScreen
from game.screens.study.base import FixedStage, Frame
from game.screens.widgets.instruction_bar import lines_needed
from game.screens.widgets.keyline import KeyLine
from game.screens.widgets.prose import body, heading
from game.screens.widgets.signs import Signs
from game.screens.widgets.timed import TICK_S
from game.study.protocol.tasks import Playing
from game.study.texts import LevelKeyWords, Page
from game.world.events import LevelWish
from game.world.settings import MissionSettings


class StudyMission(LiveMission):
    """A live mission in the journal of a session, which outlives it."""

    def __init__(self, task: Playing) -> None:
        super().__init__(task.begin(), task.journal, PacedClock(task.clock))
        self.task = task

    def end(self) -> None:
        self.task.leave(self.now_ms())
        self.journal.flush_durably()

    def tick(self) -> None:
        """Record the exposure."""
        self.task.tick(self.now_ms())


class Reminder(ModalScreen[None]):
    """The page of practice on walking and signs, over a mission that goes on."""

    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("question_mark,f1,escape,enter,q,space", "close", id="reminder.close"),
        Binding("ctrl+q,ctrl+c", "close", id="reminder.close.ctrl"),
    ]

    def __init__(self, frame: Frame, page: Page, rules: MissionSettings) -> None:
        super().__init__()
        self._frame, self._page, self._rules = frame, page, rules

    def compose(self) -> ComposeResult:
        with Vertical(classes="dialog wide"):
            with VerticalScroll():
                yield heading(self._page)
                yield body(self._page)
                yield Signs(self._rules, self._frame.words.mission)
            yield KeyLine((self._frame.keys.enter, self._frame.words.go_on))

    def action_close(self) -> None:
        self.dismiss()


class StudyMissionScreen(MissionScreen):
    """`q` asks whether to stop taking part, since a mission cannot be left alone."""

    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("ctrl+c,ctrl+q", "leave", id="study.stop", priority=True),
    ]
    live: StudyMission

    def __init__(
        self, frame: Frame, live: StudyMission, reminder: Page, level_key: LevelKeyWords
    ) -> None:
        super().__init__(live, live.task.home / JOURNAL, frame.words.mission)
        self.view.status.timed = self._is_mission
        rooms = [room.name for room in live.task.building.rooms]
        self.view.bar.lines = lines_needed(live.task.phrases, rooms, frame.size.columns)
        self.frame = frame
        self.reminder = reminder
        self.level_key = level_key

    @property
    def _is_mission(self) -> bool:
        """Whether this is a mission of a round, and no leg of the practice."""
        return self.live.task.goals is None

    def compose(self) -> ComposeResult:
        yield FixedStage(self.frame, self.view)

    def on_mount(self) -> None:
        if self._is_mission:
            self.set_interval(TICK_S, self._expose)

    def _expose(self) -> None:
        if not self._over:
            with self.kept():
                self.live.tick()

    def refresh_view(self) -> None:
        super().refresh_view()
        if self.live.task.done:
            self._finish()

    def asked_words(self, want: LevelWish, *, answered: bool) -> str:
        return self.level_key.of(want)

    def action_help(self) -> None:
        self.app.push_screen(Reminder(self.frame, self.reminder, self.live.settings))

    def _fail(self, error: AnaError) -> None:
        """The page that follows says it in the study's own words."""
        if not self._over:
            self._over = True
            self.app.post_message(Failed(error))

    def leave_at_once(self) -> None:
        """Stop taking part, without a question."""
        while self.app.screen is not self:
            self.app.pop_screen()
        self._left(True)

    def action_leave(self) -> None:
        self.app.push_screen(self.frame.stop_question(), self._left)
