"""The mission: one run in one building, and its rules. No clock, no I/O, no screen, no coach.

Time is an argument. Everything that falls due fires at its own due time, in the order of `Order`
at a tie; so extra steps without an action change nothing.
"""

from __future__ import annotations

from enum import IntEnum
from itertools import chain
from typing import NamedTuple

from game.world.building import Building, Severity, VictimSite
from game.world.events import (
    Acted,
    Action,
    Expired,
    MissionEnded,
    MissionEvent,
    Outcome,
    Rescued,
    TreatmentBroken,
    TreatmentStarted,
)
from game.world.geometry import Heading, reach
from game.world.observation import (
    Guidance,
    Observation,
    SeenRoom,
    SeenVictim,
    Treatment,
    VictimState,
)
from game.world.settings import MissionSettings

COMPASS_ACTIONS = {
    Action.NORTH: Heading.NORTH,
    Action.EAST: Heading.EAST,
    Action.SOUTH: Heading.SOUTH,
    Action.WEST: Heading.WEST,
}
TURN_ACTIONS = frozenset({Action.FORWARD, Action.TURN_LEFT, Action.TURN_RIGHT})


class Order(IntEnum):
    """What fires first at a tie. EVALUATION is the coach's; the session puts it in its place."""

    TREATMENT_END = 0
    EXPIRY = 1
    EVALUATION = 2
    MISSION_END = 3


class Due(NamedTuple):
    at_ms: int
    order: Order


class _Seen(NamedTuple):
    """What an observation holds of the building, until the rescuer or a victim changes."""

    visible: int
    victims: tuple[SeenVictim, ...]
    remembered: tuple[SeenVictim, ...]
    rooms: tuple[SeenRoom, ...]


