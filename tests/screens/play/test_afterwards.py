"""What comes after a mission: its result and its replay, by keys and as rows."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest
from msgspec import structs

from game.coach.acts import InstructionIssued, Level, LevelChanged
from game.coach.spec import CoachSpec, parse_coach
from game.journal.reader import read_journal
from game.journal.records import MissionAbandoned, RunRecord
from game.screens.play.coachpanel import coach_pins, coach_rows
from game.screens.play.mission_story import MissionStory, tell
from game.screens.play.pathmap import END, victim_pin
from game.screens.play.replay_screen import MARKS, ReplayScreen, timeline_rows
from game.screens.play.result import result_rows
from game.screens.widgets.canvas import plain
from game.screens.widgets.charts import ChartStep
from game.screens.widgets.glyphs import HEADING_ARROWS
from game.screens.widgets.minimap import DOOR_SIGN, QUARTER_BLOCKS, MiniMap, map_size
from game.session.playing import begin_mission, end_free_play, start_in_memory
from game.session.replay import Replay
from game.world import load_building
from game.world.building import Building, Severity, VictimSite
from game.world.events import Expired, Rescued
from game.world.observation import VictimState
from game.world.picture import VICTIM_SIGNS
from game.world.settings import MissionSettings
from tests.screens.pilots import Open, press, shown, until


def write_two_missions(folder: Path, ward: Building, coach: CoachSpec | None = None) -> Path:
    """A journal of two missions, the first of C1, or of `coach`, and the second of C2."""
    path, settings = folder / "journal.jsonl", MissionSettings()
    spec = coach or parse_coach("static", 1)
    first, journal = start_in_memory(ward, settings, spec, 1, rescuer="literal", path=path)
    first.advance(1_000)
    journal.append(MissionAbandoned(1_000, "quit"))
    second = begin_mission(journal, ward, settings, parse_coach("static", 2), 2)
    second.advance(1_000)
    end_free_play(second, journal, 1_000)
    return path


async def test_a_replay_steps_through_the_missions_of_a_journal(
    open_app: Open, tmp_path: Path, ward: Building
) -> None:
    written = write_two_missions(tmp_path, ward)
    async with open_app(lambda app: app.replay(written)) as (_, pilot):
        replay = await until(pilot, ReplayScreen)
        assert "static C1" in shown(replay) and "1/2" in shown(replay)
        await press(pilot, "left_square_bracket", "right_square_bracket")
        await pilot.pause()
        replay = await until(pilot, ReplayScreen)
        assert "static C2" in shown(replay) and "2/2" in shown(replay)
        await press(pilot, "right_square_bracket")
        assert await until(pilot, ReplayScreen) is replay, "there is no third mission"


def whole(story: MissionStory) -> MissionStory:
    """The story with every victim in it, as of a mission that was not left at once."""
    return replace(story, revealed=frozenset(story.fates))


@pytest.mark.parametrize(("columns", "rows"), [(77, 22), (117, 38), (197, 58)])
def test_a_mission_left_at_once_gives_no_victim_away(
    tmp_path: Path, ward: Building, columns: int, rows: int
) -> None:
    replay = Replay(read_journal(write_two_missions(tmp_path, ward)))
    replay.seek(replay.duration_ms)
    story = tell(replay)
    assert story.left and not story.revealed
    page = "\n".join(plain(result_rows(story, columns, rows, filled=True)))
    assert "unseen victims are not shown" in page
    assert not {"●", "○"} & set(page)
    everything = "\n".join(plain(result_rows(whole(story), columns, rows, filled=True)))
    assert {"●", "○"} & set(everything)


@pytest.mark.parametrize(("columns", "rows"), [(77, 22), (117, 38), (197, 58)])
def test_both_charts_stand_on_the_first_page_and_use_its_height(
    tmp_path: Path, ward: Building, columns: int, rows: int
) -> None:
    replay = Replay(read_journal(write_two_missions(tmp_path, ward)))
    replay.seek(replay.duration_ms)
    story = replace(whole(tell(replay)), levels=(ChartStep(0, 2), ChartStep(500, 3)))
    lines = plain(result_rows(story, columns, rows, filled=True))
    titles = [i for i, line in enumerate(lines) if "Rescued" in line or "Level of the" in line]
    assert len(titles) == 2 and rows - 18 <= len(lines) <= rows
    assert "Left after 0:01" in lines[2]
    assert [line.split()[0] for line in lines if "Test Lab" in line][-1] == "●", "still waiting"


@pytest.mark.parametrize(("columns", "rows"), [(77, 22), (117, 38), (197, 58)])
def test_a_level_that_never_changed_is_told_in_words(
    tmp_path: Path, ward: Building, columns: int, rows: int
) -> None:
    replay = Replay(read_journal(write_two_missions(tmp_path, ward)))
    replay.seek(replay.duration_ms)
    lines = plain(result_rows(whole(tell(replay)), columns, rows, filled=True))
    assert sum("The coach stayed at C1." in line for line in lines) == 1
    assert not any("Level of the coach" in line for line in lines)
    assert len(lines) <= rows and sum("Test Lab" in line for line in lines) >= 1
    assert all(len(line.rstrip()) <= columns for line in lines)


def test_only_new_words_count_as_instructions(tmp_path: Path, ward: Building) -> None:
    replay = Replay(read_journal(write_two_missions(tmp_path, ward)))
    replay.seek(replay.duration_ms)
    issued = [r for r in replay.records if isinstance(r, InstructionIssued)]
    assert tell(replay).instructions == 1 == len(issued)

    class Repeated(Replay):
        @property
        def records(self) -> tuple[RunRecord, ...]:
            others = structs.replace(issued[0], text="Something else.")
            return (*super().records, issued[0], others, others, issued[0])

    repeated = Repeated(read_journal(tmp_path / "journal.jsonl"))
    repeated.seek(repeated.duration_ms)
    assert tell(repeated).instructions == 3


async def test_beside_a_coach_that_infers_nothing_nothing_is_awaited(
    open_app: Open, tmp_path: Path, ward: Building
) -> None:
    static = write_two_missions(tmp_path, ward)
    async with open_app(lambda app: app.replay(static)) as (_, pilot):
        replay = await until(pilot, ReplayScreen)
        assert "does not judge the walk" in shown(replay) and "Walking to" not in shown(replay)
    (tmp_path / "ana").mkdir()
    adaptive = write_two_missions(tmp_path / "ana", ward, parse_coach("ana"))
    async with open_app(lambda app: app.replay(adaptive)) as (_, pilot):
        replay = await until(pilot, ReplayScreen)
        assert "has not judged the walk" in shown(replay) and "Walking to" in shown(replay)


@pytest.mark.parametrize("columns", [26, 50])
def test_beside_knowledge_stands_what_the_rescuer_knows_and_each_level_costs(
    tmp_path: Path, ward: Building, columns: int
) -> None:
    replay = Replay(read_journal(write_two_missions(tmp_path, ward, parse_coach("knowledge"))))
    judged = replay.thoughts.judged
    assert judged is not None
    lines = plain(coach_rows(replay.thoughts, ward, columns))
    for words in (
        f"knows this room {judged.known[judged.room or '']:.2f}",
        "knows of all 0.50",
        *(f"{name} █" for name in judged.expected_ms),
    ):
        assert any(words in line for line in lines)
    assert all(len(line.rstrip()) <= columns for line in lines)
    pins = coach_pins(replay.thoughts, ward)
    assert set(pins) == {room.label for room in ward.rooms}


def test_on_the_time_line_a_victim_lost_is_never_hidden(tmp_path: Path, ward: Building) -> None:
    lost, saved = Expired(900, "v01"), Rescued(900, "v02")

    class Eventful(Replay):
        @property
        def highlights(self) -> tuple[Rescued | Expired | LevelChanged, ...]:
            return lost, saved, LevelChanged(900, Level.C2, Level.C1, 0.1)

    replay = Eventful(read_journal(write_two_missions(tmp_path, ward)))
    line = plain(timeline_rows(replay, 80, playing=False, speed=1))[2]
    assert "✗" in line and "✓" not in line and "◆" not in line


async def test_the_replay_says_what_space_does_now(
    open_app: Open, tmp_path: Path, ward: Building, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("game.screens.play.replay_screen.FRAME_S", 60.0)
    written = write_two_missions(tmp_path, ward)
    async with open_app(lambda app: app.replay(written)) as (_, pilot):
        replay = await until(pilot, ReplayScreen)
        assert " Space  stop" in shown(replay) and "▶ playing" in shown(replay)
        await press(pilot, "space")
        assert " Space  play" in shown(replay) and "‖ stopped" in shown(replay)


async def test_the_whole_building_is_on_the_map_of_a_replay(open_app: Open, tmp_path: Path) -> None:
    harbour = load_building("harbour")
    written = write_two_missions(tmp_path, harbour)
    for size in ((120, 40), (160, 50)):
        async with open_app(lambda app: app.replay(written), size=size) as (_, pilot):
            replay = await until(pilot, ReplayScreen)
            await pilot.pause()
            columns, rows = map_size(harbour.plan, QUARTER_BLOCKS)
            shown_map = replay.query_one(MiniMap)
            assert shown_map.size.width >= columns and shown_map.size.height >= rows


SITE = VictimSite("v01", (1, 1), Severity.RED)


def test_one_sign_has_one_meaning_on_every_map_and_time_line() -> None:
    """A sign is a victim, the rescuer's way, an event or a door, and never two of them."""
    meanings = {
        "waiting": set(VICTIM_SIGNS.values()),
        "ended": {
            victim_pin(SITE, state)[0] for state in (VictimState.RESCUED, VictimState.EXPIRED)
        },
        "heading": set(HEADING_ARROWS.values()),
        "finish": {END[0]},
        "door": {DOOR_SIGN},
        "new level": {MARKS[LevelChanged][0]},
        "likely": set("0123456789"),
    }
    signs = [sign for group in meanings.values() for sign in group]
    assert len(signs) == len(set(signs))
    assert {MARKS[Rescued][0], MARKS[Expired][0]} == meanings["ended"]
    assert [VICTIM_SIGNS[kind] for kind in (Severity.RED, Severity.BLUE)] == ["●", "○"]
