"""Small maps of a whole building: half-blocks where there is room, quarter-blocks where there is
not: both are in every terminal's font.

Both draw the walls, leave the doors open and show explored places brighter. Where colours are few
or none, doors have a sign. Pins stand on top.
"""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import ClassVar, NamedTuple, Protocol

from game.screens.widgets.camera import Camera
from game.screens.widgets.canvas import Canvas, Row, Run, sliced
from game.screens.widgets.glyphs import HEADING_ARROWS
from game.world.geometry import Cell
from game.world.observation import Observation
from game.world.plan import Plan, Tile

Pin = Run
"""One character and its style, standing on a small map; without a `/` it takes the map's paper."""
Pins = Mapping[Cell, Pin]

_KNOWN = tuple(f"known-{tile.name.lower()}" for tile in Tile)
_UNKNOWN = tuple(f"map-{tile.name.lower()}" for tile in Tile)
STYLES = frozenset((*_KNOWN, *_UNKNOWN))
"""The component classes of a small map without pins."""
PIN_STYLES = frozenset(
    {"dark", "here", "early", "late", "red", "blue", "rescued", "expired", "name"}
    | {f"likely-{step}" for step in range(5)}
    | {f"trail-{stage}" for stage in range(4)}
)
"""Those of what may stand on it."""

NO_TINTS: Mapping[Cell, str] = MappingProxyType({})

DOOR_SIGN = "+"
_DOORS = ("known-door", "map-door")
_OPEN = ("floor", "door")
_WALLS = ("trail-3", "trail-2", "trail-1", "trail-0", "known-wall", "map-wall")
_GROUNDS = ("known-door", "map-door", "known-floor", "map-floor")
"""Which of its cells gives a quarter-block its colour, and which its ground."""
_QUARTERS = " ▘▝▀▖▌▞▛▗▚▐▜▄▙▟█"
"""By the sum of 1 (upper left), 2 (upper right), 4 (lower left) and 8 (lower right)."""


class Ground(NamedTuple):
    """What lies under the pins: a plan, what is explored of it, and cells in a colour of their own.

    `explored` is a mask over the plan; `tints` gives component classes.
    """

    plan: Plan
    explored: int
    tints: Mapping[Cell, str]

    def shade(self, cell: Cell) -> str:
        """The component class of a cell."""
        if cell not in self.plan:
            return "map-floor"
        if cell in self.tints:
            return self.tints[cell]
        index = self.plan.index(cell)
        names = _KNOWN if self.explored >> index & 1 else _UNKNOWN
        return names[self.plan.tiles[index]]


class Scale(Protocol):
    """How cells become characters: `across` x `down` of them in each; `paper` is behind a pin."""

    across: int
    down: int
    paper: str

    def character(self, ground: Ground, left: int, top: int) -> Run:
        """The character whose first cell is (left, top)."""
        ...


class HalfBlocks:
    """Two cells in a character, one above the other."""

    across, down, paper = 1, 2, "known-floor"

    def character(self, ground: Ground, left: int, top: int) -> Run:
        upper, lower = ground.shade((left, top)), ground.shade((left, top + 1))
        if upper == lower:
            return (" " if upper.endswith(_OPEN) else "█"), f"{upper}/{upper}"
        if not upper.endswith(_OPEN):
            return "▀", f"{upper}/{lower}"
        if not lower.endswith(_OPEN):
            return "▄", f"{lower}/{upper}"
        door, floor = (upper, lower) if upper.endswith("door") else (lower, upper)
        return DOOR_SIGN if door in _DOORS else " ", f"{door}/{floor}"


class QuarterBlocks:
    """Four cells in a character, two above two."""

    across, down, paper = 2, 2, "known-floor"

    def character(self, ground: Ground, left: int, top: int) -> Run:
        shades = [ground.shade((left + dx, top + dy)) for dy in (0, 1) for dx in (0, 1)]
        filled = [not shade.endswith(_OPEN) for shade in shades]
        quarters = _QUARTERS[sum(1 << place for place, full in enumerate(filled) if full)]
        inks = [shade for shade in _WALLS if shade in shades]
        papers = [shade for shade in _GROUNDS if shade in shades]
        return quarters, f"{(inks or papers)[0]}/{(papers or inks)[0]}"


HALF_BLOCKS, QUARTER_BLOCKS = HalfBlocks(), QuarterBlocks()


