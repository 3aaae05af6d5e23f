"""A small coach for tests, a tiny building, and missions played with them."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Literal

from game.coach.acts import (
    CoachRecord,
    GoalSet,
    InstructionIssued,
    Level,
    LevelChanged,
    PosteriorEvaluated,
)
from game.coach.api import Briefing
from game.coach.spec import CoachSpec
from game.journal.clock import VirtualClock
from game.journal.reader import Transcript, parse_journal
from game.journal.records import SCHEMA_VERSION, SessionStarted, Versions
from game.journal.sink import MemorySink
from game.journal.writer import Journal
from game.session.playing import begin_mission, end_free_play
from game.session.run import MissionRun
from game.world.events import Acted, Action, Expired, MissionEvent, Outcome, Rescued
from game.world.observation import Guidance, Observation
from game.world.reading import parse_building
from game.world.settings import MissionSettings

HUT = parse_building(
    """name: Hütte

plan:
#############
#...A.#.*...#
#.>...+...B.#
#.o...#....o#
#############

legend:
> = start facing east
* = red victim
o = blue victim
A = room Küche
B = room Stube
"""
)

SETTINGS = MissionSettings(duration_ms=20_000, red_expiry_ms=12_500)
SPEC = CoachSpec(kind="static", level=Level.C2)
COMPASS = (Action.NORTH, Action.EAST, Action.SOUTH, Action.WEST, Action.TRIAGE)
TURN = (Action.FORWARD, Action.TURN_LEFT, Action.TURN_RIGHT, Action.TRIAGE)
EVERY_MS = 700


class ToyCoach:
    """Names the first waiting victim; every 0.7 s it takes the share of bumps as confusion."""

    def __init__(self, briefing: Briefing) -> None:
        self._sites = {site.id: site for site in briefing.building.victims}
        self._waiting = sorted(self._sites)
        self._moves = self._bumps = self._number = 0
        self._level = Level.C2
        self.guidance = Guidance("")
        self.next_evaluation_ms: int | None = EVERY_MS

    def begin(self, observation: Observation) -> list[CoachRecord]:
        return self._set_goal("start", observation)

    def on_event(self, event: MissionEvent, observation: Observation) -> list[CoachRecord]:
        match event:
            case Acted():
                self._moves += event.outcome is Outcome.MOVED
                self._bumps += event.outcome is Outcome.BUMPED
                return []
            case Rescued() | Expired():
                self._waiting.remove(event.victim)
                reason: Literal["rescued", "expired"]
                reason = "rescued" if isinstance(event, Rescued) else "expired"
                return self._set_goal(reason, observation)
            case _:
                return []

    def evaluate(self, at_ms: int, observation: Observation) -> list[CoachRecord]:
        self.next_evaluation_ms = at_ms + EVERY_MS
        if not self._waiting:
            self.next_evaluation_ms = None
            return []
        share = (1 + self._moves) / (3 + self._moves + self._bumps)
        goal, moves = self._waiting[0], self._moves
        records: list[CoachRecord] = [
            PosteriorEvaluated(at_ms, goal, {goal: share}, share, moves, 0.3, 0.8, "keep")
        ]
        level = Level.C1 if share < 0.3 else Level.C3 if share > 0.8 else Level.C2
        if level is not self._level:
            records.append(LevelChanged(at_ms, self._level, level, share))
            self._level = level
            records.append(self._instruct("level", observation))
        return records

    def _set_goal(
        self, reason: Literal["start", "rescued", "expired"], observation: Observation
    ) -> list[CoachRecord]:
        if not self._waiting:
            return []
        goal = GoalSet(observation.time_ms, self._waiting[0], None, tuple(self._waiting), reason)
        return [goal, self._instruct("goal", observation)]

    def _instruct(
        self, reason: Literal["goal", "level"], observation: Observation
    ) -> InstructionIssued:
        self._number += 1
        goal = self._sites[self._waiting[0]]
        text = f"Go to {goal.id}, the {goal.severity} one."
        self.guidance = Guidance(text)
        return InstructionIssued(
            at_ms=observation.time_ms,
            number=self._number,
            goal=goal.id,
            level=self._level,
            shown_level=self._level,
            fallback=False,
            tuples=(("Go", goal.id),),
            text=text,
            notice="",
            position=observation.position,
            heading=observation.heading,
            end=goal.cell,
            treats=True,
            reason=reason,
        )


def toy(spec: CoachSpec, briefing: Briefing) -> ToyCoach:
    assert spec == SPEC
    return ToyCoach(briefing)


def opening(settings: MissionSettings = SETTINGS) -> SessionStarted:
    return SessionStarted(
        session="s-1",
        mode="free_play",
        simulated=True,
        rescuer="keys",
        participant="",
        versions=Versions(game="0.1.0", schema=SCHEMA_VERSION, python="3.11.2"),
        settings=settings,
        seed=7,
        terminal=None,
    )


Keys = Sequence[tuple[int, Action]]
"""Keys, and how many milliseconds after the previous one each is pressed."""

WALK: Keys = (
    *[(300, Action.TRIAGE), (3_300, Action.NORTH), (210, Action.SOUTH)],
    *[(90, Action.EAST), (90, Action.EAST), (50, Action.EAST), (250, Action.EAST)],
    *[(210, Action.EAST)] * 5,
    *[(300, Action.NORTH), (400, Action.WEST), (100, Action.TRIAGE), (900, Action.TRIAGE)],
    *[(1_000, Action.EAST), (400, Action.SOUTH), (300, Action.EAST), (210, Action.EAST)],
    *[(210, Action.SOUTH), (210, Action.NORTH), (400, Action.TRIAGE)],
)
"""Rescues the blue victim of the first room, walks into the other room, begins to treat the red
victim there, breaks off and treats the blue one: with a bump, and keys faster than the pace."""


def press(run: MissionRun, clock: VirtualClock, keys: Keys) -> None:
    for wait_ms, action in keys:
        clock.now_ms += wait_ms
        run.press(action, clock.now_ms)


def played(
    keys: Keys = WALK, settings: MissionSettings = SETTINGS, *, until_ms: int | None = None
) -> bytes:
    """The journal of a mission played with these keys and left at `until_ms` (None: at its end)."""
    clock = VirtualClock()
    sink = MemorySink()
    journal = Journal(sink, clock)
    journal.append(opening(settings))
    run = begin_mission(journal, HUT, settings, SPEC, 7, build=toy)
    press(run, clock, keys)
    clock.now_ms = max(clock.now_ms, settings.duration_ms if until_ms is None else until_ms)
    end_free_play(run, journal, clock.now_ms)
    return bytes(sink.data)


def transcript(data: bytes) -> Transcript:
    return parse_journal(data, "journal.jsonl")


def write(folder: Path, data: bytes) -> Path:
    path = folder / "journal.jsonl"
    path.write_bytes(data)
    return path
