"""A mission being played now: the run, its journal and its clock, as one thing a screen can use."""

from __future__ import annotations

from game.journal.clock import Clock, MissionClock, Reading, SystemClock
from game.journal.records import Paused, Unpaused
from game.journal.writer import Journal
from game.session.playing import end_free_play
from game.session.run import MissionRun
from game.world.events import Action, LevelWish
from game.world.observation import Observation
from game.world.settings import MissionSettings


class PacedClock:
    """A clock that runs `speed` times as fast as the one behind it."""

    def __init__(self, clock: Clock) -> None:
        self._clock = clock
        self._speed = 1
        self._since_ms = self._from_ms = clock.read().steady_ms

    @property
    def speed(self) -> int:
        return self._speed

    @speed.setter
    def speed(self, speed: int) -> None:
        self._from_ms = self.read().steady_ms
        self._since_ms = self._clock.read().steady_ms
        self._speed = speed

    def read(self) -> Reading:
        now = self._clock.read()
        return now._replace(
            steady_ms=self._from_ms + (now.steady_ms - self._since_ms) * self._speed
        )


class LiveMission:
    """Everything here raises JournalError when the journal can no longer be kept.

    What a key does is in the journal when `press` returns, so before it is painted.
    """

    def __init__(self, run: MissionRun, journal: Journal, clock: PacedClock | None = None) -> None:
        self.run = run
        self.journal = journal
        self.pace = clock or PacedClock(SystemClock())
        self._clock = MissionClock(self.pace)

    @property
    def settings(self) -> MissionSettings:
        return self.run.mission.settings

    @property
    def ended(self) -> bool:
        return self.run.ended

    @property
    def paused(self) -> bool:
        return self._clock.paused

    def observation(self) -> Observation:
        return self.run.observation()

    def press(self, action: Action) -> None:
        """Act now. Nothing happens while the mission is paused."""
        if not self.paused:
            self.run.press(action, self._clock.now_ms())

    def ask_level(self, want: LevelWish) -> bool:
        """Ask the coach for other words now: whether others stand on the bar then. Nothing happens
        while the mission is paused."""
        if self.paused or self.ended:
            return False
        return self.run.ask_level(want, self._clock.now_ms())

    def advance(self) -> None:
        """Let happen what is due."""
        self.run.advance(self._clock.now_ms())

    def now_ms(self) -> int:
        """The mission time."""
        return self._clock.now_ms()

    def due_in_s(self, at_ms: int) -> float:
        """How many seconds of the person's time until mission time `at_ms`."""
        return max(0, at_ms - self._clock.now_ms()) / (1000 * self.pace.speed)

    def pause(self) -> None:
        """Let the mission stand still, if its settings allow that."""
        if self.settings.allow_pause and not self.paused and not self.ended:
            self.advance()
            self._clock.pause()
            self.journal.append(Paused(self._clock.now_ms()))

    def unpause(self) -> None:
        """Let a paused mission go on."""
        if self.paused:
            self.journal.append(Unpaused(self._clock.now_ms()))
            self._clock.unpause()

    def end(self) -> None:
        """End the session and close its journal: some milliseconds, so not on an event loop."""
        end_free_play(self.run, self.journal, self._clock.now_ms())
