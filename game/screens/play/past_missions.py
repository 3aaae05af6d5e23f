"""What was played before, read from the journals themselves, and how a mission compares with it."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, fields
from datetime import datetime
from functools import lru_cache
from pathlib import Path

from game.errors import AnaError
from game.journal.folders import MOST_MISSIONS
from game.journal.history import MissionHistory, building_of, read_history
from game.journal.reader import read_journal
from game.screens.play.mission_story import coach_name
from game.world.building import Building, Severity
from game.world.settings import FREE_PLAY, MissionSettings
from game.world.variant import Difficulty, with_demands

MissionKind = tuple[str, str, str]
"""What missions are compared by: building, coach and difficulty."""
CANNOT_BE_READ = "cannot be read"
_OF_NO_WEIGHT = frozenset({"show_score", "allow_pause", "level_key", "controls"})
"""Settings that make a mission neither easier nor harder."""
_WORDS = {
    "duration_ms": "{} s", "red_expiry_ms": "reds {} s", "treat_red_ms": "red {} s",
    "treat_blue_ms": "blue {} s",
}  # fmt: skip


@dataclass(frozen=True)
class PastMission:
    """One mission of free play. `points` is None where they were hidden; `ended` is false where it
    was left early; `rescuer` is empty where a person played; `map_s` is how many seconds the map
    was shown before."""

    journal: Path
    at: datetime
    building: str
    coach: str
    difficulty: str
    people: int
    rescued: int
    points: int | None
    ended: bool
    rescuer: str
    map_s: int

    @property
    def kind(self) -> MissionKind:
        """What it is compared by."""
        return self.building, self.coach, self.difficulty

    @property
    def counts(self) -> bool:
        """Whether it can be a best or a latest result: a person played it to its end."""
        return self.ended and not self.rescuer


def difficulty(rules: MissionSettings, named: Difficulty = "standard") -> str:
    """A difficulty, and the settings that were changed from it and weigh, in words."""
    usual = with_demands(FREE_PLAY, named)
    changed = [
        _WORDS[field.name].format(round(value / 1000))
        if field.name in _WORDS and value is not None
        else f"{field.name.replace('_', ' ')} {value}"
        for field in fields(rules)
        if field.name not in _OF_NO_WEIGHT
        and (value := getattr(rules, field.name)) != getattr(usual, field.name)
    ]
    if changed and named == "standard":
        return ", ".join(changed)
    return ", ".join([named, *changed])


def past_missions(journals: Iterable[Path]) -> tuple[PastMission, ...]:
    """The missions of these journals, in their order, without those that hold none or cannot be
    read."""
    found = (past_mission(path) for path in journals)
    return tuple(mission for mission in found if isinstance(mission, PastMission))


def past_mission(journal: Path) -> PastMission | str:
    """The first mission of a journal; or, in words, why there is none."""
    try:
        stat = journal.stat()
    except OSError:
        return CANNOT_BE_READ
    return _read(journal, stat.st_mtime_ns, stat.st_size)


@lru_cache(maxsize=2 * MOST_MISSIONS)
def _read(journal: Path, _mtime_ns: int, _size: int) -> PastMission | str:
    try:
        transcript = read_journal(journal)
        history = read_history(transcript)
        if not history.missions:
            return "no mission"
        played = history.missions[0]
        if played.step.phase == "practice":
            return "tutorial"
        building = building_of(played.started)
    except AnaError:
        return CANNOT_BE_READ
    opening = transcript.started
    started = played.started
    return PastMission(
        journal=journal,
        at=datetime.fromisoformat(history.started_utc).astimezone(),
        building=started.building,
        coach=coach_name(started.coach),
        difficulty=difficulty(started.settings, started.variant.difficulty),
        people=len(building.victims),
        rescued=sum(fate == "rescued" for fate, _ in played.fates.values()),
        points=_points(played, building) if started.settings.show_score else None,
        ended=played.end == "ended",
        rescuer=opening.rescuer if opening.simulated else "",
        map_s=round(started.memorised_ms / 1000),
    )


def _points(played: MissionHistory, building: Building) -> int:
    severity: dict[str, Severity] = {site.id: site.severity for site in building.victims}
    saved = (victim for victim, (fate, _) in played.fates.items() if fate == "rescued")
    return sum(played.started.settings.points(severity[victim]) for victim in saved)


def of_kind(past: Iterable[PastMission], kind: MissionKind) -> list[PastMission]:
    """The missions that count and are of a kind, in their order."""
    return [mission for mission in past if mission.counts and mission.kind == kind]


def best(missions: Sequence[PastMission]) -> PastMission | None:
    """The one with the most rescues, by points where these are equal; the earliest of several."""
    order = sorted(missions, key=lambda mission: mission.at)
    return max(order, key=lambda mission: (mission.rescued, mission.points or 0), default=None)


def standing(now: PastMission, past: Iterable[PastMission]) -> str:
    """How a mission compares with those before it of its kind, in a sentence."""
    before = [it for it in of_kind(past, now.kind) if it.at < now.at and it.journal != now.journal]
    what = f"with {now.coach}" + ("" if now.difficulty == "standard" else f", {now.difficulty}")
    top = best(before)
    if top is None:
        return f"Your first full mission here {what}." if now.counts else ""
    latest = max(before, key=lambda it: it.at)
    history = f"best {top.rescued} ({top.at:%d %b %Y}), last time {latest.rescued}"
    if now.counts and (now.rescued, now.points or 0) > (top.rescued, top.points or 0):
        return f"Your best here {what}. Before: {history}."
    return f"Here {what}: {history}."
