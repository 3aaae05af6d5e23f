"""The program with the screens: what leads to what, and how it begins and ends.

A screen is imported when it is first shown, or while another is looked at (`readiness.py`), so
that the first picture of a mission waits for nothing that it does not need.
"""

from __future__ import annotations

import asyncio
import os
import sys
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path, PurePath
from typing import TYPE_CHECKING, Any, ClassVar

from textual import events
from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.geometry import Size
from textual.screen import ModalScreen, Screen
from textual.widgets import Static

from game.errors import AnaError, where
from game.journal.folders import newest_journals
from game.journal.records import Interruption
from game.places import sessions_folder
from game.screens.play.opening import Opening
from game.screens.play.options import PlayOptions, chosen_mission, rules_of, todays_mission
from game.screens.play.readiness import make_ready
from game.screens.widgets.keymap import read_keys, write_template
from game.screens.widgets.preferences import (
    Preferences,
    keys_file,
    load_preferences,
    preferences_file,
    save_preferences,
)
from game.screens.widgets.program import Program
from game.screens.widgets.signals import has_job_control, lead_out, suspend_group
from game.screens.widgets.theme import theme_name
from game.world.settings import MissionSettings
from game.world.variant import Difficulty

if TYPE_CHECKING:
    from game.screens.play.home import HomeScreen
    from game.screens.play.journal_list import Chosen
    from game.screens.play.lesson_screen import LessonOver
    from game.screens.play.live import LiveMission
    from game.screens.play.map_screen import MapScreen
    from game.screens.play.mission_screen import Failed, Finished
    from game.screens.play.replay_screen import ReplayScreen
    from game.screens.play.result import ResultScreen
    from game.screens.play.start_screen import StartScreen
    from game.screens.play.teaching import Teaching
    from game.session.replay import Replay


