"""The whole building at once, in half-blocks, with names in its rooms and no victims."""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar

from game.screens.widgets.canvas import Canvas
from game.screens.widgets.minimap import HALF_BLOCKS, STYLES, Pin, SmallMap
from game.world.building import Building, Room
from game.world.geometry import Cell
from game.world.labels import label_lines

HATCHED: Pin = ("░", "name")
"""Fills the room asked about where colours are few."""
GIVEN = "✓"
"""Stands for a name that does not fit the room it was given to."""


class PlanMap(Canvas):
    """A building's map. At first each room has its own name."""

    COMPONENT_CLASSES: ClassVar[set[str]] = {*STYLES, "name", "asked", "asked-name"}

    def __init__(self, building: Building) -> None:
        super().__init__(classes="plan")
        self._building = building
        self.name_rooms({room.name: room.name for room in building.rooms})

    def name_rooms(self, names: Mapping[str, str], asked: Room | None = None) -> None:
        """Show `names` by the rooms' true names, and let the room `asked` about stand out."""
        pins: dict[Cell, Pin] = {}
        tints: dict[Cell, str] = {}
        few = self.app.native_ansi_color
        if asked is not None and few:
            pins = dict.fromkeys(_characters(asked), HATCHED)
        elif asked is not None:
            tints = dict.fromkeys(asked.cells, "asked")
        stands_out = "asked-name" if few else "asked-name/asked"
        for room in self._building.rooms:
            style = stands_out if room is asked else "name"
            name = names.get(room.name, "?" if room is asked else "")
            fitting = label_lines(name, room.cells) or label_lines(GIVEN, room.cells)
            for line in fitting if name else ():
                for column, letter in line.letters:
                    pins[column, HALF_BLOCKS.down * line.row] = letter, style
        plan = self._building.plan
        everything = (1 << len(plan.tiles)) - 1
        self.draw(SmallMap(plan, HALF_BLOCKS, tints, signs=few).rows(everything, pins))


def _characters(room: Room) -> list[Cell]:
    """The upper cells of the characters that show nothing but the room."""
    cells = frozenset(room.cells)
    return [(x, y) for x, y in cells if y % HALF_BLOCKS.down == 0 and (x, y + 1) in cells]
