"""What the mission looks like when an instruction is made, and what an instruction is."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import NamedTuple

from game.coach.acts import Level
from game.coach.instructions.phrasebook import Phrasebook
from game.coach.instructions.phrasebook_file import english
from game.coach.instructions.vocabulary import Tuples
from game.world.building import Building, Room, VictimSite
from game.world.floodfill import UNREACHABLE, Floodfill, Floodfills
from game.world.geometry import Cell, Heading, reach
from game.world.settings import MissionSettings


class Pose(NamedTuple):
    """Where somebody stands, and which way they face."""

    cell: Cell
    heading: Heading


@dataclass(frozen=True)
class Scene:
    """The mission as the coach sees it now, with the `phrases` to speak of it; `waiting` holds the
    waiting victims by id."""

    building: Building
    waiting: Mapping[str, VictimSite]
    settings: MissionSettings
    phrases: Phrasebook = field(default_factory=english)

    @property
    def floodfills(self) -> Floodfills:
        return self.building.terrain.floodfills

    @cached_property
    def _waiting_at(self) -> dict[Cell, VictimSite]:
        return {site.cell: site for site in self.waiting.values()}

    def victim(self, goal: str) -> VictimSite:
        """The waiting victim `goal`. Raises ValueError when no such victim waits."""
        site = self.waiting.get(goal)
        if site is None:
            raise ValueError(f"no victim {goal} is waiting, so it cannot be a goal")
        return site

    def room(self, goal: str) -> Room | None:
        return self.building.room_of(self.victim(goal))

    def descent(self, pose: Pose, goal: str) -> Floodfill:
        """The goal's floodfill. Raises ValueError when no way leads there from `pose`."""
        site = self.victim(goal)
        if self.floodfills.distance(pose.cell, site.cell) == UNREACHABLE:
            raise ValueError(f"no way leads from {pose.cell} to victim {goal} at {site.cell}")
        return self.floodfills.to(site.cell)

    def treated_at(self, pose: Pose) -> VictimSite | None:
        """The waiting victim that triage would treat: the first in `reach`."""
        sites = map(self._waiting_at.get, reach(*pose))
        return next((site for site in sites if site is not None), None)


@dataclass(frozen=True)
class Instruction:
    """What the coach says to lead the rescuer towards one victim.

    `level` is the level asked for and `shown_level` that of the words: lower where `fallback` is
    true. `tuples` are (action, object) pairs of the shown level; `sentences` say one each, and
    `text` is all of them. Carrying them out from `start` leads over `path` (from the start's cell
    to the end's) to `end`, and where `treats` is true begins a treatment there: of the goal at C1
    and C2; at C3, whose words tell victims apart only by room and colour, of any victim in
    `accepts`.
    """

    level: Level
    shown_level: Level
    goal: str
    tuples: Tuples
    sentences: tuple[str, ...]
    text: str
    start: Pose
    end: Pose
    path: tuple[Cell, ...]
    treats: bool
    accepts: frozenset[str]

    @property
    def fallback(self) -> bool:
        """Whether no instruction of the level asked for exists here."""
        return self.shown_level < self.level
