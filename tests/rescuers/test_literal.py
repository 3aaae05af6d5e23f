"""The literal reader: its grammar, and how it goes about a text it is shown."""

from collections.abc import Iterator
from dataclasses import replace
from random import Random
from typing import get_args

import pytest

from game.coach.acts import InstructionIssued, Level
from game.coach.spec import CoachSpec
from game.journal.records import RunRecord
from game.rescuers.driver import drive
from game.rescuers.literal import LiteralReader, UnreadableInstruction
from game.rescuers.literal.grammar import (
    Approach,
    ExitRoom,
    GoTo,
    LeaveDoorway,
    ProceedTo,
    ProceedToEnd,
    ProceedUntilSeen,
    Sentence,
    Stop,
    TakeDoor,
    TakeDoorAhead,
    Triage,
    Turn,
    Utilize,
    Walk,
    parse,
)
from game.session.playing import assemble
from game.world.building import Severity
from game.world.events import Action, Rescued
from game.world.geometry import Cell, Heading
from game.world.mission import Mission
from game.world.observation import Guidance
from game.world.settings import Controls, MissionSettings
from tests.coach.instructions.office import office

each_control = pytest.mark.parametrize("controls", get_args(Controls))
PLACES = {room.name: room.label for room in office().rooms}


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("Turn left.", Turn("left")),
        ("Turn around.", Turn("around")),
        ("Walk forward 1 step.", Walk(1)),
        ("Walk forward 14 steps.", Walk(14)),
        ("Stop.", Stop()),
        ("Utilize medical equipment.", Utilize()),
        ("Proceed to the end of the hallway.", ProceedToEnd()),
        ("Proceed to the end of the room.", ProceedToEnd()),
        ("Proceed to the third door on your left.", ProceedTo(3, "door", "left")),
        (
            "Proceed to the tenth intersection on your right.",
            ProceedTo(10, "intersection", "right"),
        ),
        ("Proceed until you see a blue victim.", ProceedUntilSeen(Severity.BLUE)),
        ("Enter the second door on your right.", TakeDoor(2, "right")),
        ("Exit by the first door on your left.", TakeDoor(1, "left")),
        ("Enter the door ahead.", TakeDoorAhead()),
        ("Exit by the door ahead.", TakeDoorAhead()),
        ("Enter the room.", LeaveDoorway()),
        ("Enter the hallway.", LeaveDoorway()),
        ("Exit by the nearest door.", ExitRoom()),
        ("Approach and save the red victim.", Approach(Severity.RED)),
        ("Go to the Records Room.", GoTo("the Records Room")),
        ("Triage the blue victim.", Triage(Severity.BLUE)),
    ],
)
def test_the_grammar(text: str, sentence: Sentence) -> None:
    assert parse(text) == (sentence,)


@pytest.mark.parametrize(
    ("text", "unknown"),
    [
        ("Turn left. Jump.", "Jump."),
        ("Walk forward four steps.", "Walk forward four steps."),
        ("Turn left. Walk forward 3 steps", "Walk forward 3 steps"),
        ("Enter the eleventh door on your left.", "Enter the eleventh door on your left."),
        ("turn left.", "turn left."),
    ],
)
def test_an_unknown_sentence_is_named(text: str, unknown: str) -> None:
    with pytest.raises(UnreadableInstruction, match=f"'{unknown}'"):
        parse(text)


class Office:
    """A mission in the office with somebody else's words on the bar."""

    def __init__(
        self, cell: Cell, heading: Heading, controls: Controls = "compass", text: str = ""
    ) -> None:
        begun_here = replace(office(), start=cell, start_heading=heading)
        self.mission = Mission(begun_here, MissionSettings(controls=controls))
        self.reader = LiteralReader(controls, PLACES)
        self.guidance = Guidance(text)
        self.now_ms = 0

    def acts(self, most: int = 100) -> Iterator[Action]:
        """Let the reader act until it waits."""
        for _ in range(most):
            action = self.reader.decide(self.mission.observation(self.guidance))
            if action is None:
                return
            self.mission.step(action, self.now_ms)
            self.now_ms += 1
            yield action


@pytest.mark.parametrize(
    ("controls", "first"),
    [
        ("compass", [Action.NORTH, Action.WEST]),
        ("turn", [Action.TURN_LEFT, Action.FORWARD, Action.TURN_LEFT, Action.FORWARD]),
    ],
)
def test_turns_need_a_key_under_the_turn_controls_alone(
    controls: Controls, first: list[Action]
) -> None:
    text = "Turn left. Walk forward 1 step. Turn left. Walk forward 1 step."
    place = Office((10, 6), Heading.EAST, controls, text)
    assert list(place.acts(most=len(first))) == first
    assert place.mission.position == (9, 5)


