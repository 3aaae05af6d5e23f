"""The program with the screens: what leads to what, and how it begins and ends.

A screen is imported when it is first shown, so that the first picture of a mission waits for
nothing that it does not need.
"""

from __future__ import annotations

import asyncio
import os
import sys
from collections.abc import Callable, Generator
from contextlib import suppress
from dataclasses import dataclass, replace
from datetime import UTC, datetime
from functools import partial
from pathlib import Path, PurePath
from random import randrange
from typing import TYPE_CHECKING, ClassVar, Literal

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
from game.world import load_building
from game.world.building import Building
from game.world.library import GENERATED
from game.world.settings import FREE_PLAY, MissionSettings
from game.world.variant import USUAL, Difficulty, Variant, day_seed, varied, with_demands

if TYPE_CHECKING:
    from game.coach.spec import CoachSpec
    from game.journal.writer import Journal
    from game.screens.play.home import HomeScreen
    from game.screens.play.journal_list import Chosen
    from game.screens.play.lesson_screen import LessonOver
    from game.screens.play.live import LiveMission
    from game.screens.play.map_screen import MapScreen
    from game.screens.play.mission_screen import Failed, Finished, LiveScreen, MissionScreen
    from game.screens.play.replay_screen import ReplayScreen
    from game.screens.play.result import ResultScreen
    from game.screens.play.start_screen import StartScreen
    from game.screens.play.watch_screen import WatchScreen
    from game.session.replay import Replay


NEW_SEEDS = 100_000
"""Seeds chosen at home are below this, so that they can be typed again."""


