"""A mission in lines of text, played to its end by doing what the bar says."""

from __future__ import annotations

import io
import subprocess
import sys
from collections.abc import Iterator
from itertools import islice
from pathlib import Path

import pytest

from game.coach.spec import parse_coach
from game.journal.history import MissionHistory, read_history
from game.journal.reader import read_journal
from game.journal.records import SessionEnded
from game.screens.text.text_play import play_text
from game.session.verification import verify
from game.world import load_building
from game.world.building import Building
from game.world.events import Acted
from game.world.settings import MissionSettings
from tests.screens.text.listener import Listener

ROOT = Path(__file__).resolve().parents[3]


def journal_in(folder: Path) -> Path:
    (path,) = folder.glob("*/journal.jsonl")
    return path


def mission_of(folder: Path) -> MissionHistory:
    return read_history(read_journal(journal_in(folder))).missions[0]


def obedient(out: io.StringIO, typed: list[str]) -> Iterator[str]:
    """Types back what the bar said last; looks at the bar again where that led nowhere."""
    for _ in range(2000):
        said = [line for line in out.getvalue().splitlines() if line.startswith("Bar: ")]
        typed.append(said[-1].removeprefix("Bar: "))
        yield typed[-1]


def play(
    building: Building,
    folder: Path,
    lines: Iterator[str],
    out: io.StringIO,
    level: int = 1,
    **rules: object,
) -> None:
    settings = MissionSettings(**{"level_key": True, **rules})  # type: ignore[arg-type]
    spec = parse_coach("static", level)
    assert play_text(building, settings, spec, 7, folder, lines, out) == 0


@pytest.mark.parametrize(
    ("name", "controls"), [("practice", "turn"), ("harbour", "compass"), ("foundry", "turn")]
)
def test_typing_what_the_bar_says_plays_the_whole_mission(
    name: str, controls: str, tmp_path: Path
) -> None:
    typed: list[str] = []
    out, building = io.StringIO(), load_building(name)
    play(building, tmp_path, obedient(out, typed), out, controls=controls)
    mission = mission_of(tmp_path)
    assert mission.end == "ended" and mission.until_ms == 240_000
    rescued = sum(fate == "rescued" for fate, _ in mission.fates.values())
    assert rescued >= 0.7 * len(building.victims), out.getvalue()[-2000:]
    assert mission.missteps == 0
    told = out.getvalue()
    assert f"The mission is over. {rescued} of {len(building.victims)} rescued" in told
    assert "do not understand" not in told
    assert verify(journal_in(tmp_path)).reproduced


def test_what_is_told_is_enough_to_follow_doors_and_hallways(tmp_path: Path) -> None:
    """Played by the lines of text alone: doors and intersections are counted as they are told."""
    out = io.StringIO()
    play(load_building("harbour"), tmp_path, islice(Listener(out).lines(), 3_000), out, level=2)
    mission = mission_of(tmp_path)
    assert mission.end == "ended" and mission.missteps <= 2
    rescued = sum(fate == "rescued" for fate, _ in mission.fates.values())
    assert rescued >= 15, out.getvalue()[-2000:]


def test_what_is_typed_is_a_mission_again(tmp_path: Path) -> None:
    """The same lines through the command's own input give the same actions and words."""
    out = io.StringIO()
    typed: list[str] = []
    play(load_building("practice"), tmp_path / "one", obedient(out, typed), out, duration_ms=60_000)
    command = [sys.executable, "-m", "game", "play", "--text", "--building", "practice"]
    options = ["--coach", "static", "--level", "1", "--seed", "7", "--minutes", "1"]
    again = subprocess.run(
        [*command, *options, "--log", str(tmp_path / "two")],
        input="\n".join(typed) + "\n", capture_output=True, text=True, cwd=ROOT, check=True,
    )  # fmt: skip
    assert again.stdout.splitlines()[:-1] == out.getvalue().splitlines()[:-1]
    one, two = mission_of(tmp_path / "one"), mission_of(tmp_path / "two")
    assert list(one.records) == list(two.records)


class Typing:
    """Types lines in order, and keeps what was answered to each."""

    def __init__(self, *lines: str) -> None:
        self.out = io.StringIO()
        self.answers: list[str] = []
        self._lines = lines

    def __iter__(self) -> Iterator[str]:
        for line in self._lines:
            before = len(self.out.getvalue())
            yield line
            self.answers.append(self.out.getvalue()[before:])


def answers(ward: Building, folder: Path, *lines: str, **rules: object) -> list[str]:
    typing = Typing(*lines)
    play(ward, folder, iter(typing), typing.out, 1, **rules)
    return typing.answers


