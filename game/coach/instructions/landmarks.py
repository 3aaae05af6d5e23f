"""What a walker meets in a building, and where each C2 tuple that moves somebody leads.

Everything here follows from the plan and the room names alone, so it is computed once a building,
each part when first asked for. Cells are indices (`Plan.index`); a building's outer wall is closed,
so an index never runs off the plan. `docs/instructions.md` tells the same in words.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from functools import cached_property
from typing import NamedTuple

from game.coach.instructions.vocabulary import MOST_COUNTED, Tuple
from game.world.building import Building, Room
from game.world.geometry import Cell, Heading
from game.world.plan import Tile

ABREAST = 5
"""How far to the side a walker looks for doors and openings, in cells (at most the sight)."""

FLOOR, DOOR = int(Tile.FLOOR), int(Tile.DOOR)

NOWHERE = -1
"""No cell's index."""

EXIT_ROOM: Tuple = ("Exit", "Room")


class Move(NamedTuple):
    """Where carrying out the tuple `said` leads: `steps` cells in all, to `corner`, then straight
    on to `end` with `heading`. `counted` is the highest number it makes the walker count to."""

    said: Tuple
    corner: int
    end: int
    heading: Heading
    steps: int
    counted: int = 1


class Met(NamedTuple):
    """A Door or an Intersection that comes abreast on one side, `to_end` steps before the floor
    ends; `beyond` is the first cell behind a door that can be walked through."""

    thing: str
    side: Heading
    side_name: str
    to_end: int
    beyond: int | None


class _Exits(NamedTuple):
    """The ways out of one room: for each cell the steps to its nearest door cell and that door
    cell (NOWHERE at a tie), and for each door cell the way through it and the cell beyond."""

    nearest: dict[int, tuple[int, int]]
    beyond: dict[int, tuple[Heading, int]]


