"""The tutorial: a study's own lessons, and its legs in the practice building."""

from __future__ import annotations

from collections.abc import Generator
from dataclasses import replace
from pathlib import Path

from textual.message import Message
from textual.screen import Screen
from textual.widget import Widget

from game.journal.records import SessionEnded, Terminal
from game.journal.sink import FileSink
from game.journal.writer import Journal
from game.screens.play.free_play_screen import FreePlayScreen
from game.screens.play.lesson_screen import LessonOver, LessonScreen
from game.screens.play.live import LiveMission
from game.screens.widgets.planmap import PlanMap
from game.screens.widgets.signs import Signs
from game.session.playing import begin_mission, leave_mission, open_free_play
from game.session.run import MissionRun
from game.study.protocol.practice import (
    PracticeLeg,
    leg_building,
    leg_settings,
    leg_start,
    practice_legs,
)
from game.study.texts import Lesson, Page, shipped_texts
from game.world import load_building
from game.world.geometry import Cell, Heading
from game.world.settings import MissionSettings

BUILDING = "practice"
SEED = 1
"""Which victims are looked for."""
_CLOCK = " The clock keeps running."
"""True of a study alone."""
DONE = Page(
    title="That is all",
    body="You have found six people, told in three ways. In a mission there are more, and the "
    "clock runs.\n\nA coach such as **ana** changes between these ways, as you seem lost or seem "
    "to know your way. With **+** and **-** you can ask for simpler or for shorter words.",
)


RESCUED = "You rescued the victim."
"""What is said once a leg is done."""


class LegMission(LiveMission):
    """A leg in the journal of the tutorial, which outlives it."""

    def end(self) -> None:
        leave_mission(self.run, self.journal, self.now_ms(), "leg_done" if self.done else "quit")

    @property
    def done(self) -> bool:
        """Whether the one who was to be found is treated."""
        return self.run.mission.rescued > 0


class LegScreen(FreePlayScreen):
    """A leg: over once somebody is treated. It has no clock."""

    live: LegMission

    def __init__(self, live: LegMission, journal: Path, greeting: str = "") -> None:
        super().__init__(live, journal)
        self.view.status.timed = False
        self._greeting = greeting

    def on_mount(self) -> None:
        if self._greeting:
            self.tell(self._greeting)

    def refresh_view(self) -> None:
        super().refresh_view()
        if self.live.done:
            self._finish()

    def over(self, *, complete: bool) -> Message:
        return LessonOver(go_on=complete)


class Tutorial:
    """Goes through the lessons by `rules`, but without time pressure, the simplest way of telling
    first. Its journal begins with the
    first leg, in a new folder of `log_dir`."""

    def __init__(self, log_dir: Path, terminal: Terminal, rules: MissionSettings) -> None:
        self._log_dir = log_dir
        self._terminal = terminal
        self._explained = rules
        self._rules = leg_settings(
            replace(rules, show_score=False, allow_pause=False, level_key=False)
        )
        self._building = load_building(BUILDING)
        legs = sorted(practice_legs(self._building, SEED), key=lambda leg: leg.level)
        self._legs = [replace(leg, number=number) for number, leg in enumerate(legs)]
        self._stand: tuple[Cell, Heading] | None = None
        self._journal: Journal | None = None

    def screens(self) -> Generator[Screen[None]]:
        """One screen after the other; each is asked for when the one before is over. Closing the
        iterator ends the session. Raises JournalError if the journal cannot be written."""
        lessons = shipped_texts().lessons
        try:
            yield self._lesson(lessons.walking, Signs(self._explained))
            for leg in self._legs:
                if leg.opens_kind:
                    yield self._lesson(lessons.of(leg.level), before=RESCUED if leg.number else "")
                run, journal = self._begin(leg)
                assert isinstance(journal.sink, FileSink)
                greeting = "" if leg.opens_kind else f"{RESCUED} Find the next one."
                yield LegScreen(LegMission(run, journal), journal.sink.path, greeting)
                self._stand = run.mission.position, run.mission.heading
            yield LessonScreen(DONE)
        finally:
            self._end()

    def _lesson(self, lesson: Lesson, *below: Widget, before: str = "") -> LessonScreen:
        shown = [PlanMap(self._building)] if lesson.map else []
        text = lesson.body.replace(_CLOCK, "")
        page = Page(title=lesson.title, body=f"{before}\n\n{text}" if before else text)
        return LessonScreen(page, *below, *shown)

    def _begin(self, leg: PracticeLeg) -> tuple[MissionRun, Journal]:
        journal = self._journal
        if journal is None:
            journal = open_free_play(self._rules, SEED, self._log_dir, self._terminal)
            journal.enter("practice")
            self._journal = journal
        start, heading = leg_start(self._building, self._legs[: leg.number], self._stand)
        building = leg_building(self._building, leg, start, heading)
        return begin_mission(journal, building, self._rules, leg.spec, SEED), journal

    def _end(self) -> None:
        if self._journal is not None:
            self._journal.enter("session")
            self._journal.append(SessionEnded("finished"))
            self._journal.close()
            self._journal = None