def test_around_are_ways_doors_people_and_names(ward: Building, tmp_path: Path) -> None:
    told = answers(ward, tmp_path, "look", "map", "status", "w 2", "w 1", "look", "e 4", "seen")
    assert told[0].splitlines() == [
        "Ahead, north: 1 step, then a wall.",
        "Left: 3 steps, a door after 3, then out of sight.",
        "Right: 3 steps, a door after 3, then out of sight.",
        "Behind: 1 step, then a wall.",
        "Doors in view: 3 left; 3 right.",
    ]
    assert "21 cells from west to east and 5 from north to south" in told[1]
    assert "A door, seen: 3 left, 3 steps to walk." in told[1]
    assert told[2].splitlines() == [
        "4 minutes left.", "2 minutes left for red victims.", "0 rescued, 0 points.",
        "You face north.",
    ]  # fmt: skip
    assert "1 step west. You stopped, since the bar has changed." in told[3]
    assert "A red victim: 4 ahead and 1 left." in told[5]
    assert "Records Room: its middle is 5 ahead." in told[5]
    assert told[7].startswith("Seen before. A red victim: ")


def test_who_comes_into_view_again_is_told_again(ward: Building, tmp_path: Path) -> None:
    told = answers(ward, tmp_path, *["w"] * 3, *["e"] * 3, *["w"] * 3)
    seen = [number for number, answer in enumerate(told) if "A red victim: " in answer]
    assert len([number for number in seen if number < 3]) == 1
    assert len([number for number in seen if number >= 6]) == 1


def test_doors_are_told_as_they_are_passed(ward: Building, tmp_path: Path) -> None:
    told = answers(ward, tmp_path, "e 6", "w", "w door", "w door", "w end")
    assert told[0].startswith("6 steps east, through a door.")
    assert "1 step west. You stand in a doorway." in told[3]
    assert "1 step west, through a door." in told[4] and "wall" not in told[4]


@pytest.mark.parametrize(
    ("line", "actions"),
    [
        ("w", ["west"]),
        ("west 1", ["west"]),
        ("Turn left. Walk forward 1 step.", ["west"]),
        ("l 1", ["west"]),
        ("left; forward", ["west"]),
        ("turn around, f 1", ["south"]),
        ("stop", []),
        ("hop", []),
        ("f 99999999", ["north"]),
        ("", []),
    ],
)
def test_one_thing_can_be_typed_in_several_ways(
    ward: Building, tmp_path: Path, line: str, actions: list[str]
) -> None:
    answers(ward, tmp_path, line)
    records = list(mission_of(tmp_path).records)
    assert [it.action.value for it in records if isinstance(it, Acted)] == actions


def test_nothing_but_acting_takes_time(ward: Building, tmp_path: Path) -> None:
    answers(ward, tmp_path, "look", "map", "help", "status", "nonsense", "turn left", "bar")
    assert mission_of(tmp_path).until_ms == 0


def test_treating_takes_its_time_and_is_told(ward: Building, tmp_path: Path) -> None:
    told = answers(ward, tmp_path, "t", "e 6", "treat", "status")
    assert told[0].startswith("Nobody is in reach.")
    assert "A red victim is in reach: type treat." in told[1]
    assert "Rescued. That makes 1 rescued, 30 points." in told[2]
    assert "3 minutes 53 seconds left." in told[3]


def test_leaving_asks_once_and_the_end_of_the_lines_leaves(ward: Building, tmp_path: Path) -> None:
    told = answers(ward, tmp_path / "a", "quit", "look", "q", "q", "f 3")
    assert "Type quit again" in told[0] and "You stay." in told[1] and len(told) == 3
    answers(ward, tmp_path / "b", "f")
    for folder in ("a", "b"):
        last = read_journal(journal_in(tmp_path / folder)).entries[-1].record
        assert last == SessionEnded("quit")
        assert mission_of(tmp_path / folder).end == "abandoned"


def test_names_and_people_out_of_sight_are_not_told(ward: Building, tmp_path: Path) -> None:
    told = "".join(answers(ward, tmp_path, "look", "map", "seen", "status"))
    assert "Test Lab" not in told and "Records Room" not in told and "victim:" not in told


def test_a_map_first_says_where_the_rooms_are(ward: Building, tmp_path: Path) -> None:
    out = io.StringIO()
    spec = parse_coach("static", 3)
    play_text(ward, MissionSettings(), spec, 7, tmp_path, [], out, memorise_ms=60_000)
    told = out.getvalue().splitlines()
    assert told[1:3] == ["Records Room: 7 left; 1 door.", "Test Lab: 6 right; 1 door."]
    assert mission_of(tmp_path).started.memorised_ms == 60_000