class AnaApp(Program, inherit_bindings=False):
    """Every screen in one program; `first` makes the one it begins with."""

    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("ctrl+z", "stand_aside", id="app.suspend", priority=True),
        Binding("f2", "settings", id="app.settings", priority=True),
        Binding("question_mark,f1", "help", id="app.help"),
    ]
    CSS_PATH: ClassVar[list[str | PurePath]] = [
        "../widgets/styles/base.tcss",
        "../widgets/styles/mission.tcss",
        "../widgets/styles/pages.tcss",
    ]

    def __init__(
        self,
        first: Callable[[AnaApp], None],
        options: PlayOptions | None = None,
        preferences: Path | None = None,
    ) -> None:
        self._preferences_file = preferences or preferences_file()
        self.preferences = load_preferences(self._preferences_file)
        super().__init__(self.preferences.ground)
        self.keys = read_keys(keys_file(self._preferences_file))
        self.set_keymap(self.keys.bindings)
        self._first = first
        self._options = options
        self.live: LiveMission | None = None
        self._opening = Opening(self)
        self._teaching: Teaching | None = None
        self._been_home = False
        self._made_ready = False
        self._opened = False

    # --- beginning and ending -------------------------------------------------------------------

    def compose(self) -> ComposeResult:
        yield Static("Opening the building …", id="opening")

    def on_mount(self) -> None:
        lead_out(self._note_signal, self._leave)
        self.call_after_refresh(self._open)

    def _open(self) -> None:
        self._opened = True
        self._first(self)
        self._mind_size(self.size)

    def _note_signal(self, name: str) -> None:
        if self.live is not None:
            self.live.journal.interrupt(name)

    def note_defect(self, error: Exception) -> None:
        if self.live is not None:
            with suppress(Exception):
                self.live.journal.append(Interruption("defect", error=where(error)))

    def _leave(self, status: int) -> None:
        self.exit(return_code=status)

    def on_failed(self, message: Failed) -> None:
        self.failure = message.error
        self.exit(return_code=2)

    def action_stand_aside(self) -> None:
        """Stop the clock, where the rules allow that, and give the terminal back to the shell that
        started the game."""
        from game.screens.play.map_screen import MapScreen
        from game.screens.play.mission_screen import LiveScreen
        from game.screens.widgets.dialogs import Notice

        screen = self.screen
        if isinstance(screen, LiveScreen):
            if screen.live.settings.allow_pause:
                screen.action_pause()
        elif isinstance(screen, MapScreen):
            self.push_screen(Notice("Paused", "The time for the map stands still.", key="Resume"))
        if has_job_control():
            self.call_after_refresh(suspend_group)

    # --- the window -----------------------------------------------------------------------------

    def on_resize(self, event: events.Resize) -> None:
        if self._opened:
            self._mind_size(event.size)

    async def action_leave_now(self) -> None:
        """Quit from a window in which no question can be read; what was played is kept."""
        if self.live is not None:
            await asyncio.to_thread(self.live.end)
        self.exit()

    def _mind_size(self, size: Size) -> None:
        from game.screens.widgets.dialogs import LEAST_SIZE, TooSmall

        columns, rows = LEAST_SIZE
        small = size.width < columns or size.height < rows
        shown = isinstance(self.screen, TooSmall)
        if small and not shown:
            self.push_screen(TooSmall())
        elif shown and not small:
            self.pop_screen()

    # --- home -----------------------------------------------------------------------------------

    def show_home(self) -> None:
        """Nothing but the home screen."""
        from game.screens.play.home import HomeScreen

        self._been_home = True
        self.replace(HomeScreen(self.preferences, self._log_dir(), self._rules_of))

    def on_home_screen_wanted(self, message: HomeScreen.Wanted) -> None:
        home = message.sender
        self._remember(home.preferences)
        match message.what:
            case "play":
                self.offer_mission(self._chosen(home.seed))
            case "today":
                rules = self._rules_of("standard")
                self.offer_mission(todays_mission(self.preferences, rules, self._log_dir()))
            case "tutorial":
                self.teach()
            case "watch":
                self.watch_mission(self._chosen())
            case "replay":
                self._choose_journal()
            case "howto":
                self._show_howto()
            case "settings":
                self.action_settings()
            case "theme":
                self._turn_theme()
            case _:
                self.exit()

    def _choose_journal(self) -> None:
        from game.screens.play.journal_list import JournalsScreen

        folder = self._log_dir()
        journals = newest_journals(folder)
        self.push_screen(JournalsScreen(folder, journals), self._journal_chosen)

    def _show_howto(self) -> None:
        from game.screens.widgets.howto import HowToScreen

        self.push_screen(HowToScreen())

    def _log_dir(self) -> Path:
        return self._options.log_dir if self._options else sessions_folder()

    def _remember(self, preferences: Preferences) -> None:
        if preferences != self.preferences:
            self.preferences = preferences
            save_preferences(self._preferences_file, preferences)

    def action_help(self) -> None:
        """How to play, over a screen that has no help of its own."""
        from game.screens.widgets.dialogs import Help

        if not isinstance(self.screen, ModalScreen):
            self.push_screen(Help(self._rules_of(self.preferences.difficulty), key="Back"))

    def action_settings(self) -> None:
        """The settings, over whatever is shown."""
        from game.screens.play.home import HomeScreen
        from game.screens.play.settings_screen import SettingsScreen
        from game.screens.widgets.dialogs import TooSmall

        if not isinstance(self.screen, SettingsScreen | TooSmall):
            file = keys_file(self._preferences_file)
            write_template(file)
            if isinstance(self.screen, HomeScreen):
                self._remember(self.screen.preferences)
            self.push_screen(SettingsScreen(self.preferences, self._prefer, file, self._log_dir()))

    def _prefer(self, preferences: Preferences) -> None:
        """Let new preferences hold at once."""
        from game.screens.play.free_play_screen import FreePlayScreen
        from game.screens.play.home import HomeScreen

        self._remember(preferences)
        self.theme = theme_name(os.environ, preferences.ground)
        for screen in self.screen_stack:
            if isinstance(screen, HomeScreen | FreePlayScreen):
                screen.prefer(preferences)

    def _turn_theme(self) -> None:
        ground = "light" if self.current_theme.dark else "dark"
        self._prefer(self.preferences.replaced(ground=ground))

    def _rules_of(self, difficulty: Difficulty) -> MissionSettings:
        return rules_of(difficulty, self.preferences, self._options)

    def _chosen(self, typed: str = "") -> PlayOptions:
        rules = self._rules_of(self.preferences.difficulty)
        return chosen_mission(self.preferences, rules, self._log_dir(), typed)

    # --- the tutorial ---------------------------------------------------------------------------

    def teach(self) -> None:
        """Go through the tutorial."""
        from game.screens.play.teaching import Teaching

        self._teaching = Teaching(self, self._log_dir(), self._rules_of("standard"))
        self._teaching.go_on()

    def on_lesson_over(self, message: LessonOver) -> None:
        self.live = None
        if self._teaching is not None:
            if message.go_on:
                self._teaching.go_on()
            else:
                self._teaching.stop()

    # --- missions -------------------------------------------------------------------------------

    def offer_mission(self, options: PlayOptions) -> None:
        """What comes before a mission, and then the mission."""
        self._options = options
        self._opening.offer(options)

    def on_map_screen_seen(self, message: MapScreen.Seen) -> None:
        if message.shown_ms is None:
            self.step_back()
        elif self._options is not None:
            self._opening.introduce(self._options, message.shown_ms)

    def on_start_screen_wanted(self, message: StartScreen.Wanted) -> None:
        if message.what == "start":
            message.begin()
        else:
            self.step_back()

    def play_mission(self, options: PlayOptions) -> None:
        """A person plays at once."""
        self._options = options
        self._opening.play(options)

    def watch_mission(self, options: PlayOptions) -> None:
        """A simulated rescuer plays."""
        self._options = options
        self._opening.watch(options)

    def on_finished(self, message: Finished) -> None:
        self.live = None
        self.show_result(message.journal, always=message.complete)

    def show_result(self, journal: Path, *, always: bool = True) -> None:
        """The result page of a journal's first mission; unless `always`, only where something was
        done in it."""
        from game.journal.reader import read_journal
        from game.screens.play.mission_story import tell
        from game.screens.play.result import ResultScreen
        from game.session.replay import Replay

        try:
            replay = Replay(read_journal(journal))
            replay.seek(replay.duration_ms)
        except AnaError as error:
            self.say_or_fail("The journal cannot be read", error)
            return
        story = tell(replay)
        if always or story.actions:
            self.replace(ResultScreen(story, journal))
        else:
            self.step_back()

    def on_result_screen_wanted(self, message: ResultScreen.Wanted) -> None:
        result = message.sender
        if message.what == "again":
            options = self._options or self._chosen()
            self.offer_mission(options.again())
        elif message.what == "replay":
            self.replay(result.journal)
        elif message.what == "card":
            self._make_card(result)
        else:
            self.show_home()

    def _make_card(self, result: ResultScreen) -> None:
        """Copy a result to the clipboard, and write it beside its journal."""
        from game.screens.play.result_card import card_svg, card_text
        from game.screens.widgets.dialogs import Notice

        text, folder = card_text(result.story), result.journal.parent
        self.copy_to_clipboard(text)
        try:
            (folder / "card.txt").write_text(text + "\n", encoding="utf-8")
            (folder / "card.svg").write_text(card_svg(result.story), encoding="utf-8")
            told = f"Also as card.txt and as a picture, card.svg, in\n{folder}"
        except OSError as error:
            told = f"It could not be written to {folder} ({error.strerror})."
        title = "Copied, if your terminal allows it"
        self.push_screen(Notice(title, f"{text}\n\n{told}", key="Back", wide=True))

    # --- replay ---------------------------------------------------------------------------------

    def replay(self, journal: Path) -> None:
        """Replay the first mission of a journal, over the screen that is shown."""
        from game.journal.reader import read_journal
        from game.session.replay import Replay

        try:
            self.show_replay(Replay(read_journal(journal)))
        except AnaError as error:
            self.say_or_fail("This mission cannot be replayed", error)

    def _journal_chosen(self, chosen: Chosen | None) -> None:
        if chosen is None:
            return
        what, journal = chosen
        if what == "replay":
            self.replay(journal)
        else:
            self.show_result(journal)

    def show_replay(self, replay: Replay) -> None:
        """Show a replay over whatever is shown."""
        from game.screens.play.replay_screen import ReplayScreen

        self.push_screen(ReplayScreen(replay))

    def on_replay_screen_mission_wanted(self, message: ReplayScreen.MissionWanted) -> None:
        from game.screens.play.replay_screen import ReplayScreen
        from game.session.replay import Replay

        try:
            replay = Replay(message.transcript, message.number)
        except AnaError as error:
            self.say_or_fail("This mission cannot be replayed", error)
            return
        self.switch_screen(ReplayScreen(replay))

    def on_replay_screen_left(self) -> None:
        if len(self.screen_stack) > 2:
            self.pop_screen()
        else:
            self.step_back()

    # --- the stack of screens -------------------------------------------------------------------

    def step_back(self) -> None:
        """Back to the home screen if it was the start, otherwise quit."""
        if self._been_home:
            self.show_home()
        else:
            self.exit()

    def replace(self, screen: Screen[Any]) -> None:
        """Show nothing but this screen."""
        while len(self.screen_stack) > 2:
            self.pop_screen()
        if len(self.screen_stack) == 2:
            self.switch_screen(screen)
        else:
            self.push_screen(screen)
        if not self._made_ready:
            self._made_ready = True
            make_ready(screen)

    @property
    def _at_start(self) -> bool:
        from game.screens.play.start_screen import StartScreen

        return isinstance(self.screen, StartScreen)

    def say_or_fail(self, title: str, error: AnaError) -> None:
        """Tell of an error where the user can go on from; leave with it where nothing is shown."""
        from game.screens.widgets.dialogs import Notice

        if len(self.screen_stack) > 1 and (self._been_home or not self._at_start):
            self.push_screen(Notice(title, str(error), key="Back"))
        else:
            self.failure = error
            self.exit(return_code=2)


def run_home() -> int:
    """Open the home screen; the exit status. Raises AnaError for what the user can fix."""
    return _run(AnaApp(AnaApp.show_home))


def run_play(options: PlayOptions) -> int:
    """Play a mission, and go on from there."""
    return _run(AnaApp(lambda app: app.offer_mission(options), options))


def run_watch(options: PlayOptions) -> int:
    """Let a simulated rescuer play, in the same screen."""
    return _run(AnaApp(lambda app: app.watch_mission(options), options))


def run_replay(journal: Path) -> int:
    """Replay a journal's first mission."""
    from game.journal.reader import read_journal
    from game.session.replay import Replay

    replay = Replay(read_journal(journal))
    return _run(AnaApp(lambda app: app.show_replay(replay)))


def _run(app: AnaApp) -> int:
    if not all(stream.isatty() for stream in (sys.stdin, sys.stdout, sys.stderr)):
        raise AnaError(
            "this is not a terminal",
            hint="Run ana in a terminal window, not through a pipe; over ssh, use `ssh -t`.",
        )
    return app.perform_or_report()
