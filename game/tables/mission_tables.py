"""One mission of a journal as rows of the tidy tables."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, TypeVar

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
from game.journal.history import MissionHistory
from game.journal.records import RunRecord
from game.tables.rows import (
    ActionRow,
    AskedRow,
    HeadingName,
    InstructionRow,
    InstructorKind,
    LevelName,
    LevelRow,
    PosteriorRow,
    VictimRow,
)
from game.world.building import Building
from game.world.events import Acted, LevelAsked
from game.world.geometry import Heading

_Kind = TypeVar("_Kind", PosteriorEvaluated, LevelAsked)
_LEVELS: dict[Level, LevelName] = {Level.C1: "C1", Level.C2: "C2", Level.C3: "C3"}
_HEADINGS: dict[Heading, HeadingName] = {
    Heading.NORTH: "north",
    Heading.EAST: "east",
    Heading.SOUTH: "south",
    Heading.WEST: "west",
}


def level_name(level: Level) -> LevelName:
    """The name of a level in the tables."""
    return _LEVELS[level]


@dataclass(frozen=True)
class MissionTables:
    """The mission of one participant's round; it took place in `plan`, which the study's settings
    call `building`."""

    participant: str
    round: int
    adaptivity: InstructorKind
    building: str
    plan: Building
    mission: MissionHistory

    @property
    def shared(self) -> dict[str, Any]:
        """The columns that the tables of a mission share."""
        return {
            "participant": self.participant,
            "round": self.round,
            "adaptivity": self.adaptivity,
            "building": self.building,
        }

    def actions(self) -> Iterator[ActionRow]:
        for record in self.mission.records:
            if isinstance(record, Acted):
                yield ActionRow.of(record, **self.shared, **_pose(record.position, record.heading))

    def victims(self) -> Iterator[VictimRow]:
        for site in self.plan.victims:
            room = self.plan.room_of(site)
            fate, fate_ms = self.mission.fates.get(site.id, ("waiting", None))
            yield VictimRow.of(
                **self.shared,
                victim=site.id,
                severity=site.severity,
                room=None if room is None else room.name,
                fate=fate,
                fate_ms=fate_ms,
            )

    def instructions(self) -> Iterator[InstructionRow]:
        shown: InstructionIssued | None = None
        under: list[RunRecord] = []
        for record in self.mission.records:
            if isinstance(record, InstructionIssued | NothingLeft):
                if shown is not None:
                    yield self._instruction(shown, under, record.at_ms)
                shown = record if isinstance(record, InstructionIssued) else None
                under = []
            else:
                under.append(record)
        if shown is not None:
            yield self._instruction(shown, under, self.mission.until_ms)

    def asked(self) -> Iterator[AskedRow]:
        for level, record in self._with_level(LevelAsked):
            yield AskedRow.of(record, **self.shared, level=level_name(level))

    def posteriors(self) -> Iterator[PosteriorRow]:
        for level, record in self._with_level(PosteriorEvaluated):
            yield self._evaluation(record, level)

    def levels(self) -> Iterator[LevelRow]:
        for span in self.mission.levels():
            yield LevelRow.of(**self.shared | span._asdict() | {"level": level_name(span.level)})

    def _with_level(self, kind: type[_Kind]) -> Iterator[tuple[Level, _Kind]]:
        """Each record of a kind, with the level that was in force before it."""
        level = Level.C2
        for record in self.mission.records:
            if isinstance(record, InstructionIssued):
                level = record.level
            elif isinstance(record, LevelChanged):
                level = record.after
            elif isinstance(record, kind):
                yield level, record

    def _instruction(
        self, issued: InstructionIssued, under: list[RunRecord], until_ms: int
    ) -> InstructionRow:
        kinds = [record.kind for record in under if isinstance(record, Disobeyed)]
        completed = [record.at_ms for record in under if isinstance(record, InstructionCompleted)]
        return InstructionRow.of(
            issued,
            **self.shared,
            **_pose(issued.position, issued.heading),
            until_ms=until_ms,
            level=level_name(issued.level),
            shown_level=level_name(issued.shown_level),
            tuples="; ".join(" ".join(pair) for pair in issued.tuples),
            end_x=issued.end[0],
            end_y=issued.end[1],
            completed_ms=completed[0] if completed else None,
            missteps_under=sum(isinstance(record, Misstep) for record in under),
            disobeyed_by=kinds[0] if kinds else None,
        )

    def _evaluation(self, record: PosteriorEvaluated, level: Level) -> PosteriorRow:
        likeliest = max(sorted(record.posterior), key=lambda goal: record.posterior[goal])
        return PosteriorRow.of(
            record,
            **self.shared,
            level=level_name(level),
            goal_probability=record.posterior.get(record.goal, 0.0),
            likeliest=likeliest,
            likeliest_probability=record.posterior[likeliest],
            goals=len(record.posterior),
            window_moves=record.moves,
        )


def _pose(position: tuple[int, int], heading: Heading) -> dict[str, Any]:
    return {"x": position[0], "y": position[1], "heading": _HEADINGS[heading]}
