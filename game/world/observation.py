"""What a rescuer may see now, and nothing else. Screens draw it; simulated people receive it."""

from __future__ import annotations

from dataclasses import dataclass, field
from enum import StrEnum
from typing import NamedTuple

from game.world.building import Severity
from game.world.geometry import Cell, Heading
from game.world.plan import Plan
from game.world.terrain import Terrain


class VictimState(StrEnum):
    WAITING = "waiting"
    RESCUED = "rescued"
    EXPIRED = "expired"


@dataclass(frozen=True, slots=True)
class SeenVictim:
    """A victim in view. Carries no identity: two victims of one kind look alike."""

    cell: Cell
    severity: Severity
    state: VictimState


@dataclass(frozen=True, slots=True)
class SeenRoom:
    """A room whose label cell is in view."""

    name: str
    label: Cell


@dataclass(frozen=True, slots=True)
class Treatment:
    """A treatment under way."""

    cell: Cell
    severity: Severity
    done_ms: int
    total_ms: int


@dataclass(frozen=True, slots=True)
class Guidance:
    """What stands on the yellow bar. `notice` is a short correction shown before `text`.
    `completed` counts the instructions carried out before it, and tells a new one from the last in
    the same words."""

    text: str
    notice: str = ""
    completed: int = field(default=0, compare=False)

    def repeats(self, before: Guidance) -> bool:
        """Whether it is a new instruction in the words of the one `before`, which was carried
        out."""
        return self.completed > before.completed and self.text == before.text


class Observation(NamedTuple):
    """The rescuer's observation o_t = FOV(s_t) with the instruction on screen (paper 5.1.3).

    `terrain` is what the mini-map shows (walls and doors, no names, no victims) with all that
    follows from it. `visible` and `explored` are masks over it (see `game.world.plan`);
    `explored` includes `visible`.
    `remembered` are victims that were in view before and are not now, as they were last seen.
    `score` is None where the mission hides it. `lost` counts the red victims whose time ran out,
    wherever they lay.
    """

    terrain: Terrain
    visible: int
    explored: int
    victims: tuple[SeenVictim, ...]
    remembered: tuple[SeenVictim, ...]
    rooms: tuple[SeenRoom, ...]
    position: Cell
    heading: Heading
    time_ms: int
    time_left_ms: int
    treatment: Treatment | None
    rescued: int
    score: int | None
    ended: bool
    guidance: Guidance | None
    lost: int = 0

    @property
    def plan(self) -> Plan:
        """The mini-map."""
        return self.terrain.plan
