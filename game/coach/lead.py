"""Whom to lead the rescuer to: the victims still waiting, the route through them, and the goal."""

from __future__ import annotations

from collections.abc import Sequence

from game.coach.api import Briefing
from game.coach.instructions import Scene
from game.world.building import Room, Severity
from game.world.geometry import Cell
from game.world.route import RoutePlanner

GOAL_MS = 10_000
"""No goal is taken away from a rescuer and given back within this time."""

STRAY_GAIN_MOVES = 5
"""After a misstep another goal is set only if it saves somebody more, or so many moves. Straying by
less than half of that cannot gain as much, and the route is not planned again."""


class Lead:
    """The goal is the first victim of the route. All distances are moves; all times mission ms."""

    def __init__(self, briefing: Briefing) -> None:
        self._building, self._settings = briefing.building, briefing.settings
        self._phrases = briefing.phrases
        self._floodfills = self._building.terrain.floodfills
        self._waiting = {site.id: site for site in self._building.victims}
        self._planner = RoutePlanner(
            self._floodfills, self._settings, self._waiting, seed=briefing.seed
        )
        self._nearest = 0
        self._set_ms = -GOAL_MS
        self._any_expired = False
        self.route: tuple[str, ...] = ()
        self.scene = self._scene()

    @property
    def goal(self) -> str:
        """The victim to rescue next. Raises IndexError where the route is empty."""
        return self.route[0]

    @property
    def room(self) -> Room | None:
        """The goal's room."""
        return self.scene.room(self.goal)

    @property
    def farewell(self) -> str:
        """What to say when there is nobody left to lead to."""
        late = self._waiting or self._any_expired
        return self._phrases.notices["nobody_in_time" if late else "all_safe"]

    def set_out(
        self, at_ms: int, position: Cell, ms_per_move: int, route: Sequence[str] | None = None
    ) -> bool:
        """Follow `route`, or the best one from here; whether it leads to anybody."""
        self.route = tuple(route or self._best(at_ms, position, ms_per_move))
        self._set_ms = at_ms
        if self.route:
            self._nearest = self.to_go(position, self.goal)
        return bool(self.route)

    def gone(self, victim: str, *, expired: bool) -> None:
        """`victim` does not wait any more."""
        del self._waiting[victim]
        self._any_expired |= expired
        self.scene = self._scene()

    def walked(self, position: Cell) -> int:
        """How far the goal is, now that the rescuer stands at `position`."""
        distance = self.to_go(position, self.goal)
        self._nearest = min(self._nearest, distance)
        return distance

    def better_route(self, at_ms: int, position: Cell, ms_per_move: int) -> Sequence[str] | None:
        """A route to another goal that is clearly better than going on to this one. None soon after
        this one was set, and where it would be the goal again before long."""
        distance = self.to_go(position, self.goal)
        if 2 * (distance - self._nearest) < STRAY_GAIN_MOVES or at_ms < self._set_ms + GOAL_MS:
            return None
        self._nearest = distance
        best = self._planner.plan(
            position, at_ms, self._waiting, ms_per_move=ms_per_move, before=self.route
        )
        if not best.order or best.order[0] == self.goal:
            return None
        if self.goal in best.order[1:2] and best.rescue_ms[0] < at_ms + GOAL_MS:
            return None
        kept = self._planner.along(self.route, position, at_ms, ms_per_move=ms_per_move)
        return best.order if best.saves(kept, STRAY_GAIN_MOVES * ms_per_move) else None

    def to_go(self, position: Cell, victim: str) -> int:
        """The floodfill value of a waiting victim's cell at `position`."""
        return self._floodfills.distance(position, self._waiting[victim].cell)

    def hopeless(self, victim: str, position: Cell, at_ms: int) -> bool:
        """Whether a red victim will expire before even the fastest keys could treat it."""
        site, settings = self._waiting[victim], self._settings
        if site.severity is Severity.BLUE:
            return False
        moves = max(0, self.to_go(position, victim) - 1)
        done_ms = at_ms + moves * settings.pace_ms + settings.treatment_ms(site.severity)
        return done_ms > settings.reds_expire_ms

    def _best(self, at_ms: int, position: Cell, ms_per_move: int) -> Sequence[str]:
        """The best route; where it is empty, the nearest victim that is not hopeless."""
        route = self._planner.plan(
            position, at_ms, self._waiting, ms_per_move=ms_per_move, before=self.route
        )
        if route.order:
            return route.order
        hopeful = [v for v in self._waiting if not self.hopeless(v, position, at_ms)]
        hopeful.sort(key=lambda v: self.to_go(position, v))
        return hopeful[:1]

    def _scene(self) -> Scene:
        return Scene(self._building, dict(self._waiting), self._settings, self._phrases)
