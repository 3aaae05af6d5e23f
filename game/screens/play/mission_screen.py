"""A live mission on the screen: what each needs, and the one that a person plays."""

from __future__ import annotations

import asyncio
import gc
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import ClassVar

from textual import work
from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.message import Message
from textual.screen import Screen
from textual.widget import Widget

from game.errors import AnaError
from game.journal.journal_error import JournalError
from game.mission_words import ENGLISH, MissionWords, asked_words
from game.screens.play.live import LiveMission
from game.screens.play.missionview import MissionView
from game.screens.widgets.dialogs import Help, Notice, Pause, leave_question
from game.screens.widgets.statuspanel import next_change_ms
from game.world.events import Action, LevelWish
from game.world.observation import Observation
from game.world.settings import Controls

ASKED_S = 2.0
"""How long what the level key asked for stands on the screen."""

_ACTIONS: dict[Controls, dict[str, Action]] = {
    "compass": {
        "up": Action.NORTH,
        "right": Action.EAST,
        "down": Action.SOUTH,
        "left": Action.WEST,
        "triage": Action.TRIAGE,
    },
    "turn": {
        "up": Action.FORWARD,
        "right": Action.TURN_RIGHT,
        "left": Action.TURN_LEFT,
        "triage": Action.TRIAGE,
    },
}


class Finished(Message):
    """A mission is over and its journal closed; `complete` is false where its player left it."""

    def __init__(self, journal: Path, *, complete: bool) -> None:
        super().__init__()
        self.journal = journal
        self.complete = complete


class Failed(Message):
    """The screen cannot go on; the user has been told why."""

    def __init__(self, error: AnaError) -> None:
        super().__init__()
        self.error = error


