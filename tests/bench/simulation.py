"""How fast whole sessions are simulated on one core, journals written."""

from __future__ import annotations

import json
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path

from game.coach.spec import parse_coach
from game.rescuers.catalogue import character
from game.rescuers.driver import drive
from game.rescuers.person import POPULATIONS
from game.session.playing import start_in_memory
from game.simulation.simulated_study import simulate
from game.simulation.workers import here
from game.world import load_building
from game.world.settings import MissionSettings

SESSIONS, MISSIONS = 6, 16
RULES = MissionSettings(show_score=False, allow_pause=False)


@dataclass(frozen=True)
class Rates:
    """On one core, of processor time. A session is two missions of four minutes, six short ones of
    practice and all questions; `sped` is simulated mission time over processor time."""

    sessions_per_s: float
    missions_per_s: float
    sped: float


def simulation_rates() -> Rates:
    """Of a few sessions in a warm process."""
    with tempfile.TemporaryDirectory() as folder:
        _simulate(Path(folder) / "warm", 1)
        study = Path(folder) / "study"
        start = time.process_time()
        _simulate(study, SESSIONS)
        spent_s = time.process_time() - start
        missions, mission_ms = 0, 0
        for path in study.rglob("journal.jsonl"):
            for line in path.read_text().splitlines():
                record = json.loads(line)
                if record["type"] == "mission_started":
                    missions += 1
                elif record["type"] in ("mission_ended", "mission_abandoned"):
                    mission_ms += record["at_ms"]
    return Rates(SESSIONS / spent_s, missions / spent_s, mission_ms / 1000 / spent_s)


def missions_a_second(coach: str) -> float:
    """Four-minute missions of simulated people with a coach, journals written, by one core."""
    buildings = [load_building(name) for name in ("harbour", "foundry")]

    def play(seed: int) -> None:
        for building in buildings:
            rescuer = character("newcomer" if seed % 2 else "person").make(building, RULES, seed)
            run, journal = start_in_memory(
                building, RULES, parse_coach(coach), seed, rescuer="person"
            )
            drive(run, rescuer)
            journal.close()

    play(0)
    start = time.process_time()
    for seed in range(MISSIONS // len(buildings)):
        play(seed)
    return MISSIONS / (time.process_time() - start)


def _simulate(folder: Path, people: int) -> None:
    for _ in simulate(folder, people, 1, POPULATIONS["default"], here):
        pass
