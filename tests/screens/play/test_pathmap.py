"""The map of the way walked: it hides no wall and no door, and says where the way went."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from game.coach.spec import parse_coach
from game.journal.reader import read_journal
from game.screens.play.mission_story import MissionStory, tell
from game.screens.play.pathmap import path_map, way_legend
from game.screens.widgets.canvas import Row, plain, width
from game.screens.widgets.minimap import DOOR_SIGN, HALF_BLOCKS, QUARTER_BLOCKS, SmallMap
from game.session.playing import end_free_play, start_in_memory
from game.session.replay import Replay
from game.world import load_building
from game.world.events import Action
from game.world.geometry import Cell
from game.world.plan import Tile
from game.world.settings import MissionSettings

HARBOUR = load_building("harbour")
NARROW, WIDE = 77, 120
WALK = [Action.NORTH] * 12 + [Action.WEST] * 12 + [Action.NORTH] * 14 + [Action.EAST] * 20


@pytest.fixture
def story(tmp_path: Path) -> MissionStory:
    """A walk out of the lobby, along hallways and their walls."""
    path = tmp_path / "journal.jsonl"
    run, journal = start_in_memory(
        HARBOUR, MissionSettings(), parse_coach("static", 1), 1, rescuer="literal", path=path
    )
    for number, action in enumerate(WALK, start=1):
        run.act(action, 200 * number, 200 * number)
    run.advance(20_000)
    end_free_play(run, journal, 20_000)
    replay = Replay(read_journal(path))
    replay.seek(replay.duration_ms)
    return tell(replay)


def characters(rows: list[Row]) -> list[list[tuple[str, str]]]:
    return [[(letter, style) for text, style in row for letter in text] for row in rows]


@pytest.mark.parametrize("columns", [NARROW, WIDE])
@pytest.mark.parametrize("filled", [True, False])
def test_the_way_hides_no_wall_and_no_door(story: MissionStory, columns: int, filled: bool) -> None:
    plan = HARBOUR.plan
    scale = HALF_BLOCKS if columns == WIDE else QUARTER_BLOCKS
    bare = SmallMap(plan, scale, signs=not filled).rows((1 << len(plan.tiles)) - 1, {})
    drawn = characters(path_map(story, columns=columns, filled=filled))
    pinned = {story.building.start, story.path[-1], *(v.cell for v in HARBOUR.victims)}
    places = {(x // scale.across, y // scale.down) for x, y in pinned}
    kept, dotted = 0, 0
    for row, line in enumerate(characters(bare)):
        for column, (letter, style) in enumerate(line):
            now, ink = drawn[row][column]
            if letter == " " or (column, row) in places:
                continue
            if now == "•" and letter != DOOR_SIGN:
                dotted += 1
            elif now != letter:
                assert letter == DOOR_SIGN and ink.endswith("door"), "the way beside a door"
            else:
                kept += 1
                assert ink.partition("/")[0] == style.partition("/")[0]
    assert kept > 500 and dotted <= (0 if filled else len(story.path) // 4)


@pytest.mark.parametrize("columns", [NARROW, WIDE])
@pytest.mark.parametrize("filled", [True, False])
def test_the_way_is_drawn_from_its_beginning_to_its_end(
    story: MissionStory, columns: int, filled: bool
) -> None:
    scale = HALF_BLOCKS if columns == WIDE else QUARTER_BLOCKS
    drawn = characters(path_map(story, columns=columns, filled=filled))

    def at(cell: Cell) -> tuple[str, str]:
        return drawn[cell[1] // scale.down][cell[0] // scale.across]

    assert len(story.path) > 20
    assert at(story.path[0])[0] == "▲" and at(story.path[-1])[0] == "■"
    walked = [cell for cell in story.path if HARBOUR.plan.tile(cell) is Tile.FLOOR]
    trail = [cell for cell in walked if "trail" in at(cell)[1]]
    assert len(trail) > len(walked) * (0.8 if filled else 0.3)
    for across in (48, WIDE):
        legend = way_legend(story, across, filled=filled)
        assert all(width(row) <= across for row in legend)
        told = " ".join(plain(legend))
        for words in ("▲ start", "■ end", "your way 0:00", "4:00"):
            assert words in told


@pytest.mark.parametrize("filled", [True, False])
def test_names_stand_whole_over_the_way(story: MissionStory, filled: bool) -> None:
    text = "\n".join(plain(path_map(story, columns=WIDE, filled=filled)))
    for room in HARBOUR.rooms:
        assert all(word in text for word in room.name.split())


@pytest.mark.parametrize("columns", [NARROW, WIDE])
def test_the_way_says_when_and_in_which_direction(story: MissionStory, columns: int) -> None:
    quick = replace(story, settings=replace(story.settings, duration_ms=12_000))
    drawn = characters(path_map(quick, columns=columns, filled=True))
    styles = {style for line in drawn for _, style in line}
    for stage in (0, 2, 3):
        assert any(f"trail-{stage}" in style for style in styles), "walked last then"
    arrows = {
        letter for line in drawn for letter, style in line if style.startswith(("early", "late"))
    }
    assert "▶" in arrows and "▼" not in arrows, "the walk went north, west and east"
    slow = characters(path_map(story, columns=columns, filled=True))
    assert not any("trail-1" in style for line in slow for _, style in line), "still early"
