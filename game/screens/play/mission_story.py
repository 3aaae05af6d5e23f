"""The story of a mission, taken from its journal."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import NamedTuple

from game.coach.acts import InstructionIssued
from game.coach.spec import CoachSpec
from game.journal.history import MissionHistory
from game.screens.widgets.charts import ChartStep
from game.session.replay import Replay
from game.world.building import Building, Severity, VictimSite
from game.world.events import Acted, Outcome
from game.world.geometry import Cell
from game.world.observation import VictimState
from game.world.settings import MissionSettings

LEFT_AT_ONCE_MS = 60_000
"""A mission left before this shows no more victims than were seen in it, so that it can be played
as if for the first time."""


class Fate(NamedTuple):
    """What became of a victim, and when; `at_ms` is None if they are still waiting."""

    victim: VictimSite
    state: VictimState
    at_ms: int | None


class Said(NamedTuple):
    """What came to stand on the bar, when, and the level of its words (1 to 3)."""

    at_ms: int
    level: int
    text: str
    notice: str


@dataclass(frozen=True)
class MissionStory:
    """A mission as a whole. `path` holds the cells walked, the start first, and `walked_ms` when
    each was reached; `levels` are 1 to 3.

    `fates` are those of all victims, and `revealed` names those that may be shown afterwards.
    `actions` counts what the rescuer did, including blocked moves and turns; `instructions` counts
    how often the words on the bar changed; `left` is true if the player left before the end.
    """

    building: Building
    spec: CoachSpec
    seed: int
    settings: MissionSettings
    until_ms: int
    left: bool
    actions: int
    path: tuple[Cell, ...]
    walked_ms: tuple[int, ...]
    said: tuple[Said, ...]
    fates: dict[str, Fate]
    revealed: frozenset[str]
    rescues: tuple[ChartStep, ...]
    levels: tuple[ChartStep, ...]
    instructions: int
    missteps: int
    disobeyed: int
    unusual: str
    """What sets this mission apart from the building as drawn and the usual rules."""

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
    """A coach in a few words, with its level if that is fixed."""
    return spec.kind + (f" C{int(spec.level)}" if spec.level is not None else "")


def _moved_ms(past: MissionHistory) -> Iterator[int]:
    for record in past.records:
        if isinstance(record, Acted) and record.outcome is Outcome.MOVED:
            yield record.at_ms


def _said(past: MissionHistory) -> Iterator[Said]:
    """Every text of the bar that differs from the one before, and every notice."""
    before = ""
    for record in past.records:
        if isinstance(record, InstructionIssued) and (record.text != before or record.notice):
            before = record.text
            yield Said(record.at_ms, int(record.shown_level), record.text, record.notice)


def tell(replay: Replay) -> MissionStory:
    """The story of a recorded mission, up to where the replay stands."""
    building, past = replay.building, replay.so_far()
    fates = {site.id: Fate(site, VictimState.WAITING, None) for site in building.victims}
    for victim, (fate, at_ms) in past.fates.items():
        fates[victim] = Fate(fates[victim].victim, VictimState(fate), at_ms)
    left = replay.recorded.end == "abandoned"
    rescued = [at_ms for fate, at_ms in past.fates.values() if fate == "rescued"]
    return MissionStory(
        building=building,
        spec=replay.started.coach,
        seed=replay.started.seed,
        settings=replay.started.settings,
        until_ms=replay.time_ms,
        left=left,
        actions=past.actions,
        path=(building.start, *past.path),
        walked_ms=(0, *_moved_ms(past)),
        said=tuple(_said(past)),
        fates=fates,
        revealed=_seen(replay) if left and replay.time_ms < LEFT_AT_ONCE_MS else frozenset(fates),
        rescues=(ChartStep(0, 0), *(ChartStep(at, n) for n, at in enumerate(rescued, start=1))),
        levels=tuple(ChartStep(at_ms, int(level)) for at_ms, level, _ in past.level_changes),
        instructions=past.texts,
        missteps=past.missteps,
        disobeyed=len(past.disobeyed),
        unusual=replay.started.variant.of_seed(replay.started.seed),
    )


def _seen(replay: Replay) -> frozenset[str]:
    """The victims that have been in view."""
    observation = replay.observation()
    cells = {victim.cell for victim in (*observation.victims, *observation.remembered)}
    return frozenset(site.id for site in replay.building.victims if site.cell in cells)
