"""The same simulated people, coached by one coach after another: what `ana compare` compares.

A trial is one mission of one person in one building with one coach. Whoever plays, what they
remember of the map and every chance they take are the same for all coaches, so that differences can
be taken person by person.
"""

from __future__ import annotations

import signal
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from functools import cache
from typing import Any, Literal, NamedTuple

import msgspec

from game.coach.acts import KnowledgeJudged, PosteriorEvaluated
from game.coach.spec import CoachSpec
from game.journal.history import MissionHistory, Step
from game.journal.records import RunRecord
from game.rescuers.driver import drive
from game.rescuers.person import BoundedPerson, MapMemory, Population, Traits, drawn, memorised
from game.rescuers.person.quiz import labels
from game.rescuers.person.randomness import stream
from game.rescuers.person.responses import DEMAND
from game.rescuers.person.worlds import world, world_at
from game.session.playing import assemble, mission_started
from game.simulation.contenders import Contender, Quiz, contender
from game.simulation.workers import AHEAD, cluster, cores
from game.world import load_building
from game.world.building import Building
from game.world.settings import MissionSettings

People = Literal["choosing", "reporting"]
"""Two sets of people that have nobody in common: numbers are chosen on one, and reported on the
other."""

RULES = MissionSettings(show_score=False, allow_pause=False)
MEMORISE_MS = (60_000, 180_000)
"""As in the study, by turns."""


class Matter(NamedTuple):
    """What a trial is about, apart from the coach."""

    world: str
    building: str
    person: int


class Trial(msgspec.Struct, frozen=True):
    """How one mission went. `known` is the share of rooms whose place the person knew before it;
    `c1` to `c3` are shares of the mission at each level, `lost` is the share spent searching and
    puzzling; `alignment` is 1 minus the time-weighted distance between the knowledge that the words
    asked for and the person's; `comprehension` is the mean of P(g* | path). `goals` and `rooms`
    hold pairs (P known, whether it was known): of each goal's room when its level was chosen, and
    of every room at the last choice; `share` is the share of rooms that the coach then held to have
    been known.
    """

    world: str
    building: str
    person: int
    coach: str
    known: float
    rescues: int
    switches: int
    c1: float
    c2: float
    c3: float
    lost: float
    alignment: float
    missteps: int
    comprehension: float | None = None
    share: float | None = None
    goals: tuple[tuple[float, bool], ...] = ()
    rooms: tuple[tuple[float, bool], ...] = ()


@dataclass(frozen=True)
class Plan:
    """A whole comparison: every coach with `people` persons in each world and building."""

    coaches: tuple[Contender, ...]
    worlds: Mapping[str, Population]
    buildings: tuple[str, ...]
    people: int
    seed: int
    of: People

    def matters(self) -> list[Matter]:
        """Everything that has to be played with each coach."""
        return [
            Matter(world, building, person)
            for world in self.worlds
            for building in self.buildings
            for person in range(self.people)
        ]


def play(plan: Plan, matter: Matter) -> list[Trial]:
    """The trials of one person in one building, with every coach of the plan."""
    building = _building(matter.building)
    who = plan.of, plan.seed, matter.world, matter.person
    traits = drawn(plan.worlds[matter.world], *who)
    memorise_ms = MEMORISE_MS[matter.person % len(MEMORISE_MS)]
    there = (*who, building.name)
    memory = memorised(building, memorise_ms, traits, stream(*there, "map"))
    names = [room.name for room in building.rooms]
    given = labels(memory, traits, building.rooms, names, stream(*there, "quiz"))
    quiz: Quiz = {
        room.name: "blank"
        if room.label not in given
        else "right"
        if given[room.label] == room.name
        else "wrong"
        for room in building.rooms
    }
    return [
        _played(plan, matter, one, building, traits, memory, quiz, there) for one in plan.coaches
    ]


