"""What a rescuer can do, and what then happens in a mission.

Events are tagged structs: the journal writes them as they are, so there is one definition of each.
"""

from __future__ import annotations

from enum import StrEnum
from typing import Literal

import msgspec

from game.world.geometry import Cell, Heading


class Action(StrEnum):
    """The rescuer's actions: the paper's five, and three for the turn controls."""

    NORTH = "north"
    EAST = "east"
    SOUTH = "south"
    WEST = "west"
    FORWARD = "forward"
    TURN_LEFT = "turn_left"
    TURN_RIGHT = "turn_right"
    TRIAGE = "triage"


class Outcome(StrEnum):
    """What became of an action."""

    MOVED = "moved"
    BUMPED = "bumped"
    TURNED = "turned"
    TREATING = "treating"
    """A treatment began."""
    ALREADY_TREATING = "already_treating"
    NOBODY = "nobody"
    """Triage with no waiting victim in reach."""
    TOO_LATE = "too_late"
    """Triage of a red victim that would expire before its treatment could end."""


LevelWish = Literal["simpler", "shorter"]
"""What the level key asks for: words that ask for less knowledge, or that say more in one."""


class Event(msgspec.Struct, frozen=True, tag_field="type"):
    """Something that happened at mission time `at_ms`."""

    at_ms: int


class Acted(Event, frozen=True, tag="acted"):
    """An action was carried out; position and heading are those after it.

    `pressed_ms` is when its key was pressed: earlier than `at_ms` where the pace held it back.
    """

    pressed_ms: int
    action: Action
    outcome: Outcome
    position: Cell
    heading: Heading


class TreatmentStarted(Event, frozen=True, tag="treatment_started"):
    victim: str
    due_ms: int


class TreatmentBroken(Event, frozen=True, tag="treatment_broken"):
    """The rescuer moved before the treatment ended."""

    victim: str


class Rescued(Event, frozen=True, tag="rescued"):
    victim: str


class Expired(Event, frozen=True, tag="expired"):
    victim: str


class LevelAsked(Event, frozen=True, tag="level_asked"):
    """The rescuer asked the coach, by the level key, for simpler or for shorter words."""

    want: LevelWish


class MissionEnded(Event, frozen=True, tag="mission_ended"):
    rescued: int


MissionEvent = (
    Acted | TreatmentStarted | TreatmentBroken | Rescued | Expired | LevelAsked | MissionEnded
)
