"""How a mission of free play comes about: the map, the page before it, and its own screen.

A screen is imported when it is first shown, so that the first picture waits for nothing else.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from game.errors import AnaError
from game.screens.play.options import PlayOptions
from game.screens.play.stage import Stage

if TYPE_CHECKING:
    from game.journal.writer import Journal
    from game.screens.play.mission_screen import LiveScreen, MissionScreen
    from game.screens.play.watch_screen import WatchScreen
    from game.session.run import MissionRun


class Opening:
    """Leads from a chosen mission to its screen, on `stage`."""

    def __init__(self, stage: Stage) -> None:
        self._stage = stage

    def offer(self, options: PlayOptions) -> None:
        """Show what comes before a mission, and then the mission: the map, where it is wanted, and
        the page that says what the mission is about."""
        if options.memorise_ms:
            from game.screens.play.map_screen import MapScreen

            self._stage.replace(MapScreen(options.building, options.memorise_ms))
        else:
            self.introduce(options)

    def introduce(self, options: PlayOptions, memorised_ms: int = 0) -> None:
        """Show the page before the mission, whose map was seen for so long; or begin at once."""
        begin = partial(self.play, options, memorised_ms)
        if options.now:
            begin()
            return
        from game.screens.play.start_screen import StartScreen

        about = options.about
        page = StartScreen(options.building, options.settings, options.spec, begin, about)
        self._stage.replace(page)

    def play(self, options: PlayOptions, memorised_ms: int = 0) -> None:
        """A person plays at once, who saw the map for so long before."""
        self._begin(lambda: self._mission(options, memorised_ms))

    def watch(self, options: PlayOptions) -> None:
        """A simulated rescuer plays."""
        self._begin(lambda: self._watching(options))

    def _begin(self, make: Callable[[], LiveScreen]) -> None:
        try:
            screen = make()
        except AnaError as error:
            self._stage.say_or_fail("The mission cannot start", error)
            return
        self._stage.live = screen.live
        self._stage.replace(screen)

    def _mission(self, options: PlayOptions, memorised_ms: int) -> MissionScreen:
        from game.screens.play.free_play_screen import FreePlayScreen
        from game.screens.play.live import LiveMission

        run, journal = self._started(options, memorised_ms=memorised_ms)
        return FreePlayScreen(LiveMission(run, journal), _path(journal), self._stage.preferences)

    def _watching(self, options: PlayOptions) -> WatchScreen:
        from game.rescuers.catalogue import character
        from game.screens.play.coachpanel import OverheardCoach
        from game.screens.play.live import LiveMission
        from game.screens.play.watch_screen import WatchScreen

        building, who = options.building, character(options.rescuer)
        run, journal = self._started(options, rescuer=who.name, build=OverheardCoach.build)
        coach = run.coach
        assert isinstance(coach, OverheardCoach)
        rescuer = who.make(building, options.settings, options.seed)
        return WatchScreen(LiveMission(run, journal), _path(journal), rescuer, coach, who)

    def _started(self, options: PlayOptions, **more: Any) -> tuple[MissionRun, Journal]:
        """The mission and its journal; `more` is what only some missions have."""
        from game.screens.widgets.terminal import this_terminal
        from game.session.playing import start_free_play

        return start_free_play(
            options.building,
            options.settings,
            options.spec,
            options.seed,
            options.log_dir,
            this_terminal(*self._stage.size),
            variant=options.variant,
            **more,
        )


def _path(journal: Journal) -> Path:
    from game.journal.sink import FileSink

    assert isinstance(journal.sink, FileSink)
    return journal.sink.path
