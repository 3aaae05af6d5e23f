"""What `knowledge` holds a rescuer to know, and from what it learns it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise, product
from math import exp, log
from random import Random

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from game.coach.acts import InstructionIssued, KnowledgeJudged, Level, LevelChanged
from game.coach.api import Briefing
from game.coach.guide import Guide
from game.coach.instructions import Pose, Scene, instruct
from game.coach.kinds.knowledge import KnowledgeCoach
from game.coach.kinds.static import NoInfluence
from game.coach.knowledge.assumed import ASSUMED
from game.coach.knowledge.learner import KnowledgeLearner
from game.coach.knowledge.rooms import RoomKnowledge, RoomWalk, StepChances, WalkPace
from game.coach.knowledge.times import Estimate, Habits, LegTimes
from game.coach.model import HumanModel, Reward
from game.coach.spec import CoachSpec, parse_coach
from game.rescuers.catalogue import character
from game.rescuers.driver import drive
from game.session.playing import assemble
from game.session.run import MissionRun
from game.world import load_building
from game.world.events import Action
from game.world.geometry import Cell
from game.world.mission import COMPASS_ACTIONS, Mission
from game.world.reading import parse_building
from game.world.settings import MissionSettings
from tests.coach.scripted import BOX, GALLERY, PRACTICE, E, Game, N, S, W

THREE = parse_building("""name: Three

plan:
###################
#.A.#.>.......#.C.#
#...+....##...+.o.#
#####....##...#####
#...+.........#####
#.B.###############
###################

