"""A building: a plan with named rooms, doors, victims and a starting place."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum
from functools import cached_property
from hashlib import sha256

from game.world.geometry import Cell, Heading
from game.world.plan import Plan
from game.world.terrain import Terrain, terrain_of


class Severity(StrEnum):
    """RED is severe and expires; BLUE is moderate and persists."""

    RED = "red"
    BLUE = "blue"


@dataclass(frozen=True)
class Room:
    """A named space closed off by walls and doors.

    `cells` are its floor cells (no doors) row by row; `label` is the floor cell nearest the
    centroid: who sees it sees the room's name. `doors` are indices into `Building.doors`.
    """

    name: str
    cells: tuple[Cell, ...]
    label: Cell
    doors: tuple[int, ...]


@dataclass(frozen=True)
class Door:
    """One doorway: one or several door cells side by side, row by row."""

    cells: tuple[Cell, ...]

    @cached_property
    def beside(self) -> frozenset[Cell]:
        """The cells next to its own, its own among them where there are several."""
        return frozenset(way.from_cell(cell) for cell in self.cells for way in Heading)


@dataclass(frozen=True)
class VictimSite:
    """Where a victim lies. `id` is `v01`, `v02`, ... row by row over the plan."""

    id: str
    cell: Cell
    severity: Severity


@dataclass(frozen=True)
class Building:
    """One building as a lab drew it.

    `text` is the whole file (what a journal keeps; for a CSV it is the equivalent building text),
    so that `parse_building(building.text)` gives an equal building.
    """

    name: str
    plan: Plan
    rooms: tuple[Room, ...]
    doors: tuple[Door, ...]
    victims: tuple[VictimSite, ...]
    start: Cell
    start_heading: Heading
    text: str

    @cached_property
    def hash(self) -> str:
        """SHA-256 of the text, in hexadecimal."""
        return sha256(self.text.encode()).hexdigest()

    @cached_property
    def terrain(self) -> Terrain:
        """What the plan alone implies, shared by all who use a building with this plan."""
        return terrain_of(self.plan)

    @cached_property
    def labels(self) -> tuple[tuple[str, Cell], ...]:
        """The rooms' names and where each is written; with the plan, all there is to the rooms."""
        return tuple((room.name, room.label) for room in self.rooms)

    @cached_property
    def _room_of_cell(self) -> dict[Cell, Room]:
        return {cell: room for room in self.rooms for cell in room.cells}

    def room_at(self, cell: Cell) -> Room | None:
        """The room whose floor `cell` belongs to; None in a doorway, a hallway or a wall."""
        return self._room_of_cell.get(cell)

    def room_of(self, victim: VictimSite) -> Room | None:
        return self.room_at(victim.cell)

    def room(self, name: str) -> Room:
        """The room called `name`. Raises KeyError."""
        return self._room_by_name[name]

    @cached_property
    def _room_by_name(self) -> dict[str, Room]:
        return {room.name: room for room in self.rooms}
