"""What happened in a mission, told from its journal once it is over."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

from game.coach.acts import Disobeyed, InstructionIssued, LevelChanged, Misstep
from game.coach.spec import CoachSpec
from game.screens.widgets.charts import Step
from game.session.replay import Replay
from game.world.building import Building, Severity, VictimSite
from game.world.events import Acted, Expired, Outcome, Rescued
from game.world.geometry import Cell
from game.world.observation import VictimState
from game.world.settings import MissionSettings


class Fate(NamedTuple):
    """What became of a victim, and when; None for one who still waits."""

    victim: VictimSite
    state: VictimState
    at_ms: int | None


@dataclass(frozen=True)
class Story:
    """A mission as a whole. `path` are the cells walked, the start first; `levels` are 1 to 3.

    `actions` counts what the rescuer did, blocked moves and turns included; `instructions` how
    often the words on the bar changed; `left` is true where the player went before the end.
    """

    building: Building
    settings: MissionSettings
    until_ms: int
    left: bool
    actions: int
    path: tuple[Cell, ...]
    fates: dict[str, Fate]
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
            if self.fates[victim.id].state is VictimState.RESCUED
        )

    def count(self, severity: Severity, state: VictimState) -> int:
        return sum(
            fate.victim.severity is severity and fate.state is state for fate in self.fates.values()
        )


def coach_name(spec: CoachSpec) -> str:
    """A coach in a few words, with its level where it keeps one."""
    return spec.kind + (f" C{int(spec.level)}" if spec.level is not None else "")


def tell(replay: Replay) -> Story:
    """The story of a recorded mission, up to where the replay stands."""
    building = replay.building
    fates = {victim.id: Fate(victim, VictimState.WAITING, None) for victim in building.victims}
    path, rescues, levels = [building.start], [Step(0, 0)], list[Step]()
    kinds = {Acted: 0, Misstep: 0, Disobeyed: 0}
    told = list[str]()
    for record in replay.records:
        if type(record) in kinds:
            kinds[type(record)] += 1
        if isinstance(record, InstructionIssued) and record.text not in told[-1:]:
            told.append(record.text)
        match record:
            case Acted(outcome=Outcome.MOVED):
                path.append(record.position)
            case Rescued():
                fates[record.victim] = Fate(
                    fates[record.victim].victim, VictimState.RESCUED, record.at_ms
                )
                rescues.append(Step(record.at_ms, rescues[-1].value + 1))
            case Expired():
                fates[record.victim] = Fate(
                    fates[record.victim].victim, VictimState.EXPIRED, record.at_ms
                )
            case LevelChanged():
                levels.append(Step(record.at_ms, int(record.after)))
            case InstructionIssued() if not levels:
                levels.append(Step(record.at_ms, int(record.level)))
    return Story(
        building=building,
        settings=replay.started.settings,
        until_ms=replay.time_ms,
        left=replay.recorded.end == "abandoned",
        actions=kinds[Acted],
        path=tuple(path),
        fates=fates,
        rescues=tuple(rescues),
        levels=tuple(levels),
        instructions=len(told),
        missteps=kinds[Misstep],
        disobeyed=kinds[Disobeyed],
    )
