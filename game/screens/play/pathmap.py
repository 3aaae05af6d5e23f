"""The way walked in a mission, on a small map of its building."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from itertools import chain, pairwise
from typing import Final

from game.screens.play.mission_story import MissionStory
from game.screens.widgets.canvas import Row, Run, width
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
from game.screens.widgets.statuspanel import clock_text
from game.world.building import Severity, VictimSite
from game.world.geometry import Cell, Heading
from game.world.labels import HALF_BLOCKS as LABEL_SCALE
from game.world.labels import label_lines
from game.world.observation import VictimState
from game.world.picture import VICTIM_SIGNS
from game.world.plan import Tile

STAGES = 4
"""So many parts of the mission's time are told apart on the way, the latest the strongest."""
TRAILS = tuple(f"trail-{stage}" for stage in range(STAGES))
_ARROW_INKS = ("early", "early", "late", "late")
"""What an arrow on each of them is drawn in."""
_ARROW_EVERY = 12
"""Along the way so many steps have one arrow."""
_DOT_EVERY = 4
"""Along a wall so many characters of it have one dot."""
_MEANINGS = {
    VictimState.RESCUED: "rescued",
    VictimState.EXPIRED: "died",
    VictimState.WAITING: "not reached",
}
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
        trail = max(ground.tints.get(cell, "") for cell in _cells(self, left, top))
        return text, style if paper.endswith("door") else f"{wall}/{trail}"


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
    trails = _trails(story)
    pins = {} if filled else _dots(story, scale, trails)
    pins |= _arrows(story, scale, trails, filled=filled)
    if named:
        pins |= _names(story)
    for victim in (it for it in building.victims if it.id in story.revealed):
        pins[victim.cell] = victim_pin(victim, story.fates[victim.id].state)
    pins[story.path[-1]] = END
    pins[building.start] = HEADING_ARROWS[building.start_heading], "here/here"
    tints = trails if filled else NO_TINTS
    everything = (1 << len(plan.tiles)) - 1
    return SmallMap(plan, scale, tints, signs=not filled).rows(everything, pins)


def stage(story: MissionStory, at_ms: int) -> int:
    """The part of the mission's time that a moment lies in, from 0."""
    return min(STAGES - 1, STAGES * at_ms // max(1, story.settings.duration_ms))


def _trails(story: MissionStory) -> dict[Cell, str]:
    """The floor that was walked, each cell in the style of when it was walked last."""
    plan = story.building.plan
    return {
        cell: TRAILS[stage(story, at_ms)]
        for cell, at_ms in zip(story.path, story.walked_ms, strict=True)
        if plan.tile(cell) is Tile.FLOOR
    }


def _arrows(
    story: MissionStory, scale: Scale, trails: Mapping[Cell, str], *, filled: bool
) -> dict[Cell, Pin]:
    """Arrows along the way, where a character holds nothing but floor, each the way that led on
    when the cell was walked last."""
    plan = story.building.plan
    last = {cell: step for step, cell in enumerate(story.path)}
    arrows: dict[Cell, Pin] = {}
    since = _ARROW_EVERY // 2
    for step, (cell, after) in enumerate(pairwise(story.path)):
        since += 1
        if since < _ARROW_EVERY or last[cell] != step or cell not in trails:
            continue
        first = cell[0] - cell[0] % scale.across, cell[1] - cell[1] % scale.down
        if {plan.tile(it) for it in _cells(scale, *first) if it in plan} != {Tile.FLOOR}:
            continue
        way = next((way for way in Heading if way.from_cell(cell) == after), None)
        if way is None:
            continue
        trail = trails[cell]
        ink = f"{_ARROW_INKS[TRAILS.index(trail)]}/{trail}" if filled else trail
        arrows[first] = HEADING_ARROWS[way], ink
        since = 0
    return arrows


def way_legend(story: MissionStory, columns: int, *, filled: bool) -> list[Row]:
    """What the signs on the map mean, in rows of `columns`: beginning and end, the colours of the
    way and its arrows, and what became of the victims."""
    start = HEADING_ARROWS[story.building.start_heading], "here/here"
    inks = [f"{trail}/{trail if filled else 'dark'}" for trail in TRAILS]
    sign = "  " if filled else "• "
    full = clock_text(story.settings.duration_ms)
    time: Row = (("your way 0:00 ", "quiet"), *((sign, ink) for ink in inks), (f" {full}", "quiet"))
    parts: list[Row] = [(start, (" start", "quiet")), (END, (" end", "quiet")), time]
    return _in_rows([*parts, *_fates(story)], columns)


def fates_legend(story: MissionStory, columns: int) -> list[Row]:
    """What the signs of the victims shown mean, in rows of `columns`."""
    return _in_rows(_fates(story), columns)


def _fates(story: MissionStory) -> Iterator[Row]:
    """What became of the victims shown: each fate with its signs."""
    shown = [story.fates[victim] for victim in sorted(story.revealed)]
    for state, meaning in _MEANINGS.items():
        signs = dict.fromkeys(
            victim_pin(site, state)
            for site in sorted((it.victim for it in shown if it.state is state), key=_reds_first)
        )
        if signs:
            drawn = [((sign, f"{ink}/dark"), (" ", "")) for sign, ink in signs]
            yield (*chain.from_iterable(drawn), (meaning, "quiet"))


def _reds_first(site: VictimSite) -> bool:
    return site.severity is not Severity.RED


def _in_rows(parts: Iterable[Row], columns: int) -> list[Row]:
    """The parts side by side, in as many rows of `columns` as they take."""
    rows: list[Row] = []
    for part in parts:
        joined: Row = (*rows[-1], ("   ", ""), *part) if rows else part
        if rows and width(joined) <= columns:
            rows[-1] = joined
        else:
            rows.append(part)
    return rows


def _names(story: MissionStory) -> dict[Cell, Pin]:
    """The letters of the rooms' names, each at the upper cell of its character."""
    building = story.building
    taken = {victim.cell for victim in building.victims if victim.id in story.revealed}
    pins: dict[Cell, Pin] = {}
    for room in building.rooms:
        free = tuple(cell for cell in room.cells if cell not in taken)
        for line in label_lines(room.name, free, LABEL_SCALE) if free else ():
            for column, letter in line.letters:
                pins[column, LABEL_SCALE.cells * line.row] = letter, "name"
    return pins


def _cells(scale: Scale, left: int, top: int) -> Iterator[Cell]:
    for y in range(top, top + scale.down):
        for x in range(left, left + scale.across):
            yield x, y


def _dots(story: MissionStory, scale: Scale, trails: Mapping[Cell, str]) -> dict[Cell, Pin]:
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
            dots[first] = "•", trails.get((x, y), TRAILS[0])
            since = 0
    return dots