class Landmarks:
    """The landmarks of one building for walkers with one radius of sight."""

    def __init__(self, building: Building, sight_radius: int) -> None:
        self.building = building
        self.sight = building.terrain.sight(sight_radius)
        self.strides = (-building.plan.width, 1, building.plan.width, -1)
        self._reach = min(ABREAST, sight_radius)
        self._tiles = building.plan.tiles
        self._runs: dict[tuple[int, Heading], tuple[Met, ...]] = {}
        self._moves: dict[tuple[int, Heading], tuple[Move, ...]] = {}
        self._exits: dict[str, _Exits] = {}
        self._lookouts: dict[Cell, int] = {}

    def moves(self, start: int, heading: Heading) -> tuple[Move, ...]:
        """Every tuple that can be carried out straight ahead from `start`, facing `heading`."""
        key = start, heading
        moves = self._moves.get(key)
        if moves is None:
            moves = self._moves[key] = tuple(self._find_moves(start, heading))
        return moves

    def exit(self, start: int) -> Move | None:
        """`Exit Room`: the shortest way over the room's floor to its nearest door cell, through the
        door and onto the first cell beyond. None outside rooms, where two door cells are equally
        near, or where a door cell can be entered from two sides."""
        room = self.building.room_at(self.building.plan.cell(start))
        if room is None:
            return None
        exits = self._exits.get(room.name)
        if exits is None:
            exits = self._exits[room.name] = self._find_exits(room)
        steps, door = exits.nearest.get(start, (0, NOWHERE))
        out = exits.beyond.get(door)
        if out is None:
            return None
        heading, end = out
        onward = (end - door) // self.strides[heading]
        return Move(EXIT_ROOM, door, end, heading, steps + onward)

    def lookouts(self, target: Cell) -> int:
        """The mask of cells from which `target` may be in view: within the radius, and with no
        closed door between; a door is open to who stands in it or beside it."""
        mask = self._lookouts.get(target)
        if mask is None:
            plan, radius = self.building.plan, self.sight.radius
            near = range(max(0, target[0] - radius), min(plan.width, target[0] + radius + 1))
            row = sum(1 << x for x in near)
            square = sum(
                row << y * plan.width
                for y in range(max(0, target[1] - radius), min(plan.height, target[1] + radius + 1))
            )
            room = self.building.room_at(target)
            if room is not None:
                square &= self._at_doors | plan.mask(room.cells)
            mask = self._lookouts[target] = square
        return mask

    def share_room(self, cell: int, target: Cell) -> bool:
        """Whether both lie in the same room, or neither in any."""
        building = self.building
        return building.room_at(building.plan.cell(cell)) is building.room_at(target)

    @cached_property
    def _at_doors(self) -> int:
        """The mask of all door cells and the cells beside them."""
        doors = [cell for door in self.building.doors for cell in door.cells]
        beside = [heading.from_cell(cell) for cell in doors for heading in Heading]
        return self.building.plan.mask([*doors, *beside])

    def path(self, start: int, move: Move) -> list[int]:
        """The cells that a move leads over, without its start."""
        onward = self._straight(move.corner, move.end)
        if move.said != EXIT_ROOM:
            return self._straight(start, move.corner) + onward
        cells = [start]
        for steps in range(move.steps - 1, len(onward), -1):
            around = (cells[-1] + stride for stride in self.strides)
            ways = ((near, self.exit(near)) for near in around)
            cells.append(next(near for near, way in ways if way is not None and way.steps == steps))
        return [*cells[1:], move.corner, *onward]

    def _straight(self, start: int, end: int) -> list[int]:
        """The cells from `start`, left out, to `end` in one row or column."""
        width = self.building.plan.width
        stride = (1 if abs(end - start) < width else width) * (1 if end > start else -1)
        return list(range(start + stride, end + stride, stride)) if end != start else []

    def clear(self, start: int, heading: Heading) -> int:
        """How many floor cells lie straight ahead before the first cell that is none."""
        return self._clear[heading][start]

    @cached_property
    def _clear(self) -> tuple[list[int], ...]:
        """For each heading and index: how many floor cells lie straight ahead before the first
        cell that is none."""
        size = len(self._tiles)
        table = []
        for heading in Heading:
            stride = self.strides[heading]
            clear = [0] * size
            for start in range(size) if stride < 0 else range(size - 1, -1, -1):
                ahead = start + stride
                if 0 <= ahead < size and self._tiles[ahead] == FLOOR:
                    clear[start] = clear[ahead] + 1
            table.append(clear)
        return tuple(table)

    def _find_moves(self, start: int, heading: Heading) -> list[Move]:
        """All moves ahead: through doors, to doors and intersections, to the end of the floor."""
        indoors = self.building.room_at(self.building.plan.cell(start)) is not None
        verb = "Exit" if indoors else "Enter"
        run = self.clear(start, heading)
        moves = self._through_ahead(start, heading, run, verb)
        if not run:
            return moves
        end = start + run * self.strides[heading]
        moves.append(Move(("Proceed", "Room" if indoors else "Hallway"), end, end, heading, run))
        counts: Counter[tuple[str, Heading]] = Counter()
        for met in self._met_on_run(end, heading):
            steps = run - met.to_end
            if steps <= 0 or (indoors and met.thing == "Intersection"):
                continue
            counts[met.thing, met.side] += 1
            count = counts[met.thing, met.side]
            if count > MOST_COUNTED:
                continue
            phrase = f"{count} {met.thing} {met.side_name}"
            cell = start + steps * self.strides[heading]
            if met.beyond is not None:
                total = steps + (met.beyond - cell) // self.strides[met.side]
                moves.append(Move((verb, phrase), cell, met.beyond, met.side, total, count))
            moves.append(Move(("Proceed", phrase), cell, cell, heading, steps, count))
        return moves

    def _met_on_run(self, end: int, heading: Heading) -> tuple[Met, ...]:
        """What comes abreast on the straight floor that ends at `end`, on each side in the order of
        meeting.

        Cells of one doorway are met once, and so is a stretch from which a way leads off; what is
        abreast of the cell before (a doorway into the run, at most) is not met again.
        """
        key = end, heading
        found = self._runs.get(key)
        if found is None:
            found = self._runs[key] = tuple(self._survey(end, heading))
        return found

    def _survey(self, end: int, heading: Heading) -> Iterator[Met]:
        stride = self.strides[heading]
        length = self.clear(end, heading.back) + 1
        for side, name in ((heading.left, "left"), (heading.right, "right")):
            clear, aside = self._clear[side], self.strides[side]
            door_before, open_before = NOWHERE, True
            for to_end in range(length, -1, -1):
                cell = end - to_end * stride
                free = clear[cell]
                is_open = free >= ABREAST <= self._reach
                door = cell + (free + 1) * aside if free < self._reach else NOWHERE
                if self._tiles[door] != DOOR:
                    door = NOWHERE
                if to_end < length:
                    if door != NOWHERE and door - door_before != stride:
                        yield Met("Door", side, name, to_end, self._beyond(door, side))
                    if is_open and not open_before:
                        yield Met("Intersection", side, name, to_end, None)
                door_before, open_before = door, is_open

    def _through_ahead(self, start: int, heading: Heading, run: int, verb: str) -> list[Move]:
        """Through the door straight ahead; and from a doorway onto the first cell beyond it."""
        moves = []
        door = start + (run + 1) * self.strides[heading]
        if self._tiles[door] == DOOR:
            beyond = self._beyond(door, heading)
            if beyond is not None:
                steps = (beyond - start) // self.strides[heading]
                moves.append(Move((verb, "Door"), beyond, beyond, heading, steps))
        if self._tiles[start] == DOOR:
            beyond = self._beyond(start, heading)
            if beyond is not None:
                steps = (beyond - start) // self.strides[heading]
                named = self.building.room_at(self.building.plan.cell(beyond))
                said = "Enter", "Hallway" if named is None else "Room"
                moves.append(Move(said, beyond, beyond, heading, steps))
        return moves

    def _beyond(self, door: int, heading: Heading) -> int | None:
        """The first cell behind a door walked through straight; None where a wall is behind it."""
        stride = self.strides[heading]
        while self._tiles[door] == DOOR:
            door += stride
        return door if self._tiles[door] == FLOOR else None

    def _find_exits(self, room: Room) -> _Exits:
        plan = self.building.plan
        floor = {plan.index(cell) for cell in room.cells}
        doorways = (self.building.doors[door] for door in room.doors)
        doors = [plan.index(cell) for doorway in doorways for cell in doorway.cells]
        ways = ((door, self._way_out(door, floor)) for door in doors)
        beyond = {door: way for door, way in ways if way is not None}
        return _Exits(self._nearest(doors, floor), beyond)

    def _way_out(self, door: int, floor: set[int]) -> tuple[Heading, int] | None:
        """Which way a door cell leads out of a room's `floor`, and the first cell beyond it; None
        where it leads nowhere or can be entered from two sides."""
        ways = [heading for heading in Heading if door - self.strides[heading] in floor]
        beyond = self._beyond(door, ways[0]) if len(ways) == 1 else None
        return None if beyond is None else (ways[0], beyond)

    def _nearest(self, doors: list[int], floor: set[int]) -> dict[int, tuple[int, int]]:
        """For every cell of a room's `floor`: the steps over it to the nearest of `doors`, and
        that door cell; NOWHERE where two are equally near."""
        nearest = {door: (0, door) for door in doors}
        frontier = list(doors)
        for cell in frontier:
            steps, door = nearest[cell]
            for stride in self.strides:
                near = cell + stride
                if near not in floor:
                    continue
                if near not in nearest:
                    nearest[near] = steps + 1, door
                    frontier.append(near)
                elif nearest[near][0] == steps + 1 and nearest[near][1] != door:
                    nearest[near] = steps + 1, NOWHERE
        return nearest