legend:
> = start facing east
o = blue victim
A = room Archive
B = room Bureau
C = room Cellar
""")
PLACES = {room.name: room.label for room in THREE.rooms}
CHANCES = StepChances(THREE.terrain.floodfills, PLACES, ASSUMED.rationality)
KNOWLEDGE = CoachSpec("knowledge")


def path_of(moves: Sequence[int]) -> list[Cell]:
    """A walk from the start; a move into a wall is left out."""
    path = [THREE.start]
    for move in moves:
        ahead = list(COMPASS_ACTIONS.values())[move].from_cell(path[-1])
        if THREE.plan.walkable(ahead):
            path.append(ahead)
    return path


def guesses(cell: Cell) -> dict[str, float]:
    weights = {name: exp(-CHANCES.distance(name, cell) / ASSUMED.reach_cells) for name in PLACES}
    return {name: weight / sum(weights.values()) for name, weight in weights.items()}


@settings(max_examples=40)
@given(st.lists(st.integers(0, 3), max_size=6))
def test_the_filter_is_the_sum_over_all_that_a_searcher_may_have_had_in_mind(
    moves: list[int],
) -> None:
    path = path_of(moves)
    steps = list(pairwise(path))
    unknown = 0.0
    for minds in product(PLACES, repeat=len(steps) + 1):
        chance = guesses(path[0])[minds[0]]
        for (start, end), before, mind in zip(steps, minds, minds[1:], strict=False):
            change = ASSUMED.retarget
            moved_on = (1 - change) * (before == mind) + change * guesses(start)[mind]
            chance *= moved_on * CHANCES.likelihood(mind, start, end)
        unknown += chance
    begins, ends = ASSUMED.astray
    known = 0.0
    for astray in product((False, True), repeat=len(steps)):
        chance, was = 1.0, False
        for (start, end), now in zip(steps, astray, strict=True):
            goes_astray = 1 - ends if was else begins
            chance *= goes_astray if now else 1 - goes_astray
            chance *= 0.5 if now else CHANCES.likelihood("Cellar", start, end)
            was = now
        known += chance
    walk = RoomWalk(ASSUMED, CHANCES, "Cellar", path[0], frozenset())
    for cell in path[1:]:
        walk.moved(cell, frozenset())
    assert walk.evidence == pytest.approx(log(known / unknown), abs=1e-9)


def test_who_sees_that_a_place_is_another_room_thinks_of_a_third() -> None:
    walk = RoomWalk(ASSUMED, CHANCES, "Cellar", THREE.start, frozenset())
    walk.moved(W_OF_START, frozenset({"Archive"}))
    before = walk.evidence
    walk.moved(THREE.start, frozenset({"Archive"}))
    assert walk.evidence > before
    assert set(walk._minds) == {"Bureau", "Cellar"}
    assert sum(walk._minds.values()) == pytest.approx(1)


W_OF_START = (THREE.start[0] - 1, THREE.start[1])


def test_a_step_is_judged_by_the_policy_of_the_human_model() -> None:
    """At C3, for a belief that places the room."""
    building, rules = BOX, MissionSettings()
    model = replace(HumanModel.of(building, rules), reward=Reward(ASSUMED.rationality))
    chances = StepChances(
        building.terrain.floodfills,
        {room.name: room.label for room in building.rooms},
        ASSUMED.rationality,
    )
    scene = Scene(building, {site.id: site for site in building.victims}, rules)
    plan = building.plan
    tried = 0
    for site in building.victims:
        room = building.room_of(site)
        assert room is not None
        for index, _ in enumerate(plan.tiles):
            cell = plan.cell(index)
            if not plan.walkable(cell) or building.room_at(cell) is room:
                continue
            told = instruct(scene, Pose(cell, building.start_heading), site.id, Level.C3)
            belief = replace(model.belief.state, position=cell, rooms=frozenset({room.name}))
            policy = model.policy(told, belief)
            nearer = sum(
                policy[action]
                for action, way in COMPASS_ACTIONS.items()
                if plan.walkable(way.from_cell(cell))
                and chances.distance(room.name, way.from_cell(cell))
                < chances.distance(room.name, cell)
            )
            steps = [w.from_cell(cell) for w in COMPASS_ACTIONS.values()]
            for end in filter(plan.walkable, steps):
                comes = chances.distance(room.name, end) < chances.distance(room.name, cell)
                expected = nearer if comes else 1 - nearer
                assert chances.likelihood(room.name, cell, end) == pytest.approx(expected)
                tried += 1
    assert tried > 50


def test_in_a_corridor_a_step_leads_the_right_way_with_98_percent() -> None:
    places = {room.name: room.label for room in GALLERY.rooms}
    chances = StepChances(GALLERY.terrain.floodfills, places, ASSUMED.rationality)
    assert chances.likelihood("Annex", (8, 1), (7, 1)) == pytest.approx(0.98, abs=0.005)
    assert chances.likelihood("Annex", (8, 1), (9, 1)) == pytest.approx(0.02, abs=0.005)


def paced(ratios: Sequence[float]) -> float:
    """The evidence of the pace of a walk whose steps took so many times as long as usual."""
    pace = WalkPace(ASSUMED)
    for ratio in ratios:
        pace.stepped(ratio)
    return pace.evidence


@given(st.integers(1, 200))
def test_the_steps_of_a_walk_at_the_usual_pace_say_less_and_less(steps: int) -> None:
    """However long a walk is, its pace alone proves nothing: some people search at full speed."""
    once_more = paced([1.0] * (steps + 1)) - paced([1.0] * steps)
    assert 0 < once_more < paced([1.0]) * 2 / steps
    assert paced([1.0] * steps) < 2


@given(st.lists(st.floats(0.3, 5), min_size=1, max_size=20), st.randoms())
def test_the_order_of_the_steps_says_nothing(ratios: list[float], random: Random) -> None:
    shuffled = random.sample(ratios, len(ratios))
    assert paced(shuffled) == pytest.approx(paced(ratios))


@given(st.lists(st.floats(1, 1.8), min_size=1, max_size=20))
def test_slower_steps_speak_against_knowing_the_way(ratios: list[float]) -> None:
    assert paced([1.2 * ratio for ratio in ratios]) < paced(ratios)


def test_nothing_was_said_before_the_first_step() -> None:
    assert paced([]) == 0


# --- the hierarchy over rooms -------------------------------------------------------------------


def test_what_one_room_shows_is_held_of_all_but_less() -> None:
    rooms = RoomKnowledge(ASSUMED, PLACES)
    assert rooms.share == pytest.approx(0.5)
    rooms.add("Archive", 4.0, seen=False)
    assert rooms.known("Archive") > 0.95
    assert 0.5 < rooms.known("Bureau") < 0.75
    assert rooms.share == pytest.approx(rooms.known("Bureau"))


def test_a_name_in_view_makes_the_room_known_and_says_nothing_of_the_map() -> None:
    rooms = RoomKnowledge(ASSUMED, PLACES)
    rooms.see(["Archive"])
    assert rooms.known("Archive") == pytest.approx(0.5 + 0.5 * ASSUMED.retention)
    rooms.add("Archive", -3.0, seen=True)
    assert rooms.known("Archive") < 0.3
    assert rooms.known("Bureau") == pytest.approx(0.5)


def test_the_quiz_tells_rooms_apart() -> None:
    rooms = RoomKnowledge(ASSUMED, PLACES, {"Archive": "right", "Bureau": "wrong"})
    assert rooms.known("Archive") > 0.6 > 0.2 > rooms.known("Bureau")


# --- what is evidence, and what is not ----------------------------------------------------------


class Told(Guide[Level]):
    """Speaks at one level, and learns all the same."""

    def __init__(self, level: Level, building: str = "practice") -> None:
        briefing = Briefing(load_building(building), MissionSettings())
        self.learner = KnowledgeLearner(briefing, ASSUMED)
        super().__init__(briefing, self.learner, NoInfluence(), level)

    @property
    def level(self) -> Level:
        return self.state

    def goal_set(self, goal: str, position: Cell) -> None:
        self.learner.goal_given_up()


@settings(max_examples=30)
@given(
    st.sampled_from([Level.C1, Level.C2]),
    st.lists(st.tuples(st.sampled_from([N, E, S, W]), st.integers(200, 2_000)), max_size=100),
)
def test_nothing_is_learned_of_the_map_at_c1_and_c2(
    level: Level, keys: list[tuple[Action, int]]
) -> None:
    coach = Told(level)
    run = MissionRun(Mission(PRACTICE, MissionSettings()), coach, lambda _: None)
    run.begin()
    now_ms = 0
    for action, pause_ms in keys:
        run.press(action, now_ms)
        now_ms += pause_ms
        run.advance(now_ms)
    rooms = coach.learner.rooms
    assert set(rooms.memorised.values()) == set(rooms.learned.values()) == {0.0}
    assert rooms.share == pytest.approx(0.5)


def test_evidence_stops_when_the_name_is_in_view() -> None:
    """A rescuer who has found the room may walk about in it as they like."""
    coach = Told(Level.C3)
    run = MissionRun(Mission(PRACTICE, MissionSettings()), coach, lambda _: None)
    run.begin()
    drive(run, character("literal").make(PRACTICE, MissionSettings(), 1), done=lambda: seen(run))
    walk = coach.learner._walk
    assert walk is not None
    assert coach.learner.doubt is None
    evidence, now_ms = walk.evidence, run.mission.time_ms
    for action in (N, S, E, W, W, E) * 2:
        run.press(action, now_ms)
        now_ms += 200
        run.advance(now_ms)
        if not seen(run) or coach.learner._walk is not walk:
            break
        assert walk.evidence == evidence
    assert now_ms > run.mission.time_ms - 400


def seen(run: MissionRun) -> bool:
    """Whether the name of the room that the bar tells is in view."""
    told = run.coach.guidance.text
    return any(f"Go to the {room.name}." in told for room in run.observation().rooms)


def test_only_knowledge_plus_quiz_is_built_with_a_quiz() -> None:
    with pytest.raises(ValueError, match="quiz"):
        CoachSpec("knowledge", quiz={"Archive": "right"})
    with pytest.raises(ValueError, match="quiz"):
        CoachSpec("knowledge+quiz")


# --- how long a leg takes -----------------------------------------------------------------------


def test_an_estimate_is_the_mean_weighted_by_precision() -> None:
    first = Estimate.around(10.0, 2.0)
    assert first.after(20.0, 2.0).mean == pytest.approx(15.0)
    assert first.after(20.0, 2.0, weight=0.0) == first
    assert first.after(20.0, 1.0).precision == pytest.approx(0.25 + 1)


@given(st.lists(st.tuples(st.floats(0, 15_000), st.booleans()), max_size=20))
def test_a_search_is_expected_to_take_all_the_time_of_searching_over_all_finds(
    searches: list[tuple[float, bool]],
) -> None:
    habits = Habits(ASSUMED)
    for ms, found in searches:
        before = habits.search_ms
        habits.searched(ms, 1.0, found=found)
        if not found:
            assert habits.search_ms >= before
        elif ms <= before:
            assert habits.search_ms <= before
    spent_ms = ASSUMED.search_ms * ASSUMED.search_finds + sum(ms for ms, _ in searches)
    finds = ASSUMED.search_finds + sum(found for _, found in searches)
    assert habits.search_ms == pytest.approx(spent_ms / finds)


def test_slow_reading_makes_c1_slower_than_c3() -> None:
    building, rules = load_building("harbour"), MissionSettings()
    scene = Scene(building, {site.id: site for site in building.victims}, rules)
    pose = Pose(building.start, building.start_heading)
    goal = building.victims[0].id
    habits = Habits(ASSUMED)
    times = LegTimes(ASSUMED, habits)
    usual = times.led(scene, pose, goal, Level.C1, 0.5) - times.known(scene, pose, goal)
    for _ in range(8):
        habits.answered(4_000, 1_300.0)
    assert habits.slowness > 2
    slow = times.led(scene, pose, goal, Level.C1, 0.5) - times.known(scene, pose, goal)
    assert slow > usual + 2_000


def test_what_c2_takes_depends_on_what_is_known_and_c1_does_not() -> None:
    building, rules = load_building("harbour"), MissionSettings()
    scene = Scene(building, {site.id: site for site in building.victims}, rules)
    pose = Pose(building.start, building.start_heading)
    times = LegTimes(ASSUMED, Habits(ASSUMED))
    goal = building.victims[0].id
    c1 = [times.led(scene, pose, goal, Level.C1, share) for share in (0, 1)]
    c2 = [times.led(scene, pose, goal, Level.C2, share) for share in (0, 1)]
    assert c1[0] == c1[1]
    assert c2[0] > c2[1]


# --- choosing -----------------------------------------------------------------------------------


def played(who: str, seed: int, spec: CoachSpec = KNOWLEDGE) -> list[object]:
    building, rules = load_building("harbour"), MissionSettings()
    happened: list[object] = []
    run = assemble(building, rules, spec, seed, happened.extend)
    run.begin()
    drive(run, character(who).make(building, rules, seed))
    return happened


def shares(happened: list[object]) -> dict[Level, float]:
    issued = [record for record in happened if isinstance(record, InstructionIssued)]
    spans = pairwise(issued)
    spent = dict.fromkeys(Level, 0)
    for one, other in spans:
        spent[one.shown_level] += other.at_ms - one.at_ms
    return {level: ms / sum(spent.values()) for level, ms in spent.items()}


def test_somebody_who_knows_every_room_hears_room_names_and_a_stranger_steps() -> None:
    knows, stranger = played("literal", 1), played("stranger", 1)
    assert shares(knows)[Level.C3] > 0.9
    assert shares(stranger)[Level.C1] > 0.6
    held = [
        [record for record in happened if isinstance(record, KnowledgeJudged)][-1].share
        for happened in (knows, stranger)
    ]
    assert held[0] > 0.75 > 0.5 > held[1]


def test_each_goal_and_each_change_is_judged_in_the_journal() -> None:
    happened = played("newcomer", 2)
    changes = [record for record in happened if isinstance(record, LevelChanged)]
    assert changes
    for change in changes:
        before = happened[happened.index(change) - 1]
        assert isinstance(before, KnowledgeJudged)
        assert before.chosen is change.after
        assert change.comprehension is None
    for record in happened:
        if isinstance(record, KnowledgeJudged) and record.why == "soonest":
            assert min(record.expected_ms, key=record.expected_ms.__getitem__) == record.chosen.name


def test_a_rescuer_who_is_lost_is_led() -> None:
    game = Game(KNOWLEDGE, load_building("harbour"))
    coach = game.coach
    assert isinstance(coach, KnowledgeCoach)
    assert coach.level is Level.C3
    goal = coach.lead.goal
    pose = Pose(game.mission.position, game.mission.heading)
    judged, changed = coach.choose("lost", 10_000, pose, goal)
    assert isinstance(judged, KnowledgeJudged)
    assert judged.why == "lost"
    assert judged.known[judged.room or ""] < 0.2
    assert isinstance(changed, LevelChanged)
    assert changed.after is Level.C1
    assert coach.choose("lost", 20_000, pose, goal) == []


def test_the_preset_belief_applies_the_papers_thresholds() -> None:
    spec = parse_coach("ana", preset="belief")
    for who in ("literal", "stranger"):
        happened = played(who, 1, spec)
        judged = [record for record in happened if isinstance(record, KnowledgeJudged)]
        assert judged[0].chosen is Level.C3
        for record in judged:
            if record.room is not None and record.known[record.room] > 0.8:
                assert record.chosen is Level.C3
            if record.chosen is Level.C1 and record.room is not None:
                assert record.known[record.room] < 0.3
