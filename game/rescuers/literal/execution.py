"""How each sentence is carried out, from what can be seen and nothing else.

A way of doing something is a generator: it is sent an Observation, yields the next action, and
returns the last Observation when it is done. `docs/instructions.md` has the same in words.
"""

from __future__ import annotations

from collections.abc import Callable, Generator, Mapping
from functools import partial
from typing import Literal

from game.rescuers.literal import looking
from game.rescuers.literal.grammar import (
    Approach,
    ExitRoom,
    GoTo,
    Landmark,
    LeaveDoorway,
    ProceedTo,
    ProceedToEnd,
    ProceedUntilSeen,
    Sentence,
    Side,
    Stop,
    TakeDoor,
    TakeDoorAhead,
    Triage,
    Turn,
    UnreadableInstruction,
    Utilize,
    Walk,
    WalkTo,
)
from game.world.building import Severity
from game.world.events import Action
from game.world.floodfill import cost_to_go
from game.world.geometry import HEADINGS, Cell, Heading
from game.world.observation import Observation
from game.world.plan import Tile
from game.world.settings import Controls
from game.world.terrain import Terrain

Doing = Generator[Action, Observation, Observation]

_COMPASS = {
    Heading.NORTH: Action.NORTH,
    Heading.EAST: Action.EAST,
    Heading.SOUTH: Action.SOUTH,
    Heading.WEST: Action.WEST,
}


class Stuck(Exception):
    """What the sentence asks for cannot be done here."""