def map_size(plan: Plan, scale: Scale) -> tuple[int, int]:
    """Columns and rows that a building takes."""
    return -(-plan.width // scale.across), -(-plan.height // scale.down)


class SmallMap:
    """The rows of one building at one scale, some cells in `tints`; with `signs` every character
    with a door in it shows nothing but the door.

    A row is put together again only when it changes, and a character worked out only once for what
    is explored of it: a step of the rescuer costs some microseconds.
    """

    def __init__(
        self,
        plan: Plan,
        scale: Scale,
        tints: Mapping[Cell, str] = NO_TINTS,
        *,
        signs: bool = False,
    ) -> None:
        self.plan = plan
        self.scale = scale
        self.signs = signs
        self._tints = tints
        self._rows: dict[int, tuple[object, Row]] = {}
        self._characters: dict[tuple[int, int, int], Run] = {}
        columns = range(map_size(plan, scale)[0])
        self._masks = [
            plan.mask(
                (column * scale.across + dx, dy)
                for dx in range(scale.across)
                for dy in range(scale.down)
                if column * scale.across + dx < plan.width
            )
            for column in columns
        ]

    def rows(self, explored: int, pins: Pins) -> list[Row]:
        """The map with `explored` (a mask over the plan) brighter, and `pins` on top."""
        down = self.scale.down
        size = self.plan.width * down
        whole = (1 << size) - 1
        rows = []
        for number in range(map_size(self.plan, self.scale)[1]):
            top = number * down
            here = {cell: pin for cell, pin in pins.items() if top <= cell[1] < top + down}
            band = explored >> number * size & whole
            drawn = self._rows.get(number)
            if drawn is None or drawn[0] != (band, here):
                drawn = self._rows[number] = (band, here), self._row(explored, band, top, here)
            rows.append(drawn[1])
        return rows

    def _row(self, explored: int, band: int, top: int, pins: Pins) -> Row:
        pinned = {x // self.scale.across: pin for (x, _), pin in pins.items()}
        row: list[Run] = []
        for column, mask in enumerate(self._masks):
            run = pinned.get(column) or self._character(explored, column, top, band & mask)
            text, style = run if "/" in run[1] else (run[0], f"{run[1]}/{self.scale.paper}")
            if row and row[-1][1] == style:
                row[-1] = row[-1][0] + text, style
            else:
                row.append((text, style))
        return tuple(row)

    def _character(self, explored: int, column: int, top: int, known: int) -> Run:
        key = column, top, known
        run = self._characters.get(key)
        if run is None:
            ground = Ground(self.plan, explored, self._tints)
            left = column * self.scale.across
            sign = self._sign(ground, left, top) if self.signs else None
            run = self._characters[key] = sign or self.scale.character(ground, left, top)
        return run

    def _sign(self, ground: Ground, left: int, top: int) -> Run | None:
        """What stands for a door among the cells of a character."""
        right, below = left + self.scale.across, top + self.scale.down
        shades = {ground.shade((x, y)) for x in range(left, right) for y in range(top, below)}
        door = next((shade for shade in _DOORS if shade in shades), None)
        return (DOOR_SIGN, f"{door}/{door}") if door else None


class MiniMap(Canvas):
    """The building around the rescuer: all of it where it fits, else the part where they are."""

    COMPONENT_CLASSES: ClassVar[set[str]] = {*STYLES, *PIN_STYLES}

    def __init__(self) -> None:
        super().__init__(id="minimap")
        self._map: SmallMap | None = None
        self._camera: Camera | None = None
        self._shown: tuple[Plan, int, Cell, Pins] | None = None

    def show(self, observation: Observation, pins: Pins | None = None) -> None:
        """Draw what is explored, where the rescuer is, and `pins`."""
        arrow = HEADING_ARROWS[observation.heading], "here/here"
        marks = {**(pins or {}), observation.position: arrow}
        self._show(observation.plan, observation.explored, observation.position, marks)

    def _show(self, plan: Plan, explored: int, position: Cell, pins: Pins) -> None:
        self._shown = plan, explored, position, pins
        columns, height = self.size
        if not columns or not height:
            return
        wide, high = map_size(plan, HALF_BLOCKS)
        scale = HALF_BLOCKS if wide <= columns and high <= height else QUARTER_BLOCKS
        small = self._map
        signs = self.app.native_ansi_color
        if small is None or (small.plan, small.scale, small.signs) != (plan, scale, signs):
            small = self._map = SmallMap(plan, scale, signs=signs)
        rows = small.rows(explored, pins)
        size = map_size(plan, scale)
        place = position[0] // scale.across, position[1] // scale.down
        window = self._camera
        if window is None or (window.columns, window.rows) != (columns, height):
            window = Camera.centred(columns, height, place, size)
        window = self._camera = window.follow(place, size)
        top, left = max(0, window.top), max(0, window.left)
        rows = rows[top : top + height]
        if size[0] > columns:
            rows = [sliced(row, left, left + columns) for row in rows]
        self.draw(rows)

    def on_resize(self) -> None:
        if self._shown is not None:
            self._show(*self._shown)
