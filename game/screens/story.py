"""What happened in a mission, told from its journal once it is over."""

from __future__ import annotations

from dataclasses import dataclass

from game.coach.records import Disobeyed, InstructionIssued, LevelChanged, Misstep
from game.screens.charts import Step
from game.session.replay import Replay
from game.world.building import Building, Severity
from game.world.events import Acted, Expired, Outcome, Rescued
from game.world.geometry import Cell
from game.world.observation import VictimState
from game.world.settings import MissionSettings


@dataclass(frozen=True)
class Story:
    """A mission as a whole. `path` are the cells walked, the start first; `levels` are 1 to 3."""

    building: Building
    settings: MissionSettings
    until_ms: int
    path: tuple[Cell, ...]
    states: dict[str, VictimState]
    rescues: tuple[Step, ...]
    levels: tuple[Step, ...]
    instructions: int
    missteps: int
    disobeyed: int

    @property
    def rescued(self) -> int:
        return self.rescues[-1].value

    @property
    def score(self) -> int:
        return sum(
            self.settings.points(victim.severity)
            for victim in self.building.victims
            if self.states[victim.id] is VictimState.RESCUED
        )

    def count(self, severity: Severity, state: VictimState) -> int:
        return sum(
            victim.severity is severity and self.states[victim.id] is state
            for victim in self.building.victims
        )


def tell(replay: Replay) -> Story:
    """The story of a recorded mission, up to where the replay stands."""
    building = replay.building
    states = {victim.id: VictimState.WAITING for victim in building.victims}
    path, rescues, levels = [building.start], [Step(0, 0)], list[Step]()
    kinds = {InstructionIssued: 0, Misstep: 0, Disobeyed: 0}
    for record in replay.records:
        if type(record) in kinds:
            kinds[type(record)] += 1
        match record:
            case Acted(outcome=Outcome.MOVED):
                path.append(record.position)
            case Rescued():
                states[record.victim] = VictimState.RESCUED
                rescues.append(Step(record.at_ms, rescues[-1].value + 1))
            case Expired():
                states[record.victim] = VictimState.EXPIRED
            case LevelChanged():
                levels.append(Step(record.at_ms, int(record.after)))
            case InstructionIssued() if not levels:
                levels.append(Step(record.at_ms, int(record.level)))
    return Story(
        building=building,
        settings=replay.started.settings,
        until_ms=replay.time_ms,
        path=tuple(path),
        states=states,
        rescues=tuple(rescues),
        levels=tuple(levels),
        instructions=kinds[InstructionIssued],
        missteps=kinds[Misstep],
        disobeyed=kinds[Disobeyed],
    )
