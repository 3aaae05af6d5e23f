"""The result of a mission: its pages, its card, and how it compares with those before it."""

from __future__ import annotations

import asyncio
import xml.etree.ElementTree as ElementTree
from dataclasses import replace
from datetime import datetime, timedelta
from pathlib import Path

import pytest

from game.coach.spec import parse_coach
from game.journal.clock import SystemClock
from game.journal.folders import newest_journals
from game.journal.reader import read_journal
from game.rescuers.catalogue import LITERAL, character
from game.rescuers.driver import drive
from game.screens.play.app import AnaApp
from game.screens.play.benchmark import literal_rescues
from game.screens.play.home import HomeScreen
from game.screens.play.journal_list import JournalsScreen, history_rows
from game.screens.play.mission_screen import MissionScreen
from game.screens.play.mission_story import MissionStory, tell
from game.screens.play.past_missions import (
    PastMission,
    best,
    difficulty,
    past_missions,
    standing,
)
from game.screens.play.result import ResultPage, ResultScreen, result_pages
from game.screens.play.result_card import card_svg, card_text
from game.screens.play.start_screen import StartScreen
from game.screens.widgets import stillness
from game.screens.widgets.canvas import plain, width
from game.screens.widgets.dialogs import Notice
from game.session.playing import end_free_play, start_free_play, start_in_memory
from game.session.replay import Replay
from game.world import load_building
from game.world.building import Building
from game.world.observation import VictimState
from game.world.settings import FREE_PLAY, MissionSettings
from tests.screens.pilots import Open, painted, press, shown, until

SIZES = [(80, 24), (100, 30), (120, 40), (140, 36), (200, 60)]


@pytest.fixture(scope="module")
def story(tmp_path_factory: pytest.TempPathFactory) -> MissionStory:
    """A whole mission of a literal reader in a large building."""
    building, spec = load_building("foundry"), parse_coach("ana")
    path = tmp_path_factory.mktemp("results") / "journal.jsonl"
    run, journal = start_in_memory(building, FREE_PLAY, spec, 5, rescuer=LITERAL, path=path)
    drive(run, character(LITERAL).make(building, FREE_PLAY, 5))
    end_free_play(run, journal, FREE_PLAY.duration_ms)
    replay = Replay(read_journal(path))
    replay.seek(replay.duration_ms)
    return tell(replay)


@pytest.mark.parametrize("size", SIZES)
@pytest.mark.parametrize("constant", [False, True])
def test_the_first_page_needs_no_scrolling(
    story: MissionStory, size: tuple[int, int], constant: bool
) -> None:
    told = replace(story, levels=story.levels[:1]) if constant else story
    columns, rows = size[0] - 3, size[1] - 2
    remarks = [((f"A remark {'that is long ' * 4}", "strong"),)] * 2
    pages = result_pages(told, columns, rows, filled=True, remarks=remarks)
    first = pages["Result"]
    assert len(first) <= rows and all(width(row) <= columns for row in first)
    page = "\n".join(plain(first))
    assert f"{story.rescued} of 20 rescued" in page and "A remark" in page and "Rescued" in page
    assert "your way 0:00" in page or "Way" in pages, "the way has a place"
    assert ("stayed at" in page) is constant
    if 0 < sum(line.count("✓ ●") + line.count("✓ ○") for line in plain(first)) < told.rescued:
        assert "… all on the page" in page, "no list ends without a word"


def test_people_and_words_have_pages_of_their_own(story: MissionStory) -> None:
    pages = result_pages(story, 77, 22, filled=True)
    people, said = (" ".join(plain(pages[name])) for name in ("People", "Said"))
    rooms = {story.building.room_of(site) for site in story.building.victims}
    assert all(room.name[:18] in people for room in rooms if room is not None)
    assert all(word in said for it in story.said for word in it.text.split())
    assert [it.at_ms for it in story.said] == sorted(it.at_ms for it in story.said)
    assert story.instructions <= len(story.said)
    assert "✓ rescued" in people and ("✗ died" in people) is (
        VictimState.EXPIRED in {fate.state for fate in story.fates.values()}
    )


async def test_no_page_is_cut_beside_its_scroll_bar(open_app: Open, story: MissionStory) -> None:
    longest = story.said[0]._replace(text="word " * 60, notice="notice " * 30)
    told = replace(story, said=(longest, *story.said))
    async with open_app(AnaApp.show_home) as (app, pilot):
        result = ResultScreen(told, Path("folder") / "journal.jsonl")
        app.push_screen(result)
        await until(pilot, ResultScreen)
        await asyncio.sleep(stillness.STILL_S + 0.1)
        for name in ("People", "Said"):
            result._turn_to(name)
            await pilot.pause()
            page = result.query_one(ResultPage)
            assert max(map(width, page.rows)) <= page.size.width
        assert "folder" in painted(result).splitlines()[0]