class Walker:
    """Somebody who carries out one text, sentence by sentence.

    `facing` is the way the next step will lead: under the compass controls a turn needs no key.
    `places` maps the names of rooms to their label cells.
    """

    def __init__(self, controls: Controls, places: Mapping[str, Cell], facing: Heading) -> None:
        self._controls = controls
        self._places = places
        self._facing = facing
        self._room: frozenset[Cell] | None = None

    def carry_out(self, sentences: tuple[Sentence, ...], now: Observation) -> Doing:
        """Do what a text says. Raises `Stuck` where that is impossible."""
        for sentence in sentences:
            now = yield from self._do(sentence, now)
        return now

    def _do(self, sentence: Sentence, now: Observation) -> Doing:
        match sentence:
            case Turn(way):
                return (yield from self._turn(now, _turned(self._facing, way)))
            case Walk(steps):
                return (yield from self._walk(now, steps))
            case WalkTo(end):
                return (yield from self._walk_to(now, end))
            case Utilize():
                return (yield Action.TRIAGE)
            case Stop():
                return now
            case GoTo(room):
                return (yield from self._go_to(now, room))
            case Triage(severity):
                return (yield from self._find_and_treat(now, severity))
            case Approach(severity):
                return (yield from self._approach(now, severity))
            case ExitRoom():
                return (yield from self._exit_room(now))
            case _:
                return (yield from self._proceed(sentence, now))

    def _proceed(self, sentence: Sentence, now: Observation) -> Doing:
        match sentence:
            case ProceedToEnd():
                while self._floor_ahead(now):
                    now = yield from self._step(now)
            case ProceedUntilSeen(severity):
                while not looking.waiting(now, severity):
                    now = yield from self._step_over_floor(now)
            case ProceedTo(number, landmark, side):
                now = yield from self._to_landmark(now, number, landmark, side)
            case TakeDoor(number, side):
                now = yield from self._to_landmark(now, number, "door", side)
                now = yield from self._turn(now, _turned(self._facing, side))
                now = yield from self._through_door(now)
            case TakeDoorAhead():
                now = yield from self._through_door(now)
            case LeaveDoorway():
                now = yield from self._step(now)
                while now.plan.is_door(now.position):
                    now = yield from self._step(now)
        return now

    def _turn(self, now: Observation, facing: Heading) -> Doing:
        """Face another way: no key under the compass controls, one a quarter turn otherwise."""
        self._facing = facing
        while self._controls == "turn" and now.heading is not facing:
            is_left = now.heading.left is facing
            now = yield Action.TURN_LEFT if is_left else Action.TURN_RIGHT
        return now

    def _step(self, now: Observation) -> Doing:
        """One step ahead. Raises `Stuck` where something is in the way."""
        now = yield from self._turn(now, self._facing)
        before = now.position
        now = yield _COMPASS[self._facing] if self._controls == "compass" else Action.FORWARD
        if now.position == before:
            raise Stuck
        return now

    def _walk(self, now: Observation, steps: int) -> Doing:
        for _ in range(steps):
            now = yield from self._step(now)
        return now

    def _walk_to(self, now: Observation, end: Literal["wall", "door"]) -> Doing:
        """Ahead to the last cell before the wall, or onto the first door cell."""
        while not (end == "door" and now.plan.is_door(now.position)):
            ahead = self._facing.from_cell(now.position)
            if end == "wall" and not now.plan.walkable(ahead):
                break
            now = yield from self._step(now)
        return now

    def _step_over_floor(self, now: Observation) -> Doing:
        if not self._floor_ahead(now):
            raise Stuck
        return (yield from self._step(now))

    def _floor_ahead(self, now: Observation) -> bool:
        return now.plan.tile(self._facing.from_cell(now.position)) is Tile.FLOOR

    def _to_landmark(self, now: Observation, number: int, landmark: Landmark, side: Side) -> Doing:
        """Ahead until the `number`th door or opening comes abreast on one side; what is abreast
        at the start does not count."""
        aside = _turned(self._facing, side)
        before = looking.abreast(now, landmark, aside)
        while number:
            now = yield from self._step_over_floor(now)
            here = looking.abreast(now, landmark, aside)
            if here is not None and not looking.same(landmark, before, here):
                number -= 1
            before = here
        return now

    def _through_door(self, now: Observation) -> Doing:
        """Ahead over floor to a door, through it, and onto the first cell beyond."""
        while self._floor_ahead(now):
            now = yield from self._step(now)
        now = yield from self._step(now)
        while now.plan.is_door(now.position):
            now = yield from self._step(now)
        return now

    def _step_to(self, now: Observation, cell: Cell) -> Doing:
        """One step onto a neighbouring cell. Raises `Stuck` where it is none, as after a slip."""
        facing = next((way for way in HEADINGS if way.from_cell(now.position) == cell), None)
        if facing is None:
            raise Stuck
        self._facing = facing
        return (yield from self._step(now))

    def _exit_room(self, now: Observation) -> Doing:
        """The shortest way over floor to the nearest door, through it, onto the first cell beyond.
        Raises `Stuck` where two doors are equally near."""
        plan = now.plan
        ways = looking.ways_to_nearest(
            now.position, plan.is_door, lambda cell: plan.tile(cell) is Tile.FLOOR
        )
        for cell in _the_only(ways):
            now = yield from self._step_to(now, cell)
        while plan.is_door(now.position):
            now = yield from self._step(now)
        return now

    def _approach(self, now: Observation, severity: Severity) -> Doing:
        """Treat the nearest waiting victim in view. Raises `Stuck` at none, or at a tie."""
        victims = frozenset(looking.waiting(now, severity))
        ways = looking.ways_to_nearest(now.position, victims.__contains__, now.plan.walkable)
        return (yield from self._treat(now, _the_only(ways)))

    def _treat(self, now: Observation, way: list[Cell]) -> Doing:
        """Along the way to a victim until a press treats that one, and the press."""
        victim = way[-1] if way else now.position
        for cell in way:
            if looking.would_treat(now) == victim:
                break
            now = yield from self._step_to(now, cell)
        return (yield Action.TRIAGE)

    def _go_to(self, now: Observation, room: str) -> Doing:
        """By the mini-map into the room whose place is known."""
        label = self._places.get(room) or self._places.get(room.removeprefix("the "))
        if label is None:
            raise UnreadableInstruction(f"I do not know where {room} is")
        self._room = room_around(now.terrain, label)
        to_go = cost_to_go(now.plan, label)
        index = now.plan.index
        while now.position not in self._room:
            around = (way.from_cell(now.position) for way in Heading)
            nearest = min(around, key=lambda cell: to_go[index(cell)])
            now = yield from self._step_to(now, nearest)
        return now

    def _find_and_treat(self, now: Observation, severity: Severity) -> Doing:
        """Look through the room for a waiting victim, the nearest unseen cell first, and treat
        the nearest that has been seen. Raises `Stuck` where the whole room shows none."""
        room = self._room or room_around(now.terrain, now.position)
        index = now.plan.index
        while True:
            known = room.intersection(looking.remembered(now, severity))
            if known:
                ways = looking.ways_to_nearest(now.position, known.__contains__, room.__contains__)
                return (yield from self._treat(now, ways[0]))
            unseen = partial(_is_unseen, room, index, now.explored)
            ways = looking.ways_to_nearest(now.position, unseen, room.__contains__)
            if not ways:
                raise Stuck
            now = yield from self._step_to(now, ways[0][0])


def room_around(terrain: Terrain, cell: Cell) -> frozenset[Cell]:
    """The floor of the room around a floor cell."""
    rooms: dict[Cell, frozenset[Cell]] = terrain.shared("rooms", dict)
    if cell not in rooms:
        rooms[cell] = looking.floor_around(terrain.plan, cell)
    return rooms[cell]


def _is_unseen(
    room: frozenset[Cell], index: Callable[[Cell], int], explored: int, cell: Cell
) -> bool:
    return cell in room and not explored >> index(cell) & 1


def _the_only(ways: list[list[Cell]]) -> list[Cell]:
    """The one way there is. Raises `Stuck` at none, or where several are equally short."""
    if len(ways) != 1:
        raise Stuck
    return ways[0]


def _turned(facing: Heading, way: str) -> Heading:
    return {"left": facing.left, "right": facing.right, "around": facing.back}[way]
