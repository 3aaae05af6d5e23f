"""The program a participant is in, from login to the last page; there is no way out of it into
anything else."""

from __future__ import annotations

import asyncio
import sys
from contextlib import suppress
from pathlib import PurePath
from typing import ClassVar

from textual import events, work
from textual.geometry import Size
from textual.screen import Screen

from game.errors import STATUS_TROUBLE, AnaError, where
from game.journal.records import Covered
from game.screens.play.mission_screen import Failed, Finished
from game.screens.study.base import Frame, StudyScreen
from game.screens.study.fault import cannot_go_on
from game.screens.study.mission_page import StudyMissionScreen
from game.screens.study.pages import PageScreen
from game.screens.study.preflight import PreflightScreen, WindowTooSmall, fits
from game.screens.study.seat import ScreenParticipant
from game.screens.widgets.program import Program
from game.screens.widgets.signals import lead_out
from game.screens.widgets.terminal import this_terminal
from game.study.folder import Identity, Study
from game.study.ledger import NoPlace
from game.study.lock import SessionBusy, SessionLock, take_over
from game.study.protocol.conduct import conduct
from game.study.protocol.study_session import HasWithdrawn, StudySession, open_session, see_place
from game.study.texts import Page, filled


class StudyApp(Program, inherit_bindings=False):
    """One participant's session on this terminal."""

    CSS_PATH: ClassVar[list[str | PurePath]] = [
        "../widgets/styles/base.tcss",
        "../widgets/styles/mission.tcss",
        "../widgets/styles/pages.tcss",
        "study.tcss",
    ]

    def __init__(self, study: Study, identity: Identity) -> None:
        screen = study.settings.screen
        super().__init__(look=screen.look, cells=screen.cells)
        self.study = study
        self.identity = identity
        self.frame = Frame(study.settings.screen, study.texts.words)
        self.session: StudySession | None = None
        self.person = ScreenParticipant(self, self.frame, study.texts, study.settings.mission)
        self._lock: SessionLock | None = None
        self._covered_at: int | None = None
        self._leaving = False
        self._defect = ""

    def on_mount(self) -> None:
        lead_out(self._note_signal, self._leave)
        self.screen_change_signal.subscribe(self, self._screen_changed)
        self._lead()

    @work(exit_on_error=True)
    async def _lead(self) -> None:
        texts = self.study.texts
        try:
            await self._take_part()
        except NoPlace:
            await self._close_with(texts.no_place)
        except HasWithdrawn:
            await self._close_with(texts.withdrawn)
        except AnaError as error:
            self.failure = error
            page = filled(texts.words.trouble, problem=error.message)
            await self._close_with(page, STATUS_TROUBLE)
        else:
            self.exit()

    async def _close_with(self, page: Page, status: int = 0) -> None:
        await self.push_screen_wait(PageScreen(self.frame, page))
        self.exit(return_code=status)

    async def _take_part(self) -> None:
        home = self.study.home(self.identity)
        if not home.exists():
            await asyncio.to_thread(see_place, self.study, self.identity)
        silent_ms = None
        try:
            self._lock = SessionLock(home)
        except SessionBusy as busy:
            if not await self.push_screen_wait(self.frame.busy_question()):
                return
            silent_ms = busy.silent_ms
            self._lock = await asyncio.to_thread(take_over, home)
        try:
            self.session = open_session(
                self.study, self.identity, this_terminal(*self.size), silent_ms=silent_ms
            )
            self._note_early_defect()
            if await conduct(self.session, self.person) == "stopped":
                goodbye = self.study.texts.words.goodbye
                await self.push_screen_wait(PageScreen(self.frame, goodbye))
        finally:
            self.release()

    def release(self) -> None:
        """Let go of the session, so that it can be continued."""
        if self._lock is not None:
            self._lock.release()

    # --- what breaks in -------------------------------------------------------------------------

    def note_defect(self, error: Exception) -> None:
        self._defect = self._defect or where(error)
        if self.session is not None:
            with suppress(Exception):
                self.session.note_defect(self._defect)

    def _note_early_defect(self) -> None:
        """Something failed before there was a session to note it in, and the program is closing."""
        if self._defect and self.session is not None:
            self.session.note_defect(self._defect)

    def _note_signal(self, name: str) -> None:
        if self.session is not None:
            self.session.journal.interrupt(name)

    def _leave(self, status: int) -> None:
        self.exit(return_code=status)

    def on_finished(self, message: Finished) -> None:
        self._note_covered()
        self.person.mission_ended(message.complete)

    def on_failed(self, message: Failed) -> None:
        self.person.mission_ended(message.error)

    # --- the window -----------------------------------------------------------------------------

    def on_resize(self, event: events.Resize) -> None:
        self._cover_or_uncover(event.size)

    def _screen_changed(self, _: Screen[object]) -> None:
        self.call_later(self._cover_or_uncover, self.size)

    def _cover_or_uncover(self, size: Size) -> None:
        """While the terminal is too small for what is shown, cover it."""
        enough = fits(size.width, size.height, self.frame.size)
        covered = isinstance(self.screen, WindowTooSmall)
        nothing_yet = self.session is None or isinstance(self.screen, PreflightScreen)
        nothing_yet |= len(self.screen_stack) == 1
        if covered and enough:
            self.pop_screen()
            self._uncover()
        elif not (covered or enough or nothing_yet or self._leaving):
            self._note_covered()
            self._covered_at = self.now_ms()
            self.push_screen(WindowTooSmall(self.frame, self._cover()))

    def _cover(self) -> str:
        """Tell what is covered; returns what becomes of its clock."""
        for screen in self.screen_stack:
            if isinstance(screen, StudyScreen):
                said = screen.cover()
                if said:
                    return said
            elif isinstance(screen, StudyMissionScreen):
                return self.frame.words.mission_goes_on
        return ""

    def _uncover(self) -> None:
        """Tell what can be seen again."""
        for screen in self.screen_stack:
            if isinstance(screen, StudyScreen):
                screen.uncover()
        self._note_covered()
        self._covered_at = None

    def _note_covered(self) -> None:
        """Record for how long the window has been too small, in the phase that it belongs to."""
        if self.session is not None and self._covered_at is not None:
            now_ms = self.now_ms()
            with suppress(AnaError):
                self.session.record(Covered(now_ms - self._covered_at))
            self._covered_at = now_ms

    def now_ms(self) -> int:
        """The session's clock; 0 before there is a session."""
        return 0 if self.session is None else self.session.now_ms()

    def action_leave_small(self) -> None:
        """Stop taking part, without a question: there is no room for one. What is said at the end
        is shown as far as it fits."""
        self._leaving = True
        self._uncover()
        for screen in reversed(self.screen_stack):
            if isinstance(screen, StudyScreen):
                screen.finish(None)
                return
            if isinstance(screen, StudyMissionScreen):
                screen.leave_at_once()
                return
        self.exit()


def run_session(study: Study, identity: Identity) -> int:
    """Let a participant take part at this terminal; the exit status.

    Raises AnaError for what the experimenter can fix; anything else that fails is shown to the
    participant as a page, and written to the system's log.
    """
    if not (sys.stdin.isatty() and sys.stdout.isatty()):
        raise AnaError(
            "this is not a terminal",
            hint="Run it in a terminal window, not through a pipe; over ssh, use `ssh -t`.",
        )
    app = StudyApp(study, identity)
    try:
        return app.perform()
    except AnaError:
        raise
    except Exception as error:
        app.release()
        return cannot_go_on(error, study.texts)
    finally:
        app.release()