def test_a_card_says_all_of_it_and_no_path_of_the_machine(story: MissionStory) -> None:
    text, svg = card_text(story), card_svg(story)
    for words in (f"{story.rescued} of 20 rescued", "coach ana", "seed 5", story.building.name):
        assert words in text and words in svg
    assert "/" not in text
    levels = text.splitlines()[-1].split()[-1]
    assert {int(level) for level in levels} == {step.value for step in story.levels}
    assert len(levels) == 40
    picture = ElementTree.fromstring(svg)
    drawn = [part.tag.partition("}")[2] for part in picture.iter()]
    assert drawn.count("polyline") >= 4, "the way, in stretches of time"
    walked = {
        (int(x), int(y))
        for line in picture.iter()
        if line.tag.endswith("polyline")
        for x, _, y in (point.partition(",") for point in line.attrib["points"].split())
    }
    assert walked == {(8 * x + 4, 8 * y + 4) for x, y in story.path}


def test_a_literal_reader_of_the_same_mission(story: MissionStory) -> None:
    reached = literal_rescues(story.building, story.settings, story.spec, story.seed)
    assert reached == story.rescued


def past(rescued: int, days: int, **changes: object) -> PastMission:
    mission = PastMission(
        journal=Path(f"{days}"), at=datetime(2026, 1, 1).astimezone() + timedelta(days),
        building="Ward", coach="static C1", difficulty="standard", people=20, rescued=rescued,
        points=10 * rescued, ended=True, rescuer="", map_s=0,
    )  # fmt: skip
    return replace(mission, **changes)  # type: ignore[arg-type]


def test_a_mission_is_compared_with_those_of_its_kind_before_it() -> None:
    others = [
        past(20, 1, coach="ana"), past(20, 1, building="Yard"), past(20, 1, rescuer="literal"),
        past(20, 1, ended=False), past(20, 9), past(20, 1, difficulty="view 3"),
    ]  # fmt: skip
    assert standing(past(5, 5), others) == "Your first full mission here with static C1."
    assert standing(past(5, 5, ended=False), others) == ""
    before = [past(12, 2), past(15, 3), past(11, 4), *others]
    assert standing(past(15, 5), before).startswith("Here with static C1: best 15 (04 Jan 2026)")
    assert "last time 11" in standing(past(15, 5), before)
    assert standing(past(16, 5), before).startswith("Your best here")
    assert not standing(past(17, 5, ended=False), before).startswith("Your best")
    assert best([]) is None


def test_only_what_makes_it_harder_is_difficulty() -> None:
    assert difficulty(MissionSettings(controls="turn", show_score=False)) == "standard"
    told = difficulty(MissionSettings(duration_ms=120_000, sight_radius=3))
    assert told == "120 s, sight radius 3"


def test_past_missions_are_read_from_the_journals(tmp_path: Path, ward: Building) -> None:
    for name, seconds in (("a", 1), ("b", 0)):
        rules = MissionSettings(duration_ms=1_000)
        path = tmp_path / name / "journal.jsonl"
        path.parent.mkdir()
        run, journal = start_in_memory(
            ward, rules, parse_coach("static", 1), 1, rescuer="literal", path=path
        )
        end_free_play(run, journal, 1_000 * seconds)
    (tmp_path / "c").mkdir()
    (tmp_path / "c" / "journal.jsonl").write_text("no journal\n")
    found = past_missions(newest_journals(tmp_path))
    assert {it.journal.parent.name: (it.ended, it.rescuer, it.rescued) for it in found} == {
        "a": (True, "literal", 0),
        "b": (False, "literal", 0),
    }


