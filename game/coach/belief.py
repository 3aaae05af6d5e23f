"""b^HR: what the coach holds the rescuer to believe about the building (paper 5.1.3).

The state has three parts. The pose is always observed. Room names stand on places, the label
cells of the plan's rooms, and before anything is seen every assignment of names to places is
equally likely. Victims lie on distinct floor cells, every arrangement equally likely. Sight is
deterministic, so an observation only rules out: the rooms not yet read stay uniform over the
places not yet read, and the victims not yet seen stay uniform over the floor not yet seen. One
set of rooms, one mask of cells and one set of victims therefore hold the belief exactly.

What a rescuer memorised before the mission is not in it: the coach is never told.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property

from game.coach.acts import BeliefChanged
from game.world.building import Building
from game.world.events import Acted, Action, Expired, MissionEvent, Rescued
from game.world.geometry import Cell, Heading
from game.world.mission import COMPASS_ACTIONS
from game.world.observation import Observation, VictimState
from game.world.plan import Plan


@dataclass(frozen=True)
class StateSpace:
    """S^HR: where rooms and victims may be, and where they are.

    `places` are the label cells by room name, `victims` the cells by victim id, `rooms` the room
    of each victim (None in a hallway), `floor` the mask of the cells on which a victim may lie.
    """

    plan: Plan
    places: Mapping[str, Cell]
    victims: Mapping[str, Cell]
    rooms: Mapping[str, str | None]
    floor: int

    @cached_property
    def victim_on(self) -> dict[Cell, str]:
        """The victim on each cell that has one."""
        return {cell: victim for victim, cell in self.victims.items()}

    @classmethod
    def of(cls, building: Building) -> StateSpace:
        plan = building.plan
        doors = plan.mask(cell for door in building.doors for cell in door.cells)
        rooms = {site.id: building.room_of(site) for site in building.victims}
        return cls(
            plan,
            {room.name: room.label for room in building.rooms},
            {site.id: site.cell for site in building.victims},
            {victim: room.name if room else None for victim, room in rooms.items()},
            plan.walkable_mask & ~doors,
        )


@dataclass(frozen=True)
class Transition:
    """T^HR: how an action changes the pose. Walls stop a step but not the turn to it."""

    plan: Plan

    def pose_after(self, cell: Cell, heading: Heading, action: Action) -> tuple[Cell, Heading]:
        match action:
            case Action.TRIAGE:
                return cell, heading
            case Action.TURN_LEFT:
                return cell, heading.left
            case Action.TURN_RIGHT:
                return cell, heading.right
        towards = COMPASS_ACTIONS.get(action, heading)
        ahead = towards.from_cell(cell)
        return ahead if self.plan.walkable(ahead) else cell, towards


@dataclass(frozen=True)
class Belief:
    """A belief over a `StateSpace`.

    `rooms` are the names whose place is known, `victims` the ids whose cell is known, `resolved`
    those no longer waiting, known or not; `unseen` is the mask of floor never in view.
    """

    space: StateSpace
    position: Cell
    heading: Heading
    unseen: int
    rooms: frozenset[str] = frozenset()
    victims: frozenset[str] = frozenset()
    resolved: frozenset[str] = frozenset()

    @classmethod
    def prior(cls, space: StateSpace, position: Cell, heading: Heading) -> Belief:
        """The belief before anything has been seen."""
        return cls(space, position, heading, space.floor)

    def predict(self, event: MissionEvent, transition: Transition) -> Belief:
        """The belief after `event`, before anything new is seen: the pose moves as T says, and a
        victim that was rescued, or expired as the clock shows, is resolved."""
        match event:
            case Acted(action=action):
                cell, heading = transition.pose_after(self.position, self.heading, action)
                return Belief(
                    self.space, cell, heading, self.unseen, self.rooms, self.victims, self.resolved
                )
            case Rescued(victim=victim) | Expired(victim=victim):
                return replace(self, resolved=self.resolved | {victim})
        return self

    def correct(self, observation: Observation) -> Belief:
        """The belief once `observation` has been made."""
        victim_on = self.space.victim_on
        seen = {victim_on[seen.cell]: seen.state for seen in observation.victims}
        resolved = {v for v, state in seen.items() if state is not VictimState.WAITING}
        return Belief(
            self.space,
            observation.position,
            observation.heading,
            self.unseen & ~observation.visible,
            self.rooms.union(room.name for room in observation.rooms),
            self.victims.union(seen),
            self.resolved | resolved,
        )

    def place_distribution(self, room: str) -> dict[Cell, float]:
        """Where `room` may be, with probabilities."""
        places = self.space.places
        if room in self.rooms:
            return {places[room]: 1.0}
        free = [cell for name, cell in places.items() if name not in self.rooms]
        return dict.fromkeys(free, 1 / len(free))


def belief_change(before: Belief, after: Belief, at_ms: int) -> BeliefChanged | None:
    """What the journal keeps of an update; None where rooms, victims and floor are as before."""
    if (before.unseen, before.rooms, before.victims, before.resolved) == (
        after.unseen,
        after.rooms,
        after.victims,
        after.resolved,
    ):
        return None
    return BeliefChanged(
        at_ms,
        rooms_learned=tuple(sorted(after.rooms - before.rooms)),
        victims_seen=tuple(sorted(after.victims - before.victims)),
        victims_resolved=tuple(sorted(after.resolved - before.resolved)),
        unseen_cells=after.unseen.bit_count(),
    )
