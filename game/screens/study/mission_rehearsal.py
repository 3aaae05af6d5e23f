"""The mission of a study and the small windows over it, opened without a person."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import partial
from typing import Any

from textual.screen import Screen

from game.mission_words import Panel
from game.screens.play.missionview import MissionView
from game.screens.study.base import Frame, StudyScreen
from game.screens.study.mission_page import Reminder
from game.screens.study.preflight import WindowTooSmall
from game.screens.widgets.glyphs import PLAIN
from game.screens.widgets.howto import sign_rows, walking_rows
from game.screens.widgets.instruction_bar import lines_needed, longest_guidance
from game.study.folder import Study
from game.study.texts import Page, Texts, followed
from game.world.building import Building, Severity
from game.world.geometry import Heading
from game.world.mission import Mission
from game.world.observation import Observation, SeenVictim, VictimState
from game.world.settings import MissionSettings


@dataclass(frozen=True)
class Opened:
    """A page or window to open: its name, how it is made, and the words that must be seen."""

    name: str
    make: Callable[[], Screen[Any]]
    words: tuple[Page | str, ...]


class MissionStill(StudyScreen[bool]):
    """The mission's screen with one Observation."""

    def __init__(self, frame: Frame, study: Study, seen: Observation, lines: int) -> None:
        self._view = MissionView(study.settings.mission, words=frame.words.mission)
        self._view.bar.lines = lines
        self._seen = seen
        super().__init__(frame, [self._view])

    def on_mount(self) -> None:
        self.call_after_refresh(self._view.show, self._seen)


def mission_pages(frame: Frame, study: Study, building: Building) -> Iterator[Opened]:
    """The mission with the longest instruction of each level, and each with other words on the
    panel."""
    rules, panel = study.settings.mission, frame.words.mission.panel
    rooms = [room.name for one in study.buildings for room in one.rooms]
    lines = lines_needed(study.phrases, rooms, frame.size.columns)
    seen = Mission(building, rules).observation()
    longest = longest_guidance(study.phrases, rooms)
    for number, guidance in enumerate(longest):
        now = _moment(seen, rules, number)._replace(guidance=guidance)
        heading = tuple(Heading)[number % 4]
        facing = getattr(frame.words.mission.directions, heading.name.lower())
        small = (
            panel.left,
            panel.rescued.replace("{count}", "20"),
            panel.facing.replace("{direction}", facing),
            *_doing(panel, frame, number),
        )
        yield Opened(
            f"{building.name} {number + 1}",
            partial(MissionStill, frame, study, now._replace(heading=heading), lines),
            (guidance.text, guidance.notice, *small),
        )


def _moment(seen: Observation, rules: MissionSettings, number: int) -> Observation:
    """First nobody is near, then somebody is two steps away, then beside, then it is too late."""
    x, y = seen.position
    late = number == 3
    time_ms = rules.duration_ms - 1 if late else 0
    victims = tuple(
        SeenVictim((x, y - steps), Severity.BLUE, VictimState.WAITING)
        for steps in {1: (2,), 2: (1,)}.get(number, ())
    )
    return seen._replace(
        rescued=20,
        victims=victims,
        time_ms=time_ms,
        time_left_ms=rules.duration_ms - time_ms,
    )


def _doing(panel: Panel, frame: Frame, number: int) -> tuple[str, ...]:
    match number:
        case 1:
            return (panel.stand_beside,)
        case 2:
            return frame.keys.space, panel.treats
        case 3:
            return (panel.out_of_time,)
        case _:
            return ()


def windows(frame: Frame, texts: Texts, rules: MissionSettings) -> Iterator[Opened]:
    """The questions, the page over a mission, and a window that is too small."""
    words, walking = frame.words, texts.lessons.walking
    yes_and_no = f"{words.yes} {words.no}"
    unnamed = words.finish_text.replace("{count}", "20")
    for title, ask, said in (
        (
            words.stop_title,
            frame.stop_question,
            f"{words.stop_text} {words.stop_yes} {words.stop_no}",
        ),
        (words.decline_title, frame.decline_question, f"{words.decline_text} {yes_and_no}"),
        (words.finish_title, partial(frame.finish_question, 20), f"{unnamed} {yes_and_no}"),
        (words.busy.title, frame.busy_question, f"{words.busy.body} {words.go_on} {words.no}"),
    ):
        letters = f"{frame.keys.yes} {frame.keys.no} {frame.keys.enter}"
        yield Opened(title, ask, (title, said, letters))
    reminder = followed(walking, texts.level_key.text) if rules.level_key else walking
    legend = legend_words(frame, rules)
    yield Opened(
        f"{walking.title} ?", lambda: Reminder(frame, reminder, rules), (reminder, *legend)
    )
    for clock in (words.clock_stopped, words.mission_goes_on):
        yield Opened("small", partial(WindowTooSmall, frame, clock), (clock, words.leave_now))


def legend_words(frame: Frame, rules: MissionSettings) -> tuple[str, ...]:
    """What the signs and keys of a mission mean."""
    words = frame.words.mission
    keys = walking_rows(turning=rules.controls == "turn", words=words)
    rows = [*keys, *sign_rows(PLAIN, rules, words)]
    return tuple(row[-1][0].strip() for row in rows)
