"""What is said at C1, C2 and C3, and the way between them."""

from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from game.coach.acts import Level
from game.coach.instructions import Pose, Scene, instruct, lower
from game.world.building import Building, Severity, VictimSite
from game.world.geometry import Cell, Heading
from game.world.mission import Mission
from game.world.plan import Plan
from game.world.settings import MissionSettings
from tests.coach.instructions.office import goal_at, office, pose, poses, scene

N, E, S, W = Heading
START = pose(1, 6, E)
POST_ROOM_RED, STORE_ROOM_BLUE, COPY_ROOM_RED = (2, 2), (11, 2), (8, 10)
OFFICE_A_BLUE, ARCHIVE_RED = (27, 3), (28, 15)

a_pose = st.sampled_from(poses())
a_goal = st.sampled_from([site.id for site in office().victims])
a_level = st.sampled_from(Level)


@pytest.mark.parametrize(
    ("where", "goal", "level", "text"),
    [
        (START, STORE_ROOM_BLUE, Level.C3, "Go to the Store Room. Triage the blue victim."),
        (START, OFFICE_A_BLUE, Level.C3, "Go to Office A. Triage the blue victim."),
        (pose(9, 1, N), STORE_ROOM_BLUE, Level.C3, "Triage the blue victim."),
        (
            START,
            STORE_ROOM_BLUE,
            Level.C2,
            "Enter the second door on your left. Approach and save the blue victim.",
        ),
        (
            START,
            ARCHIVE_RED,
            Level.C2,
            "Proceed to the first intersection on your right. Turn right. "
            "Enter the first door on your left.",
        ),
        (
            pose(17, 15, E),
            ARCHIVE_RED,
            Level.C2,
            "Proceed until you see a red victim. Approach and save the red victim.",
        ),
        (
            pose(3, 4, S),
            STORE_ROOM_BLUE,
            Level.C2,
            "Enter the hallway. Turn left. Enter the first door on your left.",
        ),
        (
            pose(12, 6, N),
            STORE_ROOM_BLUE,
            Level.C2,
            "Enter the door ahead. Approach and save the blue victim.",
        ),
        (
            START,
            STORE_ROOM_BLUE,
            Level.C1,
            "Walk forward 11 steps. Turn left. Walk forward 4 steps. Utilize medical equipment.",
        ),
        (pose(11, 2, N), STORE_ROOM_BLUE, Level.C1, "Stop. Utilize medical equipment."),
        (pose(12, 2, N), STORE_ROOM_BLUE, Level.C1, "Stop. Utilize medical equipment."),
        (
            pose(14, 2, N),
            STORE_ROOM_BLUE,
            Level.C1,
            "Turn left. Walk forward 2 steps. Utilize medical equipment.",
        ),
    ],
)
def test_what_is_said(where: Pose, goal: Cell, level: Level, text: str) -> None:
    assert instruct(scene(), where, goal_at(goal), level).text == text


@given(a_pose, a_goal, a_level)
def test_an_instruction_keeps_what_was_asked(where: Pose, goal: str, level: Level) -> None:
    instruction = instruct(scene(), where, goal, level)
    assert (instruction.level, instruction.goal, instruction.start) == (level, goal, where)
    assert instruction.fallback is (instruction.shown_level < level)
    assert instruction.path[0] == where.cell
    assert instruction.path[-1] == instruction.end.cell
    assert goal in instruction.accepts


@given(a_pose, a_goal)
def test_lowering_is_the_way_between_levels(where: Pose, goal: str) -> None:
    place = scene()
    at = {level: instruct(place, where, goal, level) for level in Level}
    assert lower(place, at[Level.C3]) == at[Level.C2]
    assert lower(place, at[Level.C2]) == at[Level.C1]


def test_there_is_nothing_below_c1() -> None:
    place, goal = scene(), goal_at(ARCHIVE_RED)
    with pytest.raises(ValueError, match="lowest"):
        lower(place, instruct(place, START, goal, Level.C1))