class LiveScreen(Screen[None]):
    """Shows a live mission and lets it go on by itself.

    One timer waits for whatever changes next: something due in the mission, or a number on the
    panel. Windows over the screen pause the mission where its settings allow it.
    """

    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("p,P", "pause", "Pause", id="mission.pause"),
        Binding("question_mark,f1", "help", "Help", id="mission.help"),
        Binding("q,Q,ctrl+q,ctrl+c,escape", "leave", "Leave", id="mission.leave"),
    ]

    def __init__(self, live: LiveMission, journal: Path, words: MissionWords = ENGLISH) -> None:
        super().__init__()
        self.live = live
        self.journal = journal
        self.view = MissionView(live.settings, self.extra(), words)
        self._alarm: asyncio.TimerHandle | None = None
        self._armed_ms = 0
        self._over = False

    def extra(self) -> Widget | None:
        """A widget for the panel, besides those of every mission."""
        return None

    def compose(self) -> ComposeResult:
        yield self.view

    def on_mount(self) -> None:
        self.call_after_refresh(self._settle)

    def _settle(self) -> None:
        self.refresh_view()
        gc.collect()
        gc.freeze()

    def on_screen_suspend(self) -> None:
        with self.kept():
            self.live.pause()

    def on_screen_resume(self) -> None:
        if not self._over:
            with self.kept():
                self.live.unpause()
            self.refresh_view()

    def refresh_view(self) -> None:
        """Paint the mission as it is now, and wait for what comes next."""
        observation = self.live.observation()
        self.show(observation)
        if observation.ended:
            self._finish()
        elif not self.live.paused:
            due_ms = next_change_ms(observation, self.view.panel_columns)
            self.wait_for(min(due_ms, self.live.run.next_due_ms or due_ms))
        if self.live.journal.awaits_disk:
            self._wait_for_disk()

    def show(self, observation: Observation) -> None:
        """Paint an observation."""
        self.view.show(observation)

    def wait_for(self, at_ms: int) -> None:
        """Be woken at mission time `at_ms`, or earlier.

        The event loop's own alarm is used, because a timer of Textual never fires when the
        machine is busy for longer than its whole interval just as it starts.
        """
        if self._alarm is not None:
            if self._armed_ms <= at_ms:
                return
            self._alarm.cancel()
        self._armed_ms = at_ms
        delay_s = self.live.due_in_s(at_ms)
        loop = asyncio.get_running_loop()
        self._alarm = loop.call_later(delay_s, self.call_later, self._wake)

    def rearm(self) -> None:
        """Forget what was waited for, since the clock now runs at another speed."""
        if self._alarm is not None:
            self._alarm.cancel()
            self._alarm = None

    def _wake(self) -> None:
        self._alarm = None
        if self._over or self.live.paused:
            return
        with self.kept():
            self.live.advance()
            self.woken()
        self.refresh_view()

    def woken(self) -> None:
        """Called when time has gone on, before that is painted."""

    @contextmanager
    def kept(self) -> Iterator[None]:
        """What is done within is in the journal afterwards, or the screen says why not."""
        try:
            yield
        except JournalError as error:
            self._fail(error)

    def _fail(self, error: AnaError) -> None:
        if self._over:
            return
        self._over = True
        text = f"{error}\n\nEverything up to this point is saved in\n{self.journal}"

        def leave(_: None) -> None:
            self.app.post_message(Failed(error))

        self.app.push_screen(Notice("The mission cannot go on", text, key="Leave"), leave)

    @work(exclusive=True, group="disk")
    async def _wait_for_disk(self) -> None:
        with self.kept():
            await self.live.journal.wait_durable()

    def _finish(self) -> None:
        if not self._over:
            self._over = True
            self._close(complete=True)

    @work(group="end")
    async def _close(self, *, complete: bool) -> None:
        try:
            await asyncio.to_thread(self.live.end)
        except JournalError as error:
            self._over = False
            self._fail(error)
            return
        self.app.post_message(self.over(complete=complete))

    def over(self, *, complete: bool) -> Message:
        """What the program is told when the mission is over and recorded."""
        return Finished(self.journal, complete=complete)

    def check_action(self, action: str, parameters: tuple[object, ...]) -> bool | None:
        match action:
            case "pause":
                return self.live.settings.allow_pause
            case "ask":
                return self.live.settings.level_key
            case _:
                return True

    def action_pause(self) -> None:
        self.app.push_screen(Pause(self._help), self._left)

    def action_help(self) -> None:
        self.app.push_screen(self._help())

    def _help(self) -> Help:
        return Help(self.live.settings)

    def action_leave(self) -> None:
        self.app.push_screen(leave_question(), self._left)

    def _left(self, leave: bool | None) -> None:
        if leave and not self._over:
            self._over = True
            self._close(complete=False)


class MissionScreen(LiveScreen):
    """A person plays."""

    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("up,w,k,W,K", "act('up')", "North", id="mission.up"),
        Binding("right,d,l,D,L", "act('right')", "East", id="mission.right"),
        Binding("down,s,j,S,J", "act('down')", "South", id="mission.down"),
        Binding("left,a,h,A,H", "act('left')", "West", id="mission.left"),
        Binding("space", "act('triage')", "Treat", id="mission.triage"),
        Binding("plus,equals_sign", "ask('simpler')", "Simpler words", id="mission.simpler"),
        Binding("minus,underscore", "ask('shorter')", "Shorter words", id="mission.shorter"),
    ]

    def action_act(self, name: str) -> None:
        action = _ACTIONS[self.live.settings.controls].get(name)
        if action is None or self._over:
            return
        with self.kept():
            self.live.press(action)
        self.refresh_view()

    def asked_words(self, want: LevelWish, *, answered: bool) -> str:
        """What is shown when the level key has been pressed; `answered` is whether the bar says
        something else now."""
        return asked_words(want, answered=answered)

    def action_ask(self, want: LevelWish) -> None:
        if self._over:
            return
        answered = False
        with self.kept():
            answered = self.live.ask_level(want)
        self.refresh_view()
        self.tell(self.asked_words(want, answered=answered))

    def tell(self, text: str) -> None:
        """Show a text for `ASKED_S`, in a corner."""
        self.app.clear_notifications()
        self.notify(text, timeout=ASKED_S)
