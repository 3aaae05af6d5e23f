"""How a person carries out a sentence: as the literal reader does, but for rooms they must find."""

from __future__ import annotations

from collections.abc import Callable

from game.rescuers.literal.execution import Doing, Walker, room_around
from game.rescuers.person.memory import MapMemory
from game.world.geometry import Cell, Heading
from game.world.observation import Observation
from game.world.settings import Controls


class Search:
    """Looking for rooms: which places have been ruled out for which name, and what is tried now."""

    def __init__(self, memory: MapMemory) -> None:
        self.memory = memory
        self.wanted = ""
        self.target: Cell | None = None
        self.under_way = False
        """Whether the person walks without knowing where the room is."""
        self._ruled_out: dict[str, set[Cell]] = {}

    def want(self, room: str) -> None:
        """Look for the room that a sentence names, perhaps with its article."""
        name = room.removeprefix("the ")
        self.wanted = room if self.memory.place(room) is not None else name
        self.target = None

    def known_place(self) -> Cell | None:
        """Where the wanted room is believed to be."""
        place = self.memory.place(self.wanted)
        return None if place in self._ruled_out.get(self.wanted, ()) else place

    def rule_out(self, site: Cell) -> None:
        self._ruled_out.setdefault(self.wanted, set()).add(site)
        if site == self.target:
            self.target = None

    def change_mind(self) -> None:
        """Give up the place that is tried now."""
        place = self.known_place() or self.target
        if place is not None:
            self.rule_out(place)

    def guess(self, now: Observation) -> tuple[Cell, bool]:
        """The place to try next, and whether it is a new one."""
        if self.target is not None:
            return self.target, False
        excluded = self._ruled_out.setdefault(self.wanted, set())
        found = self.memory.next_guess(
            now.terrain.floodfills, self.wanted, now.position, frozenset(excluded)
        )
        if found is None:
            excluded.clear()
            excluded.add(_nearest(self.memory.sites, now.position))
            found = self.memory.next_guess(
                now.terrain.floodfills, self.wanted, now.position, frozenset(excluded)
            )
        self.target = found or self.memory.sites[0]
        return self.target, True


class BoundedWalker(Walker):
    """Carries out one text. `ponder` is called whenever a new place to look in is thought of."""

    def __init__(
        self, controls: Controls, facing: Heading, search: Search, ponder: Callable[[], None]
    ) -> None:
        super().__init__(controls, {}, facing)
        self._search = search
        self._ponder = ponder

    def go_along(self, now: Observation, way: list[Cell]) -> Doing:
        """Step by step over neighbouring cells."""
        for cell in way:
            now = yield from self._step_to(now, cell)
        return now

    def head_for(self, now: Observation, site: Cell) -> Doing:
        """By the shortest way onto a cell."""
        while now.position != site:
            now = yield from self._step_to(now, _next_cell(now, site))
        return now

    def treat_at(self, now: Observation, way: list[Cell]) -> Doing:
        """Along the way to a victim, and press."""
        return (yield from self._treat(now, way))

    def _go_to(self, now: Observation, room: str) -> Doing:
        """To where the room is known to be, else from place to place until its name is seen."""
        search = self._search
        search.want(room)
        while True:
            place = search.known_place()
            search.under_way = place is None
            if place is None:
                place, is_new = search.guess(now)
                if is_new:
                    self._ponder()
            else:
                enclosed = room_around(now.terrain, place)
                if now.position in enclosed:
                    self._room = enclosed
                    return now
            now = yield from self._step_to(now, _next_cell(now, place))
            in_sight = any(seen.label == place for seen in now.rooms)
            if search.under_way and in_sight and search.known_place() is None:
                search.rule_out(place)


def _next_cell(now: Observation, target: Cell) -> Cell:
    """The neighbouring cell from which it is shortest to `target`; where one stands on it, any."""
    plan, to_go = now.plan, now.terrain.floodfills.to(target)
    return plan.cell(min(plan.neighbours[plan.index(now.position)], key=to_go.__getitem__))


def _nearest(sites: tuple[Cell, ...], here: Cell) -> Cell:
    return min(sites, key=lambda site: (abs(site[0] - here[0]) + abs(site[1] - here[1]), site))