@dataclass(frozen=True)
class PlayOptions:
    """A mission of free play: where, by which rules, with which coach, kept in which folder; and
    who plays it where it is watched, by the name in `game.rescuers.catalogue`."""

    building: Building
    spec: CoachSpec
    settings: MissionSettings
    seed: int
    log_dir: Path
    rescuer: str = "literal"
    variant: Variant = USUAL
    drawn: Building | None = None
    """The building before the variant; None where they are the same."""
    memorise_ms: int = 0
    """For how long the map is shown first, to a person."""
    now: bool = False
    """Whether the clock starts at once, without the page before the mission."""
    onward: Literal["seed", "office", "same"] = "seed"
    """What changes from one mission to the next: the seed, with it the whole office, or nothing,
    as in the mission of the day."""

    @property
    def about(self) -> str:
        """What sets this mission apart, in a few words."""
        told = self.variant.of_seed(self.seed)
        if self.onward == "same":
            return ", ".join(filter(None, (f"Mission of the day {self.seed}", told)))
        if self.onward == "office" and self.variant.victims == "drawn":
            return ", ".join(filter(None, (f"Seed {self.seed}", told)))
        return told

    def again(self) -> PlayOptions:
        """The next mission: the next seed, and what follows from it; the map is known by now."""
        if self.onward == "same":
            return replace(self, memorise_ms=0, now=False)
        seed, drawn = self.seed + 1, self.drawn
        if self.onward == "office":
            drawn = load_building(f"{GENERATED}:{seed}")
        building = self.building if drawn is None else varied(drawn, self.variant, seed)
        return replace(self, seed=seed, building=building, drawn=drawn, memorise_ms=0, now=False)


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
        self._lessons: Generator[Screen[None]] | None = None
        self._been_home = False
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
        self._replace(HomeScreen(self.preferences, self._log_dir(), self._rules_of))

    def on_home_screen_wanted(self, message: HomeScreen.Wanted) -> None:
        home = message.sender
        self._remember(home.preferences)
        match message.what:
            case "play":
                self.offer_mission(self._chosen(home.seed))
            case "today":
                self.offer_mission(self._todays())
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

        journals = newest_journals(self._log_dir())
        self.push_screen(JournalsScreen(journals), self._journal_chosen)

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
            self.push_screen(SettingsScreen(self.preferences, self._prefer, str(file)))

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
        ground = "dark" if self.theme == "ana-light" else "light"
        self._prefer(self.preferences.replaced(ground=ground))

    def _rules_of(self, difficulty: Difficulty) -> MissionSettings:
        """The rules of a difficulty, those of the command line where it is theirs, with the
        controls chosen at home."""
        options = self._options
        if options is not None and options.variant.difficulty == difficulty:
            rules = options.settings
        else:
            rules = with_demands(FREE_PLAY, difficulty)
        return replace(rules, controls=self.preferences.controls)

    def _chosen(self, typed: str = "") -> PlayOptions:
        """The mission chosen at home, by the seed that was typed or a new one."""
        chosen = self.preferences
        seed = int(typed) if typed else randrange(1, NEW_SEEDS)
        name = f"{GENERATED}:{seed}" if chosen.building == GENERATED else chosen.building
        drawn = load_building(name, seed)
        variant = Variant(chosen.victims, chosen.difficulty)
        return PlayOptions(
            varied(drawn, variant, seed),
            self._coach(),
            self._rules_of(chosen.difficulty),
            seed,
            self._log_dir(),
            variant=variant,
            drawn=drawn,
            memorise_ms=1000 * chosen.memorise,
            onward="office" if chosen.building == GENERATED else "seed",
        )

    def _todays(self) -> PlayOptions:
        """The mission of the day, with the coach chosen at home."""
        seed = day_seed(datetime.now(UTC))
        building, rules = load_building(f"{GENERATED}:{seed}"), self._rules_of("standard")
        return PlayOptions(building, self._coach(), rules, seed, self._log_dir(), onward="same")

    def _coach(self) -> CoachSpec:
        from game.screens.play.home import spec_of

        return spec_of(self.preferences.coach)

    # --- the tutorial ---------------------------------------------------------------------------

    def teach(self) -> None:
        """Go through the tutorial."""
        from game.screens.play.tutorial import Tutorial
        from game.screens.widgets.terminal import this_terminal

        rules = self._rules_of("standard")
        tutorial = Tutorial(self._log_dir(), this_terminal(*self.size), rules)
        self._lessons = tutorial.screens()
        self._teach_on()

    def on_lesson_over(self, message: LessonOver) -> None:
        self.live = None
        if message.go_on:
            self._teach_on()
        else:
            self._stop_teaching()

    def _teach_on(self) -> None:
        from game.screens.play.tutorial import LegScreen

        assert self._lessons is not None
        try:
            screen = next(self._lessons, None)
        except AnaError as error:
            self._say_or_fail("The tutorial cannot go on", error)
            return
        if screen is None:
            self._stop_teaching()
            return
        self.live = screen.live if isinstance(screen, LegScreen) else None
        self._replace(screen)

    def _stop_teaching(self) -> None:
        lessons, self._lessons = self._lessons, None
        if lessons is not None:
            lessons.close()
        self._step_back()

    # --- missions -------------------------------------------------------------------------------

    def offer_mission(self, options: PlayOptions) -> None:
        """What comes before a mission, and then the mission: the map, where it is wanted, and the
        page that says what the mission is about."""
        from game.screens.play.map_screen import MapScreen

        self._options = options
        if options.memorise_ms:
            self._replace(MapScreen(options.building, options.memorise_ms))
        else:
            self._introduce(options)

    def on_map_screen_seen(self, message: MapScreen.Seen) -> None:
        if message.shown_ms is None:
            self._step_back()
        elif self._options is not None:
            self._introduce(self._options, message.shown_ms)

    def _introduce(self, options: PlayOptions, memorised_ms: int = 0) -> None:
        from game.screens.play.start_screen import StartScreen

        begin = partial(self.play_mission, options, memorised_ms)
        if options.now:
            begin()
        else:
            self._replace(
                StartScreen(options.building, options.settings, options.spec, begin, options.about)
            )

    def on_start_screen_wanted(self, message: StartScreen.Wanted) -> None:
        if message.what == "start":
            message.begin()
        else:
            self._step_back()

    def play_mission(self, options: PlayOptions, memorised_ms: int = 0) -> None:
        """A person plays at once, who saw the map for so long before."""
        self._begin(options, lambda: self._mission(options, memorised_ms))

    def watch_mission(self, options: PlayOptions) -> None:
        """A simulated rescuer plays."""
        self._begin(options, lambda: self._watching(options))

    def _begin(self, options: PlayOptions, make: Callable[[], LiveScreen]) -> None:
        self._options = options
        try:
            screen = make()
        except AnaError as error:
            self._say_or_fail("The mission cannot start", error)
            return
        self.live = screen.live
        self._replace(screen)

    def _mission(self, options: PlayOptions, memorised_ms: int) -> MissionScreen:
        from game.screens.play.free_play_screen import FreePlayScreen
        from game.screens.play.live import LiveMission
        from game.screens.widgets.terminal import this_terminal
        from game.session.playing import start_free_play

        run, journal = start_free_play(
            options.building,
            options.settings,
            options.spec,
            options.seed,
            options.log_dir,
            this_terminal(*self.size),
            variant=options.variant,
            memorised_ms=memorised_ms,
        )
        return FreePlayScreen(LiveMission(run, journal), _path(journal), self.preferences)

    def _watching(self, options: PlayOptions) -> WatchScreen:
        from game.rescuers.catalogue import character
        from game.screens.play.coachpanel import OverheardCoach
        from game.screens.play.live import LiveMission
        from game.screens.play.watch_screen import WatchScreen
        from game.screens.widgets.terminal import this_terminal
        from game.session.playing import start_free_play

        building, who = options.building, character(options.rescuer)
        run, journal = start_free_play(
            building,
            options.settings,
            options.spec,
            options.seed,
            options.log_dir,
            this_terminal(*self.size),
            rescuer=who.name,
            build=OverheardCoach.build,
            variant=options.variant,
        )
        coach = run.coach
        assert isinstance(coach, OverheardCoach)
        rescuer = who.make(building, options.settings, options.seed)
        return WatchScreen(LiveMission(run, journal), _path(journal), rescuer, coach, who)

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
            self._say_or_fail("The journal cannot be read", error)
            return
        story = tell(replay)
        if always or story.actions:
            self._replace(ResultScreen(story, journal))
        else:
            self._step_back()

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
            self._say_or_fail("This mission cannot be replayed", error)

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
            self._say_or_fail("This mission cannot be replayed", error)
            return
        self.switch_screen(ReplayScreen(replay))

    def on_replay_screen_left(self) -> None:
        if len(self.screen_stack) > 2:
            self.pop_screen()
        else:
            self._step_back()

    # --- the stack of screens -------------------------------------------------------------------

    def _step_back(self) -> None:
        """Back to the home screen if it was the start, otherwise quit."""
        if self._been_home:
            self.show_home()
        else:
            self.exit()

    def _replace(self, screen: Screen[None]) -> None:
        while len(self.screen_stack) > 2:
            self.pop_screen()
        if len(self.screen_stack) == 2:
            self.switch_screen(screen)
        else:
            self.push_screen(screen)

    @property
    def _at_start(self) -> bool:
        from game.screens.play.start_screen import StartScreen

        return isinstance(self.screen, StartScreen)

    def _say_or_fail(self, title: str, error: AnaError) -> None:
        """Tell of an error where the user can go on from; leave with it where nothing is shown."""
        from game.screens.widgets.dialogs import Notice

        if len(self.screen_stack) > 1 and (self._been_home or not self._at_start):
            self.push_screen(Notice(title, str(error), key="Back"))
        else:
            self.failure = error
            self.exit(return_code=2)


def _path(journal: Journal) -> Path:
    from game.journal.sink import FileSink

    assert isinstance(journal.sink, FileSink)
    return journal.sink.path


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