@given(a_pose, a_goal)
def test_every_step_of_c1_leads_nearer(where: Pose, goal: str) -> None:
    place = scene()
    instruction = instruct(place, where, goal, Level.C1)
    assert sum(action == "Walkforward" for action, _ in instruction.tuples) <= 3
    distances = place.floodfills.to(place.waiting[goal].cell)
    to_go = [distances[office().plan.index(cell)] for cell in instruction.path]
    assert to_go == list(range(to_go[0], to_go[0] - len(to_go), -1))


@given(a_pose, a_goal)
def test_c2_ends_with_a_move_of_at_most_three_tuples(where: Pose, goal: str) -> None:
    instruction = instruct(scene(), where, goal, Level.C2)
    if not instruction.fallback:
        assert len(instruction.tuples) <= 3
        assert instruction.tuples[-1][0] != "Turn"


@given(a_pose, a_goal)
def test_a_treatment_is_of_the_goal(where: Pose, goal: str) -> None:
    place = scene()
    for level in Level:
        instruction = instruct(place, where, goal, level)
        reached = place.treated_at(instruction.end)
        if instruction.treats:
            assert reached is not None
            assert reached.id == goal


@given(a_pose)
def test_the_coach_knows_the_triage_rule(where: Pose) -> None:
    begun_here = replace(office(), start=where.cell, start_heading=where.heading)
    mission = Mission(begun_here, MissionSettings())
    assert scene().treated_at(where) == mission.victim_in_reach()


def corridor(**victims_at: int) -> Scene:
    """A straight corridor eight cells long with red victims, and no rooms."""
    plan = Plan(10, 3, bytes([1] * 10 + [1, *[0] * 8, 1] + [1] * 10))
    sites = {name: VictimSite(name, (x, 1), Severity.RED) for name, x in victims_at.items()}
    building = Building("corridor", plan, (), (), tuple(sites.values()), (1, 1), E, "")
    return Scene(building, sites, MissionSettings())


def test_whoever_would_treat_another_victim_is_first_told_to_move() -> None:
    place = corridor(near=2, far=4)
    between = Pose((3, 1), W)
    assert instruct(place, between, "near", Level.C1).text == "Stop. Utilize medical equipment."
    onto_it = instruct(place, between, "far", Level.C1)
    assert onto_it.text == "Turn around. Walk forward 1 step. Utilize medical equipment."
    assert place.treated_at(onto_it.end) == place.waiting["far"]


def test_equally_near_victims_of_one_colour_are_not_told_apart_at_c2() -> None:
    place = corridor(one=1, other=5)
    approach = ("ApproachAndSave", "redvictim")
    assert instruct(place, Pose((2, 1), W), "one", Level.C2).tuples == (approach,)
    assert approach not in instruct(place, Pose((3, 1), W), "one", Level.C2).tuples[:1]


def test_a_victim_outside_all_rooms_is_told_at_a_lower_level() -> None:
    instruction = instruct(corridor(lonely=8), Pose((1, 1), E), "lonely", Level.C3)
    assert (instruction.level, instruction.shown_level) == (Level.C3, Level.C2)
    assert instruction.fallback
    assert instruction.text == (
        "Proceed until you see a red victim. Approach and save the red victim."
    )


def test_at_c3_any_victim_that_fits_the_words_is_accepted() -> None:
    place = scene()
    blue = goal_at((7, 11))
    assert instruct(place, START, blue, Level.C3).accepts == {blue}
    other = VictimSite("twin", (3, 9), Severity.BLUE)
    crowded = Scene(place.building, {**place.waiting, "twin": other}, place.settings)
    assert instruct(crowded, START, blue, Level.C3).accepts == {blue, "twin"}
    assert instruct(crowded, START, blue, Level.C2).accepts == {blue}


def test_a_goal_must_wait_and_be_reachable() -> None:
    place = scene(ARCHIVE_RED)
    with pytest.raises(ValueError, match="no victim v02 is waiting"):
        instruct(place, START, "v02", Level.C1)
    with pytest.raises(ValueError, match="no way leads from"):
        instruct(place, pose(0, 0, E), goal_at(ARCHIVE_RED), Level.C1)
