"""Missions played by a script of actions, with every kind of coach."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import TypeVar

from game.coach.acts import (
    Disobeyed,
    GoalSet,
    InstructionCompleted,
    InstructionIssued,
    Level,
    LevelChanged,
    Misstep,
    NothingLeft,
)
from game.coach.api import Briefing
from game.coach.spec import CoachSpec, build_coach
from game.journal.records import RunRecord
from game.session.run import MissionRun
from game.world import load_building
from game.world.building import Building
from game.world.events import Action, Expired, Rescued
from game.world.floodfill import cost_to_go
from game.world.mission import COMPASS_ACTIONS, Mission
from game.world.reading import parse_building
from game.world.settings import MissionSettings

BOX = parse_building("""name: Box

plan:
###############
#A....#..B....#
#.o.o.#.....*.#
###+####+######
#.>...........#
###############

legend:
> = start facing east
* = red victim
o = blue victim
A = room Archive
B = room Bureau
""")
"""Two blue victims share the Archive; a red one lies in the Bureau."""

GALLERY = parse_building("""name: Gallery

plan:
#########################
#>.........B...........o#
####+####################
####.A.##################
#########################

legend:
> = start facing east
o = blue victim
A = room Annex
B = room Gallery
""")

LONG = parse_building(f"""name: Long

plan:
{"#" * 91}
#.o.+{"." * 38}>{"." * 42}+.o.#
#.A.#{"#" * 81}#.B.#
{"#" * 91}

legend:
> = start facing east
o = blue victim
A = room Annex
B = room Booth
""")
"""Two victims far apart, and the start a little nearer to the one on the left."""

PRACTICE = load_building("practice")

STATIC = tuple(CoachSpec("static", level=level) for level in Level)
ADAPTIVE = tuple(
    CoachSpec("ana", preset=p) for p in ("floodfill", "calibrated", "literal", "fig10", "released")
)
PACE = CoachSpec("pace", level=Level.C2)
KNOWLEDGE = (
    CoachSpec("knowledge"),
    CoachSpec("knowledge+quiz", quiz={"Archive": "right", "Bureau": "wrong"}),
    CoachSpec("ana", preset="belief"),
)
EVERY = (*STATIC, *ADAPTIVE, PACE, *KNOWLEDGE)

N, E, S, W, T = Action.NORTH, Action.EAST, Action.SOUTH, Action.WEST, Action.TRIAGE


class Game:
    """A mission played by a script of actions, one a pace."""

    def __init__(
        self,
        spec: CoachSpec,
        building: Building = BOX,
        settings: MissionSettings | None = None,
    ) -> None:
        self.settings = settings or MissionSettings()
        self.records: list[RunRecord] = []
        self.mission = Mission(building, self.settings)
        self.coach = build_coach(spec, Briefing(building, self.settings))
        self.run = MissionRun(self.mission, self.coach, self.records.extend)
        self.now_ms = 0
        self.run.begin()

    def act(self, *actions: Action) -> list[RunRecord]:
        """What these actions bring about."""
        before = len(self.records)
        for action in actions:
            self.run.press(action, self.now_ms)
            self.now_ms += self.settings.pace_ms
            self.run.advance(self.now_ms)
        return self.records[before:]

    def wait(self, ms: int) -> list[RunRecord]:
        before = len(self.records)
        self.now_ms += ms
        self.run.advance(self.now_ms)
        return self.records[before:]


_Kind = TypeVar("_Kind", bound=RunRecord)


def only(kind: type[_Kind], records: Sequence[RunRecord]) -> list[_Kind]:
    return [record for record in records if isinstance(record, kind)]


def settle(game: Game, *moves: Action) -> list[RunRecord]:
    """Walk, treat whoever is there, and wait until it is done."""
    return [*game.act(*moves, T), *game.wait(7_000)]


def away(game: Game) -> Action:
    """The step that leads farthest from the goal."""
    return max(_steps(game))[1]


def nearer(game: Game) -> Action:
    """A step that leads to the goal."""
    return min(_steps(game))[1]


def _steps(game: Game) -> list[tuple[int, Action]]:
    """Moves to go after each possible step."""
    goal = only(GoalSet, game.records)[-1].goal
    plan, position = game.mission.building.plan, game.mission.position
    site = next(site for site in game.mission.building.victims if site.id == goal)
    field = cost_to_go(plan, site.cell)
    ways = [(action, way.from_cell(position)) for action, way in COMPASS_ACTIONS.items()]
    return [(field[plan.index(cell)], action) for action, cell in ways if plan.walkable(cell)]


def check_records(game: Game, spec: CoachSpec) -> None:
    """The laws of a coach's records."""
    goal, number, completed = "", 0, True
    issued = only(InstructionIssued, game.records)
    level = issued[0].level
    assert spec.level in (None, level)
    bar, notice = "", ""
    gone: set[str] = set()
    for before, record in pairwise([None, *game.records]):
        match record:
            case Rescued(victim=victim) | Expired(victim=victim):
                gone.add(victim)
            case GoalSet():
                goal = record.goal
                assert record.route[0] == goal
                assert not gone & set(record.route)
            case InstructionIssued():
                number += 1
                completed = False
                bar, notice = record.text, record.notice
                assert (record.number, record.goal, record.level) == (number, goal, level)
                assert record.fallback == (record.shown_level < record.level)
            case InstructionCompleted():
                assert record.number == number
                assert not completed
                completed = True
            case LevelChanged():
                assert record.before is level is not record.after
                level = record.after
            case Misstep():
                assert record.number == number
                assert not completed
            case Disobeyed(kind="repeat_misstep"):
                assert isinstance(before, Misstep)
                assert before.level is not Level.C3
            case NothingLeft():
                bar, notice = "", record.notice
    assert game.coach.guidance.text == bar
    assert game.coach.guidance.notice in (notice, "")