def _played(
    plan: Plan,
    matter: Matter,
    coach: Contender,
    building: Building,
    traits: Traits,
    remembered: MapMemory,
    quiz: Quiz,
    there: tuple[object, ...],
) -> Trial:
    memory = MapMemory(remembered.sites, remembered.names, remembered.hunches)
    known = known_rooms(building, memory)
    spec = coach.spec or CoachSpec("knowledge")
    started = mission_started(building, RULES, spec, matter.person)
    history = MissionHistory(0, Step("mission"), started)
    goals: list[tuple[float, bool]] = []
    last: list[KnowledgeJudged] = []
    heard: list[float] = []

    def note(records: Sequence[RunRecord]) -> None:
        for record in records:
            history.note(0, record)
            if isinstance(record, PosteriorEvaluated) and record.verdict != "none":
                heard.append(record.comprehension)
            if isinstance(record, KnowledgeJudged):
                last[:] = [record]
                if record.room is not None:
                    now = known_rooms(building, memory)
                    goals.append((record.known[record.room], now[record.room]))

    run = assemble(
        building,
        RULES,
        spec,
        matter.person,
        note,
        build=lambda _, briefing: coach.build(briefing, known, quiz),
    )
    person = BoundedPerson(traits, memory, RULES.controls, stream(*there, "mission"))
    run.begin()
    drive(run, person)
    whole_ms = max(1, history.until_ms)
    spans = list(history.levels())
    shares = {
        level: sum(span.until_ms - span.from_ms for span in spans if span.level == level) / whole_ms
        for level in DEMAND
    }
    share = sum(known.values()) / len(known)
    lived = person.experience
    return Trial(
        *matter,
        coach=coach.name,
        known=share,
        rescues=run.mission.rescued,
        switches=max(0, len(spans) - 1),
        c1=shares[1],
        c2=shares[2],
        c3=shares[3],
        lost=(lived.searching_ms + lived.puzzled_ms) / whole_ms,
        alignment=1 - sum(shares[level] * abs(need - share) for level, need in DEMAND.items()),
        missteps=history.missteps,
        comprehension=sum(heard) / len(heard) if heard else None,
        share=last[0].share if last else None,
        goals=tuple(goals),
        rooms=tuple((chance, known[room]) for room, chance in last[0].known.items())
        if last
        else (),
    )


def known_rooms(building: Building, memory: MapMemory) -> dict[str, bool]:
    """For each room, whether the person knows its place."""
    return {room.name: memory.names.get(room.label) == room.name for room in building.rooms}


def trials(
    plan: Plan, jobs: int, tick: Callable[[int, int], None], scheduler: str | None = None
) -> list[Trial]:
    """All trials, in an order that does not depend on where they are played: by `jobs` processes,
    or on the cluster of a dask `scheduler`. `tick` is told how much is done."""
    work = plan.matters()
    for name in plan.buildings:
        _building(name)
    found: list[Trial] = []
    for done, some in enumerate(_everything(plan, work, jobs, scheduler), 1):
        found += some
        tick(done, len(work))
    return found


def asked_trials(
    tick: Callable[[int, int], None],
    *,
    coaches: Sequence[str],
    worlds: Sequence[str],
    cube: Sequence[Sequence[float]],
    buildings: Sequence[str],
    people: int,
    seed: int,
    of: People,
    jobs: int | None,
    scheduler: str | None = None,
) -> Iterator[dict[str, Any]]:
    """The trials that somebody asks for by names, as plain rows. `cube` holds points of the unit
    cube, each a world `drawn N`. Raises AnaError for a name that there is not."""
    drawn_worlds = {f"drawn {n}": world_at(point, f"drawn {n}") for n, point in enumerate(cube, 1)}
    plan = Plan(
        tuple(contender(name) for name in dict.fromkeys(coaches)),
        {name: world(name) for name in dict.fromkeys(worlds)} | drawn_worlds,
        tuple(dict.fromkeys(buildings)),
        people,
        seed,
        of,
    )
    return (msgspec.to_builtins(trial) for trial in trials(plan, jobs or cores(), tick, scheduler))


def _everything(
    plan: Plan, work: Sequence[Matter], jobs: int, scheduler: str | None
) -> Iterator[list[Trial]]:
    if scheduler is not None:
        with cluster(scheduler) as client:
            shared = client.scatter(plan, broadcast=True)
            for future in [client.submit(play, shared, one, pure=False) for one in work]:
                yield future.result()
        return
    if jobs == 1:
        yield from (play(plan, matter) for matter in work)
        return
    with ProcessPoolExecutor(jobs, initializer=_get_ready, initargs=(plan,)) as pool:
        try:
            yield from pool.map(_play, work, chunksize=AHEAD)
        except BaseException:
            pool.shutdown(wait=False, cancel_futures=True)
            raise


_plan: Plan | None = None


def _get_ready(plan: Plan) -> None:
    """Set what all trials of a process share. The parent process handles interrupts."""
    global _plan  # noqa: PLW0603 - a pool hands its workers their common data in no other way
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    _plan = plan


def _play(matter: Matter) -> list[Trial]:
    assert _plan is not None
    return play(_plan, matter)


@cache
def _building(name: str) -> Building:
    return load_building(name)
