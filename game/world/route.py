"""The route: in which order to rescue the victims that still wait.

A prize-collecting tour with deadlines, built by cheapest insertion and improved by a local search
(2-opt: Croes, 1958; or-opt: Or, 1976). It ends by iterations, never by time.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise, permutations
from random import Random

from game.world.building import Severity, VictimSite
from game.world.floodfill import UNREACHABLE, Floodfills
from game.world.geometry import Cell
from game.world.settings import MissionSettings

WEIGHTS = {Severity.RED: 3, Severity.BLUE: 2}
"""What a rescue is worth to the route: a red victim one and a half times a blue one."""

SPARE_MOVES = 5
"""Red victims are planned to be rescued so many moves before they expire."""

PASSING_BY_MOVES = 2
"""For the sake of so few moves in all nobody is led past the victim that is nearest."""

SEARCH_ROUNDS = 40
"""How many times one start of the search is improved at most."""

FEW = 4
"""An order of so few, as near the end of a mission, is also tried with one of them left out. Where
so few wait, all orders are tried."""

_SEGMENT = 3

_Order = tuple[int, ...]


@dataclass(frozen=True)
class Route:
    """Victims in the order of their rescue, and when each is expected to be rescued (mission ms).

    `worth` is the sum of their `WEIGHTS`; `left_out` are waiting victims that cannot be rescued in
    time along with them.
    """

    order: tuple[str, ...]
    rescue_ms: tuple[int, ...]
    worth: int
    left_out: tuple[str, ...]

    def saves(self, other: Route, least_ms: int) -> bool:
        """Whether this route is worth more than `other`, or as much and over by `least_ms`
        earlier."""
        if self.worth != other.worth or not self.order:
            return self.worth > other.worth
        return self.rescue_ms[-1] + least_ms <= other.rescue_ms[-1]


class RoutePlanner:
    """Routes through one building. `victims` are all that may ever wait in it.

    A victim is treated from beside it. Each has one *stand*, the neighbouring cell that is nearest
    to the other victims; from there the way to the next begins.
    """

    def __init__(
        self,
        floodfills: Floodfills,
        settings: MissionSettings,
        victims: Mapping[str, VictimSite],
        seed: int = 0,
    ) -> None:
        self._plan = floodfills.plan
        self._settings = settings
        self._seed = seed
        self._sites = dict(victims)
        self._to = {name: floodfills.to(site.cell) for name, site in victims.items()}
        self._moves = {name: self._moves_from(self._stand(name)) for name in victims}

    def plan(
        self,
        position: Cell,
        time_ms: int,
        waiting: Collection[str],
        *,
        ms_per_move: int,
        before: Sequence[str] = (),
    ) -> Route:
        """The best route found from `position` at `time_ms` through the victims `waiting`.

        `before` is the route followed so far, from which the search may start. One move's time is
        allowed for beginning each treatment.
        """
        search = self._search(position, time_ms, waiting, ms_per_move)
        best = search.best(before, Random(f"route {self._seed}"))
        return search.route(search.nearest_first(best, PASSING_BY_MOVES * ms_per_move), waiting)

    def reaches_all(
        self, position: Cell, time_ms: int, waiting: Collection[str], *, ms_per_move: int
    ) -> bool:
        """Whether `plan` is soon seen to rescue everybody; where not, it may rescue them still."""
        search = self._search(position, time_ms, waiting, ms_per_move)
        return len(search.earliest_due()) == len(waiting)

    def along(
        self, order: Sequence[str], position: Cell, time_ms: int, *, ms_per_move: int
    ) -> Route:
        """The route that keeps to `order` and skips victims who could not be reached in time."""
        search = self._search(position, time_ms, order, ms_per_move)
        return search.route(search.numbered(order), order)

    def _search(
        self, position: Cell, time_ms: int, victims: Collection[str], ms_per_move: int
    ) -> _Search:
        start = self._moves_from(self._plan.index(position))
        names = tuple(name for name in victims if start[name] < UNREACHABLE - 1)
        sites = [self._sites[name] for name in names]
        rows = [[row[name] for name in names] for row in map(self._moves.__getitem__, names)]
        rows.append([start[name] for name in names])
        return _Search(
            names=names,
            travel=[[moves * ms_per_move for moves in row] + [0] for row in rows],
            stay=[ms_per_move + self._settings.treatment_ms(site.severity) for site in sites],
            due=[self._due_ms(site, SPARE_MOVES * ms_per_move) for site in sites],
            weight=[WEIGHTS[site.severity] for site in sites],
            begin_ms=time_ms,
        )

    def _due_ms(self, site: VictimSite, spare_ms: int) -> int:
        settings = self._settings
        if site.severity is Severity.RED:
            return min(settings.reds_expire_ms - spare_ms, settings.duration_ms)
        return settings.duration_ms

    def _stand(self, name: str) -> int:
        plan = self._plan
        beside = plan.neighbours[plan.index(self._sites[name].cell)]
        everybody = self._to.values()
        return min(beside, key=lambda index: sum([to[index] for to in everybody]))

    def _moves_from(self, index: int) -> dict[str, int]:
        """Moves from a cell until each victim is in reach."""
        return {name: max(0, to[index] - 1) for name, to in self._to.items()}


@dataclass(frozen=True)
class _Search:
    """Orders of n victims, numbered from 0 as in `names`; number n stands for where and how the
    route begins and ends, so `travel[n]` leads from the rescuer and `travel[i][n]` is 0. Times in
    ms."""

    names: tuple[str, ...]
    travel: list[list[int]]
    stay: list[int]
    due: list[int]
    weight: list[int]
    begin_ms: int

    def numbered(self, names: Iterable[str]) -> _Order:
        number = {name: i for i, name in enumerate(self.names)}
        return tuple(number[name] for name in names if name in number)

    def route(self, order: _Order, waiting: Iterable[str]) -> Route:
        """The route of `order` among all who wait."""
        row, at_ms, rescues, worth = self.travel[-1], self.begin_ms, {}, 0
        for i in self.served(order):
            at_ms += row[i] + self.stay[i]
            row = self.travel[i]
            rescues[self.names[i]] = at_ms
            worth += self.weight[i]
        left_out = tuple(name for name in waiting if name not in rescues)
        return Route(tuple(rescues), tuple(rescues.values()), worth, left_out)

    def best(self, before: Iterable[str], random: Random) -> _Order:
        """The best order found from two starts: one that puts in the earliest deadlines first, and
        the order followed `before` (a random one where there is none). Of a few victims no order is
        worth more."""
        numbers = self._by_due()
        first = self._improved(self.earliest_due())
        followed = self.served(self.numbered(before))
        if not followed:
            random.shuffle(numbers)
        second = self._improved(self._inserted(followed, numbers))
        found = self._exchanged(max(first, second, key=self.value))
        if len(numbers) > FEW:
            return found
        best = max(permutations(numbers), key=self.value)
        return found if self.value(found)[0] >= self.value(best)[0] else self.served(best)

    def earliest_due(self) -> _Order:
        """An order to begin with, into which the earliest deadlines are put first. Those whom it
        rescues outweigh none of the best."""
        return self._inserted((), self._by_due())

    def _by_due(self) -> list[int]:
        n = len(self.names)
        return sorted(range(n), key=lambda i: (self.due[i], self.travel[n][i]))

    def nearest_first(self, order: _Order, spare_ms: int) -> _Order:
        """`order` begun with the nearest of its victims, if that saves as many and takes no more
        than `spare_ms` longer."""
        if not order:
            return order
        nearest = min(order, key=self.travel[-1].__getitem__)
        near_first = (nearest, *(i for i in order if i != nearest))
        worth, end = self.value(order)
        near_worth, near_end = self.value(near_first)
        return near_first if near_worth == worth and near_end >= end - spare_ms else order

    def value(self, order: _Order) -> tuple[int, int]:
        """What a walk in this order is worth: the weight of those rescued in time, then how early
        the last is. Victims who could not be reached in time are skipped."""
        travel, stay, due, weight = self.travel, self.stay, self.due, self.weight
        row, at_ms, worth = travel[-1], self.begin_ms, 0
        for i in order:
            done_ms = at_ms + row[i] + stay[i]
            if done_ms <= due[i]:
                row, at_ms = travel[i], done_ms
                worth += weight[i]
        return worth, -at_ms

    def served(self, order: _Order) -> _Order:
        """Those of `order` who are rescued in time."""
        row, at_ms, served = self.travel[-1], self.begin_ms, []
        for i in order:
            done_ms = at_ms + row[i] + self.stay[i]
            if done_ms <= self.due[i]:
                row, at_ms = self.travel[i], done_ms
                served.append(i)
        return tuple(served)

    def _inserted(self, order: _Order, numbers: Iterable[int]) -> _Order:
        """`order` with each of `numbers` that it lacks put in where that is worth most."""
        for i in numbers:
            if i not in order:
                order = self.served(self._with(order, i))
        return order

    def _with(self, order: _Order, i: int) -> _Order:
        """`order` with `i` put in where the whole is worth most, or without it if that is more.

        The places are tried by how much they lengthen the way, so that the first at which nobody
        is late is the best.
        """
        travel, ends = self.travel, (len(self.names),)
        added = [
            travel[a][i] + travel[i][b] - travel[a][b] for a, b in pairwise(ends + order + ends)
        ]
        best, value = order, self.value(order)
        all_in_time = value[0] + self.weight[i]
        for k in sorted(range(len(added)), key=added.__getitem__):
            candidate = (*order[:k], i, *order[k:])
            if (candidate_value := self.value(candidate)) > value:
                best, value = candidate, candidate_value
            if candidate_value[0] == all_in_time:
                break
        return best

    def _exchanged(self, order: _Order) -> _Order:
        """`order`, or where one of its few victims leaves time for others who are worth more, an
        order with those."""
        if not 0 < len(order) < min(len(self.names), FEW + 1):
            return order
        others = [i for i in range(len(self.names)) if i not in order]
        exchanged = (self._inserted(tuple(j for j in order if j != i), others) for i in order)
        return max(order, *exchanged, key=self.value)

    def _improved(self, order: _Order) -> _Order:
        """What becomes of `order` in at most `SEARCH_ROUNDS` improvements."""
        value = self.value(order)
        for _ in range(SEARCH_ROUNDS):
            better = next((o for o in self._shorter(order) if self.value(o) > value), None)
            if better is None:
                better = self._inserted(order, range(len(self.names)))
            if self.value(better) <= value:
                break
            order, value = self.served(better), self.value(better)
        return order

    def _shorter(self, order: _Order) -> Iterator[_Order]:
        """The orders one 2-opt or or-opt change away whose way is shorter."""
        travel, end = self.travel, len(self.names)
        path = (end, *order, end)
        for i in range(len(order)):
            row, first = travel[path[i]], path[i + 1]
            for e in range(i + 1, len(order) + 1):
                last, follow = path[e], path[e + 1]
                leave, away = row[first], travel[last][follow]
                if row[last] + travel[first][follow] < leave + away:
                    yield order[:i] + order[i:e][::-1] + order[e:]
                if e - i <= _SEGMENT:
                    saved = leave + away - row[follow]
                    yield from self._moved(order[:i] + order[e:], order[i:e], saved)

    def _moved(self, rest: _Order, segment: _Order, saved: int) -> Iterator[_Order]:
        """`segment` put into `rest` wherever that adds less than `saved`."""
        first, leave, before = segment[0], self.travel[segment[-1]], len(self.names)
        for k, after in enumerate((*rest, len(self.names))):
            row = self.travel[before]
            if row[first] + leave[after] - row[after] < saved:
                yield rest[:k] + segment + rest[k:]
            before = after
