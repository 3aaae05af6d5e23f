"""One mission of a journal as rows of the tidy tables."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import lru_cache

from game.coach.acts import (
    Disobeyed,
    InstructionCompleted,
    InstructionIssued,
    Level,
    LevelChanged,
    Misstep,
    NothingLeft,
    PosteriorEvaluated,
)
from game.journal.missions import RecordedMission
from game.journal.records import RunRecord
from game.tables.rows import (
    ActionRow,
    HeadingName,
    InstructionRow,
    InstructorKind,
    LevelName,
    LevelRow,
    PosteriorRow,
    VictimFate,
    VictimRow,
)
from game.world.building import Building
from game.world.events import Acted, Expired, Rescued
from game.world.geometry import Heading
from game.world.reading import parse_building

_LEVELS: dict[Level, LevelName] = {Level.C1: "C1", Level.C2: "C2", Level.C3: "C3"}
_HEADINGS: dict[Heading, HeadingName] = {
    Heading.NORTH: "north",
    Heading.EAST: "east",
    Heading.SOUTH: "south",
    Heading.WEST: "west",
}


def level_name(level: Level) -> LevelName:
    """The level as the tables write it."""
    return _LEVELS[level]


@dataclass(frozen=True)
class MissionTables:
    """The mission of one participant's round, in what the study calls `building`."""

    participant: str
    round: int
    adaptivity: InstructorKind
    building: str
    mission: RecordedMission

    @property
    def until_ms(self) -> int:
        """How long the mission ran, in mission time."""
        return self.mission.until_ms

    @property
    def records(self) -> Iterator[RunRecord]:
        return (happening.record for happening in self.mission.happened)

    def actions(self) -> Iterator[ActionRow]:
        for record in self.records:
            if isinstance(record, Acted):
                yield ActionRow(
                    participant=self.participant,
                    round=self.round,
                    adaptivity=self.adaptivity,
                    at_ms=record.at_ms,
                    pressed_ms=record.pressed_ms,
                    action=record.action,
                    outcome=record.outcome,
                    x=record.position[0],
                    y=record.position[1],
                    heading=_HEADINGS[record.heading],
                )

    def victims(self) -> Iterator[VictimRow]:
        fates: dict[str, tuple[VictimFate, int]] = {}
        for record in self.records:
            if isinstance(record, Rescued):
                fates[record.victim] = "rescued", record.at_ms
            elif isinstance(record, Expired):
                fates[record.victim] = "expired", record.at_ms
        building = _building(self.mission.started.building_text)
        for site in building.victims:
            room = building.room_of(site)
            fate: VictimFate = "waiting"
            fate_ms: int | None = None
            if site.id in fates:
                fate, fate_ms = fates[site.id]
            yield VictimRow(
                participant=self.participant,
                round=self.round,
                adaptivity=self.adaptivity,
                building=self.building,
                victim=site.id,
                severity=site.severity,
                room=None if room is None else room.name,
                fate=fate,
                fate_ms=fate_ms,
            )

    def instructions(self) -> Iterator[InstructionRow]:
        shown: InstructionIssued | None = None
        under: list[RunRecord] = []
        for record in self.records:
            if isinstance(record, InstructionIssued | NothingLeft):
                if shown is not None:
                    yield self._instruction(shown, under, record.at_ms)
                shown = record if isinstance(record, InstructionIssued) else None
                under = []
            else:
                under.append(record)
        if shown is not None:
            yield self._instruction(shown, under, self.until_ms)

    def posteriors(self) -> Iterator[PosteriorRow]:
        level = Level.C2
        for record in self.records:
            if isinstance(record, InstructionIssued):
                level = record.level
            elif isinstance(record, LevelChanged):
                level = record.after
            elif isinstance(record, PosteriorEvaluated):
                yield self._evaluation(record, level)

    def levels(self) -> Iterator[LevelRow]:
        level: Level | None = None
        from_ms, comprehension = 0, None
        for record in self.records:
            if level is None and isinstance(record, InstructionIssued):
                level, from_ms = record.level, record.at_ms
            elif isinstance(record, LevelChanged):
                if level is not None and record.at_ms > from_ms:
                    yield self._stretch(level, from_ms, record.at_ms, comprehension)
                level, from_ms = record.after, record.at_ms
                comprehension = record.comprehension
        if level is not None and self.until_ms > from_ms:
            yield self._stretch(level, from_ms, self.until_ms, comprehension)

    def _instruction(
        self, issued: InstructionIssued, under: list[RunRecord], until_ms: int
    ) -> InstructionRow:
        kinds = [record.kind for record in under if isinstance(record, Disobeyed)]
        completed = [record.at_ms for record in under if isinstance(record, InstructionCompleted)]
        return InstructionRow(
            participant=self.participant,
            round=self.round,
            adaptivity=self.adaptivity,
            number=issued.number,
            at_ms=issued.at_ms,
            until_ms=until_ms,
            goal=issued.goal,
            level=level_name(issued.level),
            shown_level=level_name(issued.shown_level),
            fallback=issued.fallback,
            text=issued.text,
            notice=issued.notice,
            tuples="; ".join(" ".join(pair) for pair in issued.tuples),
            reason=issued.reason,
            x=issued.position[0],
            y=issued.position[1],
            heading=_HEADINGS[issued.heading],
            end_x=issued.end[0],
            end_y=issued.end[1],
            treats=issued.treats,
            completed_ms=completed[0] if completed else None,
            missteps_under=sum(isinstance(record, Misstep) for record in under),
            disobeyed_by=kinds[0] if kinds else None,
        )

    def _evaluation(self, record: PosteriorEvaluated, level: Level) -> PosteriorRow:
        likeliest = max(sorted(record.posterior), key=lambda goal: record.posterior[goal])
        return PosteriorRow(
            participant=self.participant,
            round=self.round,
            adaptivity=self.adaptivity,
            at_ms=record.at_ms,
            goal=record.goal,
            level=level_name(level),
            comprehension=record.comprehension,
            goal_probability=record.posterior.get(record.goal, 0.0),
            likeliest=likeliest,
            likeliest_probability=record.posterior[likeliest],
            goals=len(record.posterior),
            window_moves=record.moves,
            lower_below=record.lower_below,
            raise_above=record.raise_above,
            verdict=record.verdict,
        )

    def _stretch(
        self, level: Level, from_ms: int, until_ms: int, comprehension: float | None
    ) -> LevelRow:
        return LevelRow(
            participant=self.participant,
            round=self.round,
            adaptivity=self.adaptivity,
            level=level_name(level),
            from_ms=from_ms,
            until_ms=until_ms,
            comprehension=comprehension,
        )


@lru_cache(maxsize=16)
def _building(text: str) -> Building:
    return parse_building(text)
