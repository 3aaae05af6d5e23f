"""A participant at a real terminal, who reads its screen and presses its keys.

What a page asks is read off the screen. The way through a building is planned on its plan, and
where the rescuer stands is read in the journal, which has each step before it is painted. Every
key is pressed once, several in one go: none may be lost or overtake another. Only where a page
is deaf for a moment are keys held back.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from pathlib import Path
from time import monotonic

import msgspec

from game.coach.acts import InstructionIssued
from game.forms.form import Form
from game.journal.folders import JOURNAL
from game.journal.records import (
    Allocated,
    Exposed,
    MissionAbandoned,
    MissionStarted,
    QuestionnaireAnswer,
    Record,
)
from game.screens.study.choice import ChoiceScreen
from game.screens.study.form_screen import FormScreen
from game.screens.study.label import LabelScreen
from game.screens.study.pages import PageScreen
from game.screens.study.reason import ReasonScreen
from game.study.folder import Identity, Study
from game.study.protocol.practice import practice_legs
from game.study.protocol.study_session import CODE_LENGTH, CODE_LETTERS, session_seed
from game.world.building import Building, Room, VictimSite
from game.world.events import Acted, Action, MissionEnded, Rescued
from game.world.floodfill import cost_to_go
from game.world.geometry import Cell
from game.world.reading import parse_building
from tests.study.people import towards
from tests.terminal import Ending

PATIENCE_S = 60.0
"""How long anything may take on a busy machine."""
SETTLED_S = 0.3
KEYS = {
    Action.NORTH: "up",
    Action.EAST: "right",
    Action.SOUTH: "down",
    Action.WEST: "left",
    Action.TRIAGE: "space",
}
WALL = re.compile("[▀▄█]")
"""What the walls of a map are drawn with."""


@dataclass
class Walk:
    """A mission, as far as the journal knows it."""

    building: Building
    position: Cell
    actions: int = 0
    rescued: set[str] = field(default_factory=set)
    instruction: str = ""
    exposure_ms: int = 0
    left: bool = False
    """It has ended, or was left before its end."""

    @property
    def over(self) -> bool:
        """Whether there is nothing left to do."""
        return self.left or len(self.rescued) == len(self.building.victims)

    @property
    def nearest(self) -> VictimSite:
        """The victim with the shortest way from here among those not rescued."""
        plan, here = self.building.plan, self.building.plan.index(self.position)
        waiting = (site for site in self.building.victims if site.id not in self.rescued)
        return min(waiting, key=lambda site: cost_to_go(plan, site.cell)[here])

    def note(self, record: Record) -> None:
        """Follow what happened next."""
        match record:
            case InstructionIssued():
                self.instruction = record.text
            case Acted():
                self.position = record.position
                self.actions += 1
            case Rescued():
                self.rescued.add(record.victim)
            case Exposed():
                self.exposure_ms = record.exposure_ms
            case MissionEnded() | MissionAbandoned():
                self.left = True
            case _:
                pass


class LiveJournal:
    """How far the journal at `path` has got; `read_on` brings it up to date."""

    def __init__(self, path: Path) -> None:
        self._path = path
        self._offset = 0
        self._decode = msgspec.json.Decoder(Record).decode
        self.buildings: tuple[str, ...] = ()
        self.missions: list[Walk] = []
        self.answers = 0
        self.read_on()

    def read_on(self) -> None:
        """Note the lines written since the last call."""
        if not self._path.exists():
            return
        with self._path.open("rb") as file:
            file.seek(self._offset)
            read = file.read()
        lines = read[: read.rfind(b"\n") + 1]
        self._offset += len(lines)
        for line in lines.splitlines():
            self._note(self._decode(line))

    def _note(self, record: Record) -> None:
        if isinstance(record, Allocated):
            self.buildings = record.buildings
        elif isinstance(record, MissionStarted):
            building = parse_building(record.building_text)
            self.missions.append(Walk(building, building.start))
        elif isinstance(record, QuestionnaireAnswer):
            self.answers += 1
        elif self.missions:
            self.missions[-1].note(record)


def telling(name: str, names: Sequence[str]) -> str:
    """The shortest prefix of `name` that is in none of the other names."""
    others = [other.casefold() for other in names if other != name]
    beginnings = (name[:length] for length in range(1, len(name) + 1))
    return next(
        typed for typed in beginnings if not any(typed.casefold() in other for other in others)
    )


class TerminalParticipant:
    """A participant logged in at `terminal`. Each method waits for its own screen and returns when
    the next one is up; any of them raises TimeoutError, with the screen."""

    def __init__(self, terminal: Ending, study: Study, identity: Identity) -> None:
        self.terminal = terminal
        self.study = study
        self.identity = identity
        self.journal = LiveJournal(study.home(identity) / JOURNAL)
        self.pressed: list[Action] = []
        """The keys pressed in the current mission, or in the last one."""
        self._entered = len(self.journal.missions)

    # --- before the rounds ----------------------------------------------------------------------

    def preflight(self) -> None:
        """Show that the keys work."""
        words = self.study.texts.words
        self._face(words.preflight.title)
        self._press(self._shows(words.keys_fine), "up", "down", "left", "right", "space")
        self._press(self._shows(self.study.texts.consent.title), "enter")

    def consent(self) -> None:
        """Agree to take part."""
        texts = self.study.texts
        self._choose(texts.consent.title, 1, self._shows(texts.practice.title))

    def practise(self) -> None:
        """Read the lessons, and find and treat the victim of each leg."""
        texts = self.study.texts
        walking = texts.lessons.walking.title
        planned = practice_legs(self.study.practice, session_seed(self.study, self.identity))
        titles = [texts.lessons.of(leg.level).title for leg in planned]
        self._turn_page(texts.practice.title, self._shows(walking))
        self._turn_page(walking, self._shows(titles[0]))
        for leg, title in zip(planned, titles, strict=True):
            if leg.opens_kind:
                self._turn_page(title, self._begun)
            self._enter_mission()
            assert self._clock not in self.terminal.text()
            self.walk()
        self._wait(self._shows(self._form("check").title))

    def answer_check(self, answers: Sequence[int]) -> None:
        """Give `answers`, from 1, to the questions at the end of practice."""
        texts, check = self.study.texts, self._form("check")
        titles = [check.title] * (len(check.questions) - 1) + [texts.memorise.title]
        for question, answer, following in zip(check.questions, answers, titles, strict=True):
            told = texts.check_right if answer == question.right else texts.check_wrong
            self._wait(self._shows(question.text))
            self._choose(check.title, answer, self._shows(told.title))
            self._turn_page(told.title, self._shows(following))

    # --- a round --------------------------------------------------------------------------------

    def memorise(self) -> None:
        """Look at the map until it disappears by itself."""
        texts = self.study.texts
        self._turn_page(texts.memorise.title, self._shows(f" {texts.words.left}"))
        self._wait(self._shows(texts.label.title))

    def label(self, round_: int, *, right: int, wrong: int) -> dict[str, str]:
        """Name `right` rooms correctly, then `wrong` rooms with another one's name, and finish;
        returns the names given, by the rooms' true names."""
        texts, given = self.study.texts, dict[str, str]()
        building = self.study.building(self.journal.buildings[round_ - 1])
        self._turn_page(texts.label.title, self._shows(f" {texts.words.left}"))
        self._face(f"1 / {len(building.rooms)}", LabelScreen.DEAF_S)
        for number in range(1, right + wrong + 1):
            room = self._next_room(building, given)
            free = (other.name for other in building.rooms if other.name not in given.values())
            name = next(other for other in free if (other == room.name) is (number <= right))
            given[room.name] = name
            typed = telling(name, [other.name for other in building.rooms])
            self._press(self._shows(f"✓ {number}"), typed, "enter")
        self._press(self._shows(texts.words.finish_title), "a", "backspace", "up", "enter")
        self._press(self._shows(texts.mission.title), "y")
        return given

    def begin_mission(self) -> None:
        """Read the page about the mission, and begin it."""
        self._turn_page(self.study.texts.mission.title, self._begun)
        self._enter_mission()
        assert self._clock in self.terminal.text()

    def fill(self, form: str, key: str) -> None:
        """Answer every question of a form with the same key, each where it is in view."""
        asked = self._form(form)
        self._face(asked.title, FormScreen.DEAF_S)
        for number in range(1, len(asked.questions) + 1):
            self._press(self._answered(self.journal.answers + 1), key)
            if number < len(asked.questions):
                self._press(self._settled(), "down")
        self._press(self._shows(asked.title, no=True), "enter")

    def walk(self, enough: Callable[[Walk], bool] = lambda _: False) -> None:
        """Rescue one victim after the other until `enough` are rescued or the mission is over."""
        walk, self.pressed = self.journal.missions[-1], []

        def stop() -> bool:
            return walk.over or enough(walk)

        while not stop():
            goal = walk.nearest
            while walk.position != goal.cell and not stop():
                self._act(walk, towards(walk.building.plan, walk.position, goal.cell))
            if not stop():
                self._act(walk, Action.TRIAGE)
                self._wait(self._rescued(walk, goal))

    def slide(self, values: Mapping[str, int]) -> None:
        """Move each slider to its value, by item."""
        sliders, likert = self._form("sliders"), self._form("likert")
        self._face(sliders.title, FormScreen.DEAF_S)
        items = {slider.text: slider.id for slider in sliders.questions}
        self._answer({text: (str(values[it]), f" {values[it]} ") for text, it in items.items()})
        self._press(self._shows(likert.title), "enter")

    def rate(self, values: Mapping[str, int]) -> None:
        """Rate each statement with its value, by item."""
        likert = self._form("likert")
        scale = likert.answers
        self._face(likert.title, FormScreen.DEAF_S)
        points = {it.text: values[it.id] for it in likert.questions}
        self._answer({text: (str(n), f"● {scale[n - 1]} ") for text, n in points.items()})
        self._press(self._shows(likert.title, no=True), "enter")

    def _form(self, name: str) -> Form:
        return self.study.forms.occasion(name).form

    # --- after the rounds -----------------------------------------------------------------------

    def prefer(self, round_: int) -> None:
        """Prefer the instructor of a round."""
        texts = self.study.texts
        self._choose(texts.preference.title, round_, self._shows(texts.reason.title))

    def explain(self, words: str) -> None:
        """Say why, in one line."""
        texts = self.study.texts
        self._face(texts.reason.title, ReasonScreen.DEAF_S)
        self._press(self._shows(texts.debrief.title), words, "enter")

    def leave(self) -> str:
        """Read the debriefing and close it; returns the completion code."""
        self._face(self.study.texts.debrief.title, PageScreen.DEAF_S)
        code = re.search(rf"(?m)^\s*([{CODE_LETTERS}]{{{CODE_LENGTH}}})$", self.terminal.text())
        assert code is not None, self.terminal.text()
        self.terminal.press("enter")
        assert self.terminal.wait(PATIENCE_S) == 0
        return code[1]

    # --- pages ----------------------------------------------------------------------------------

    def _turn_page(self, title: str, following: Callable[[], bool]) -> None:
        self._face(title, PageScreen.DEAF_S)
        self._press(following, "enter")

    def _choose(self, title: str, number: int, following: Callable[[], bool]) -> None:
        self._face(title, ChoiceScreen.DEAF_S)
        self._press(following, str(number), "enter")

    def _answer(self, answers: Mapping[str, tuple[str, str]]) -> None:
        """Press the keys for each question, in page order, and see its mark below it."""
        self._wait(lambda: len(self._lines_below(answers)) == len(answers))
        keys = [
            key for question in self._lines_below(answers) for key in (answers[question][0], "down")
        ]
        self._press(
            lambda: all(answers[it][1] in line for it, line in self._lines_below(answers).items()),
            *keys[:-1],
        )

    def _lines_below(self, questions: Iterable[str]) -> dict[str, str]:
        """The line below each question, by question, from top to bottom."""
        lines = self.terminal.text().split("\n")
        return {
            question: f"{below} "
            for line, below in pairwise(lines)
            for question in questions
            if question in line
        }

    def _next_room(self, building: Building, given: Mapping[str, str]) -> Room:
        """The room asked about, once it is one without a name."""

        def ready() -> bool:
            room = self._asked_room(building)
            return room is not None and room.name not in given

        self._wait(ready)
        room = self._asked_room(building)
        assert room is not None
        return room

    def _asked_room(self, building: Building) -> Room | None:
        """The room with the question mark, by its place on the map, whose characters show two
        cells each, one above the other. None until all of that is painted."""
        rows = [line for line in self.terminal.text().split("\n") if WALL.search(line)]
        if len(rows) < building.plan.height / 2:
            return None
        left = min(line.index(wall[0]) for line in rows if (wall := WALL.search(line)))
        for row, line in enumerate(rows):
            if "?" in line:
                return building.room_at((line.index("?") - left, 2 * row))
        return None

    # --- missions -------------------------------------------------------------------------------

    @property
    def _clock(self) -> str:
        """How the panel shows the red victims' time in missions, but not in practice."""
        return self.study.texts.words.mission.panel.for_reds.replace("{time}", "").strip()

    def _begun(self) -> bool:
        return len(self.journal.missions) > self._entered

    def _enter_mission(self) -> None:
        """Wait until a new mission is on the screen, with its complete instruction."""
        self._wait(self._begun)
        self._entered += 1
        self._wait(self._instructed)

    def _instructed(self) -> bool:
        instruction = self.journal.missions[-1].instruction
        shown = self.terminal.text().replace("▌", " ")
        return bool(instruction) and "".join(instruction.split()) in "".join(shown.split())

    def _act(self, walk: Walk, action: Action) -> None:
        """Press a key and wait until its effect is recorded."""
        before = walk.actions
        self.pressed.append(action)
        self._press(lambda: walk.actions > before or walk.left, KEYS[action])

    @staticmethod
    def _rescued(walk: Walk, site: VictimSite) -> Callable[[], bool]:
        return lambda: site.id in walk.rescued or walk.left

    # --- patience -------------------------------------------------------------------------------

    def _answered(self, count: int) -> Callable[[], bool]:
        return lambda: self.journal.answers >= count

    def _settled(self) -> Callable[[], bool]:
        """Ready after a moment: where a page scrolls, nothing else tells that it has."""
        until = monotonic() + SETTLED_S
        return lambda: monotonic() > until

    def _shows(self, text: str, *, no: bool = False) -> Callable[[], bool]:
        return lambda: (text in self.terminal.text()) is not no

    def _face(self, text: str, deaf_s: float = 0.0) -> None:
        """Wait for a screen, and then until it accepts keys."""
        self._wait(self._shows(text))
        self.terminal.read_for(deaf_s)

    def _press(self, ready: Callable[[], bool], *keys: str) -> None:
        """Press the keys once and wait for what follows."""
        self.terminal.press(*keys)
        self._wait(ready, f" after {', '.join(keys)}")

    def _wait(self, ready: Callable[[], bool], after: str = "") -> None:
        """Read what is shown and recorded, until `ready`."""
        until = monotonic() + PATIENCE_S
        while not ready():
            if monotonic() > until or not self.terminal.read_for(0.005):
                raise TimeoutError(f"nothing more came{after}; the screen:\n{self.terminal.text()}")
            self.journal.read_on()