class Mission:
    """The state of one mission, from 0 ms to `settings.duration_ms`."""

    def __init__(self, building: Building, settings: MissionSettings) -> None:
        self.building = building
        self.settings = settings
        self.time_ms = 0
        self.position = building.start
        self.heading = building.start_heading
        self.ended = False
        self.rescued = self.lost = 0
        self._last_due = Due(settings.duration_ms, Order.MISSION_END)
        self._expiry_due = Due(settings.reds_expire_ms, Order.EXPIRY)
        self.victims = {site.id: VictimState.WAITING for site in building.victims}
        self._site_at = {site.cell: site for site in building.victims}
        self._sight = building.terrain.sight(settings.sight_radius)
        self._treated: VictimSite | None = None
        self._treatment_start_ms = 0
        self._explored = 0
        self._last_seen: dict[str, VictimState] = {}
        bit = building.plan.bit
        self._site_bits = tuple((site, bit(site.cell)) for site in building.victims)
        self._name_bits = tuple(
            (SeenRoom(room.name, room.label), bit(room.label)) for room in building.rooms
        )
        self._seen = _Seen(0, (), (), ())
        marked = (site.cell for site in building.victims), (it.label for it in building.rooms)
        self._marks = building.plan.mask(chain(*marked))
        self._reds_waiting = [s.id for s in building.victims if s.severity is Severity.RED]
        self._look()

    @property
    def score(self) -> int:
        return sum(
            self.settings.points(site.severity)
            for site in self.building.victims
            if self.victims[site.id] is VictimState.RESCUED
        )

    @property
    def next_due(self) -> Due | None:
        """What fires next by itself; None once the mission has ended."""
        if self.ended:
            return None
        due = self._last_due
        if self._reds_waiting:
            due = min(due, self._expiry_due)
        if self._treated is not None:
            due = min(due, Due(self._treatment_end_ms(), Order.TREATMENT_END))
        return due

    def pass_time(self, now_ms: int) -> None:
        """Let the clock run on to `now_ms`, where nothing is due before. Raises ValueError when
        time would run backwards."""
        if now_ms < self.time_ms:
            raise ValueError(f"time cannot run backwards from {self.time_ms} to {now_ms} ms")
        self.time_ms = now_ms

    def fire_next(self) -> list[MissionEvent]:
        """Fire what is next due, at its due time. Raises ValueError once the mission has ended."""
        due = self.next_due
        if due is None:
            raise ValueError("the mission has ended")
        self.pass_time(due.at_ms)
        match due.order:
            case Order.TREATMENT_END:
                return self._finish_treatment(due.at_ms)
            case Order.EXPIRY:
                return self._expire_reds(due.at_ms)
            case _:
                self.ended = True
                return [MissionEnded(due.at_ms, rescued=self.rescued)]

    def step(
        self, action: Action | None, now_ms: int, pressed_ms: int | None = None
    ) -> list[MissionEvent]:
        """Fire everything due by `now_ms`, then carry out `action` if the mission still runs.

        `pressed_ms` is when the key for it came, where that was earlier; it is only recorded.
        Raises ValueError when time runs backwards or the action is not one of the controls in use.
        """
        events: list[MissionEvent] = []
        while (due := self.next_due) is not None and due.at_ms <= now_ms:
            events += self.fire_next()
        if self.ended:
            return events
        self.pass_time(now_ms)
        if action is not None:
            outcome, followed = self._carry_out(action, now_ms)
            pressed = now_ms if pressed_ms is None else pressed_ms
            events.append(Acted(now_ms, pressed, action, outcome, self.position, self.heading))
            events += followed
        return events

    def observation(self, guidance: Guidance | None = None) -> Observation:
        """What the rescuer sees now, with `guidance` on the bar."""
        settings, seen = self.settings, self._seen
        return Observation(
            terrain=self.building.terrain,
            visible=seen.visible,
            explored=self._explored,
            victims=seen.victims,
            remembered=seen.remembered,
            rooms=seen.rooms,
            position=self.position,
            heading=self.heading,
            time_ms=self.time_ms,
            time_left_ms=max(0, settings.duration_ms - self.time_ms),
            treatment=self._treatment(),
            rescued=self.rescued,
            score=self.score if settings.show_score else None,
            ended=self.ended,
            guidance=guidance,
            lost=self.lost,
        )

    def victim_in_reach(self) -> VictimSite | None:
        """The waiting victim that triage would treat: the first in `reach`."""
        for cell in reach(self.position, self.heading):
            site = self._site_at.get(cell)
            if site is not None and self.victims[site.id] is VictimState.WAITING:
                return site
        return None

    def _carry_out(self, action: Action, now_ms: int) -> tuple[Outcome, list[MissionEvent]]:
        if action is Action.TRIAGE:
            return self._triage(now_ms)
        turn_controls = self.settings.controls == "turn"
        if (action in TURN_ACTIONS) is not turn_controls:
            raise ValueError(f"{action} is not one of the {self.settings.controls} controls")
        if action is Action.TURN_LEFT:
            self.heading = self.heading.left
            return Outcome.TURNED, []
        if action is Action.TURN_RIGHT:
            self.heading = self.heading.right
            return Outcome.TURNED, []
        self.heading = COMPASS_ACTIONS.get(action, self.heading)
        return self._move(now_ms)

    def _move(self, now_ms: int) -> tuple[Outcome, list[MissionEvent]]:
        target = self.heading.from_cell(self.position)
        if not self.building.plan.walkable(target):
            return Outcome.BUMPED, []
        self.position = target
        self._look(changed=False)
        if self._treated is None:
            return Outcome.MOVED, []
        broken, self._treated = self._treated.id, None
        return Outcome.MOVED, [TreatmentBroken(now_ms, broken)]

    def _triage(self, now_ms: int) -> tuple[Outcome, list[MissionEvent]]:
        site = self.victim_in_reach()
        if self._treated is not None:
            return Outcome.ALREADY_TREATING, []
        if site is None:
            return Outcome.NOBODY, []
        if self._expires_before(site, now_ms + self.settings.treatment_ms(site.severity)):
            return Outcome.TOO_LATE, []
        self._treated, self._treatment_start_ms = site, now_ms
        return Outcome.TREATING, [TreatmentStarted(now_ms, site.id, self._treatment_end_ms())]

    def _expires_before(self, site: VictimSite, at_ms: int) -> bool:
        return site.severity is Severity.RED and self.settings.reds_expire_ms < at_ms

    def _treatment_end_ms(self) -> int:
        assert self._treated is not None
        return self._treatment_start_ms + self.settings.treatment_ms(self._treated.severity)

    def _finish_treatment(self, at_ms: int) -> list[MissionEvent]:
        assert self._treated is not None
        victim, severity, self._treated = self._treated.id, self._treated.severity, None
        self.victims[victim] = VictimState.RESCUED
        self.rescued += 1
        if severity is Severity.RED:
            self._reds_waiting.remove(victim)
        self._look()
        return [Rescued(at_ms, victim)]

    def _expire_reds(self, at_ms: int) -> list[MissionEvent]:
        expired, self._reds_waiting = self._reds_waiting, []
        self.lost += len(expired)
        for victim in expired:
            self.victims[victim] = VictimState.EXPIRED
        self._look()
        return [Expired(at_ms, victim) for victim in expired]

    def _treatment(self) -> Treatment | None:
        site = self._treated
        if site is None:
            return None
        total = self.settings.treatment_ms(site.severity)
        return Treatment(site.cell, site.severity, self.time_ms - self._treatment_start_ms, total)

    def _look(self, *, changed: bool = True) -> None:
        """See what is in view now, and remember it. `changed` is false where no victim's state has
        changed since the last look."""
        visible = self._sight.field(self.position)
        self._explored |= visible
        marked = visible & self._marks
        if not changed and marked == self._seen.visible & self._marks:
            self._seen = self._seen._replace(visible=visible)
            return
        in_view, remembered = [], []
        for site, bit in self._site_bits:
            if visible & bit:
                state = self._last_seen[site.id] = self.victims[site.id]
                in_view.append(SeenVictim(site.cell, site.severity, state))
            elif site.id in self._last_seen:
                state = self._last_seen[site.id]
                remembered.append(SeenVictim(site.cell, site.severity, state))
        rooms = tuple(room for room, bit in self._name_bits if visible & bit)
        self._seen = _Seen(visible, tuple(in_view), tuple(remembered), rooms)
