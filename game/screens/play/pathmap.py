"""The way walked in a mission, on a small map of its building."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

from game.screens.play.mission_story import MissionStory
from game.screens.widgets.canvas import Row, Run
from game.screens.widgets.glyphs import HEADING_ARROWS
from game.screens.widgets.minimap import (
    HALF_BLOCKS,
    NO_TINTS,
    QUARTER_BLOCKS,
    Ground,
    Pin,
    Scale,
    SmallMap,
    map_size,
)
from game.world.building import VictimSite
from game.world.geometry import Cell
from game.world.labels import HALF_BLOCKS as LABEL_SCALE
from game.world.labels import label_lines
from game.world.observation import VictimState
from game.world.picture import VICTIM_SIGNS
from game.world.plan import Tile

TRAIL = "trail"
_DOT_EVERY = 4
"""Along a wall so many characters of it have one dot."""
END: Final[Pin] = "■", "here/here"


class _WalkedQuarters:
    """Four cells in a character, where what was walked lies under the walls and the doors."""

    across, down, paper = QUARTER_BLOCKS.across, QUARTER_BLOCKS.down, QUARTER_BLOCKS.paper

    def character(self, ground: Ground, left: int, top: int) -> Run:
        text, style = QUARTER_BLOCKS.character(ground._replace(tints=NO_TINTS), left, top)
        if not any(cell in ground.tints for cell in _cells(self, left, top)):
            return text, style
        if text.isspace():
            return QUARTER_BLOCKS.character(ground, left, top)
        wall, _, paper = style.partition("/")
        return text, style if paper.endswith("door") else f"{wall}/{TRAIL}"


def victim_pin(victim: VictimSite, state: VictimState) -> Pin:
    """How a victim stands on a small map."""
    if state is VictimState.RESCUED:
        return "✓", "rescued"
    if state is VictimState.EXPIRED:
        return "✗", "expired"
    return VICTIM_SIGNS[victim.severity], str(victim.severity)


def path_map(story: MissionStory, *, columns: int, filled: bool) -> list[Row]:
    """The building with the way walked, its beginning and end, and what became of the victims;
    with room names where there is room for half-blocks.

    `filled` draws the way as an area, else as dots, and every door as a sign.
    """
    building, plan = story.building, story.building.plan
    named = map_size(plan, HALF_BLOCKS)[0] <= columns
    scale: Scale = HALF_BLOCKS if named else _WalkedQuarters()
    pins = {} if filled else _dots(story, scale)
    if named:
        pins |= _names(story)
    for victim in (it for it in building.victims if it.id in story.revealed):
        pins[victim.cell] = victim_pin(victim, story.fates[victim.id].state)
    pins[story.path[-1]] = END
    pins[building.start] = HEADING_ARROWS[building.start_heading], "here/here"
    walked = (cell for cell in story.path if plan.tile(cell) is Tile.FLOOR)
    tints = dict.fromkeys(walked, TRAIL) if filled else NO_TINTS
    everything = (1 << len(plan.tiles)) - 1
    return SmallMap(plan, scale, tints, signs=not filled).rows(everything, pins)


def legend_row(story: MissionStory) -> Row:
    """What the signs of the beginning and the end mean."""
    start = HEADING_ARROWS[story.building.start_heading], "here/here"
    began: Row = (start, (" where you started", "quiet"))
    if story.path[-1] == story.building.start:
        return began
    return (*began, ("   ", ""), END, (" where you finished", "quiet"))


def _names(story: MissionStory) -> dict[Cell, Pin]:
    """The letters of the rooms' names, each at the upper cell of its character."""
    building = story.building
    taken = {victim.cell for victim in building.victims if victim.id in story.revealed}
    pins: dict[Cell, Pin] = {}
    for room in building.rooms:
        free = tuple(cell for cell in room.cells if cell not in taken)
        for line in label_lines(room.name, free, LABEL_SCALE) if free else ():
            for column, letter in enumerate(line.text, start=line.column):
                pins[column, LABEL_SCALE.cells * line.row] = letter, "name"
    return pins


def _cells(scale: Scale, left: int, top: int) -> Iterator[Cell]:
    for y in range(top, top + scale.down):
        for x in range(left, left + scale.across):
            yield x, y


def _dots(story: MissionStory, scale: Scale) -> dict[Cell, Pin]:
    """Dots along the way, each at the first cell of its character: so few on walls that these can
    still be seen, and none on doors."""
    plan = story.building.plan
    dots: dict[Cell, Pin] = {}
    last, since = None, 0
    for x, y in story.path:
        first = x - x % scale.across, y - y % scale.down
        if first == last:
            continue
        last, since = first, since + 1
        tiles = {plan.tile(cell) for cell in _cells(scale, *first) if cell in plan}
        if tiles == {Tile.FLOOR} or (Tile.DOOR not in tiles and since >= _DOT_EVERY):
            dots[first] = "•", TRAIL
            since = 0
    return dots