async def test_the_page_is_deaf_until_the_keys_were_still(
    open_app: Open, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(stillness, "STILL_S", 60.0)
    async with open_app(duration_ms=1_000) as (app, pilot):
        await until(pilot, MissionScreen)
        result: ResultScreen = await until(pilot, ResultScreen)
        for _ in range(8):
            await press(pilot, "enter", "f9", "right")
            assert app.screen is result
            assert result._shown == "Result", "keys go on and on"
        monkeypatch.setattr(stillness, "STILL_S", 0.0)
        await press(pilot, "right")
        assert result._shown == "People"
        await press(pilot, "left", "enter")
        await until(pilot, StartScreen)


async def test_the_card_is_copied_and_written(open_app: Open) -> None:
    async with open_app(duration_ms=1_000) as (app, pilot):
        result = await until(pilot, ResultScreen)
        await asyncio.sleep(stillness.STILL_S + 0.1)
        await press(pilot, "c")
        notice = await until(pilot, Notice)
        assert "0 of 3 rescued" in str(notice.query("Static").last().render())
        assert app.clipboard == card_text(result.story)
        folder = result.journal.parent
        assert (folder / "card.txt").read_text().startswith("ana: 0 of 3 rescued")
        assert (folder / "card.svg").read_text().startswith("<svg")


@pytest.mark.slow
async def test_what_was_reached_before_comes_up_by_itself(open_app: Open) -> None:
    for told in ("first full mission", "best 0"):
        async with open_app(duration_ms=1_000) as (_, pilot):
            result = await until(pilot, ResultScreen)
            for _ in range(1000):
                if told in shown(result) and "exactly as told rescues" in shown(result):
                    break
                await asyncio.sleep(0.02)
            page = " ".join(shown(result).split())
            assert told in page and "exactly as told rescues" in page


def test_a_bar_stands_for_each_finished_mission_of_a_person() -> None:
    missions = [
        past(10, 3), past(20, 1), past(15, 2, coach="ana"), past(9, 4, ended=False),
        past(19, 5, rescuer="literal"),
    ]  # fmt: skip
    rows = history_rows(missions, missions[0].journal, 60, 4)
    drawn = plain(rows)
    assert "Rescued" in drawn[0] and drawn[1].split()[0] == "20"
    bottom = [(text.strip(), style) for text, style in rows[4] if "█" in text]
    assert bottom == [("██", "area"), ("██", "faint"), ("██", "bar")], "the oldest first"
    many = history_rows([past(n % 20, n) for n in range(100)], None, 60, 4)
    assert all(width(row) <= 60 for row in many)


async def test_the_history_shows_missions_and_leads_to_their_results(
    open_app: Open, tmp_path: Path
) -> None:
    for _ in range(2):
        async with open_app(duration_ms=1_000) as (_, pilot):
            await until(pilot, ResultScreen)
    async with open_app(AnaApp.show_home, duration_ms=1_000) as (_, pilot):
        await until(pilot, HomeScreen)
        await press(pilot, "r")
        journals = await until(pilot, JournalsScreen)
        for _ in range(500):
            if "Rescued, mission by mission" in shown(journals):
                break
            await asyncio.sleep(0.02)
        assert "Ward · static C1 · 0 rescued · 1 s" in shown(journals)
        assert f"keptin{tmp_path}" in "".join(shown(journals).split()), "wherever that is"
        await press(pilot, "down", "r")
        result = await until(pilot, ResultScreen)
        assert result.journal == newest_journals(tmp_path)[1]


async def test_home_says_what_was_reached_in_such_a_mission(open_app: Open, tmp_path: Path) -> None:
    rules = MissionSettings(duration_ms=1_000)
    spec, building = parse_coach("ana"), load_building("harbour")
    clock = SystemClock()
    run, journal = start_free_play(building, rules, spec, 1, tmp_path, None, clock=clock)
    end_free_play(run, journal, 1_000)
    async with open_app(AnaApp.show_home, duration_ms=1_000) as (_, pilot):
        home = await until(pilot, HomeScreen)
        for _ in range(500):
            if "best 0, last time 0" in shown(home):
                break
            await asyncio.sleep(0.02)
        assert "best 0, last time 0" in shown(home)
        await press(pilot, "down", "right")
        assert "best" not in shown(home), "not in this building"


async def test_home_says_what_a_literal_reader_reaches_once_a_choice_stands(
    open_app: Open, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked: list[str] = []

    def reached(building: Building, *_: object) -> int:
        asked.append(building.name)
        return 17

    monkeypatch.setattr("game.screens.play.home.DWELL_S", 0.05)
    monkeypatch.setattr("game.screens.play.benchmark.literal_rescues", reached)
    async with open_app(AnaApp.show_home) as (_, pilot):
        home = await until(pilot, HomeScreen)
        for _ in range(500):
            if "doing all that the coach says: 17" in shown(home):
                break
            await asyncio.sleep(0.02)
        assert "doing all that the coach says: 17" in shown(home)
        home._select("victims")
        await press(pilot, "right", "left", "right")
        await asyncio.sleep(0.2)
    assert asked == ["Harbour House"], "nobody knows it for victims that are yet to be placed"