@each_control
def test_a_text_that_still_stands_is_carried_out_again(controls: Controls) -> None:
    place = Office((1, 6), Heading.EAST, controls, "Walk forward 2 steps.")
    list(place.acts(most=6))
    assert place.mission.position == (7, 6)


def test_a_new_text_begins_at_its_first_sentence() -> None:
    place = Office((1, 6), Heading.EAST, text="Walk forward 9 steps.")
    list(place.acts(most=3))
    place.guidance = Guidance("Turn left. Walk forward 1 step. Walk forward 1 step.")
    assert list(place.acts(most=1)) == [Action.NORTH]


def test_a_notice_is_not_an_instruction() -> None:
    place = Office((1, 6), Heading.EAST)
    place.guidance = Guidance("Walk forward 2 steps.", "You have passed the door.")
    list(place.acts(most=1))
    place.guidance = Guidance("Walk forward 2 steps.", "")
    list(place.acts(most=1))
    assert place.mission.position == (3, 6)


@pytest.mark.parametrize(
    "text",
    [
        "",
        "Stop.",
        "Turn left.",
        "Approach and save the red victim.",
        "Enter the second door on your right.",
        "Proceed until you see a red victim.",
    ],
)
def test_what_asks_for_nothing_or_cannot_be_done_is_waited_out(text: str) -> None:
    place = Office((19, 6), Heading.EAST, text=text)
    acts = list(place.acts())
    assert len(acts) < 20
    assert place.reader.decide(place.mission.observation(place.guidance)) is None


def test_a_treatment_is_waited_for() -> None:
    place = Office((11, 2), Heading.NORTH, text="Utilize medical equipment.")
    assert list(place.acts()) == [Action.TRIAGE]
    assert place.mission.observation().treatment is not None


@each_control
@pytest.mark.parametrize("room", PLACES)
def test_a_room_is_found_by_its_place_and_searched(room: str, controls: Controls) -> None:
    place = office()
    site = next((v for v in place.victims if place.room_at(v.cell) is place.room(room)), None)
    if site is None:
        text, end = f"Go to the {room}. Triage the red victim.", None
    else:
        text, end = f"Go to the {room}. Triage the {site.severity} victim.", site
    walker = Office((1, 6), Heading.EAST, controls, text)
    acts = list(walker.acts())
    at = place.room_at(walker.mission.position)
    assert at is place.room(room)
    if end is not None:
        assert acts[-1] is Action.TRIAGE
        treatment = walker.mission.observation().treatment
        assert treatment is not None
        assert treatment.severity is end.severity


def test_an_unknown_room_is_named() -> None:
    place = Office((1, 6), Heading.EAST, text="Go to the Ballroom. Triage the red victim.")
    with pytest.raises(UnreadableInstruction, match="the Ballroom"):
        list(place.acts())


def test_the_reader_sees_no_farther_than_the_observation() -> None:
    """With the side wall out of view the door in it does not come abreast."""
    place = Office((1, 6), Heading.EAST, text="Proceed to the first door on your left.")
    seen = place.mission.observation(place.guidance)
    blind = seen._replace(visible=0)
    reader = LiteralReader("compass")
    acts = [reader.decide(blind._replace(position=(x, 6))) for x in range(1, 29)]
    assert acts == [Action.EAST] * 27 + [None]


@each_control
@pytest.mark.parametrize("level", Level)
def test_whole_missions_are_played(level: Level, controls: Controls) -> None:
    """Every victim that a static coach sends the reader to is rescued, and each in its turn."""
    settings = MissionSettings(controls=controls)
    records: list[RunRecord] = []
    run = assemble(office(), settings, CoachSpec("static", level=level), 0, records.extend)
    run.begin()
    drive(run, LiteralReader(controls, PLACES))
    assert run.ended
    rescued = [record.victim for record in records if isinstance(record, Rescued)]
    goals = [record.goal for record in records if isinstance(record, InstructionIssued)]
    assert len(rescued) == len(office().victims)
    assert set(rescued) == set(goals)


class Idle:
    def decide(self, observation: object) -> Action | None:
        return None


class Restless:
    """Presses a key whenever it may, as a child would."""

    def __init__(self) -> None:
        self._random = Random(1)

    def decide(self, observation: object) -> Action | None:
        return self._random.choice(
            [Action.NORTH, Action.EAST, Action.SOUTH, Action.WEST, Action.TRIAGE]
        )


@pytest.mark.parametrize("rescuer", [Idle(), Restless()])
def test_a_mission_ends_whoever_plays_it(rescuer: Idle | Restless) -> None:
    records: list[RunRecord] = []
    spec = CoachSpec("ana", preset="calibrated")
    run = assemble(office(), MissionSettings(), spec, 0, records.extend)
    run.begin()
    drive(run, rescuer)
    assert run.mission.time_ms == run.mission.settings.duration_ms
