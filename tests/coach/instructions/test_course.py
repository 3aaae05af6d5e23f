"""A course is the chain of instructions to a goal: each begins where the last one ended."""

from itertools import pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st

from game.coach.acts import Level
from game.coach.instructions import Pose, Scene, course, instruct
from game.world import load_building
from game.world.geometry import Heading
from game.world.settings import MissionSettings

HARBOUR = load_building("harbour")
SCENE = Scene(HARBOUR, {site.id: site for site in HARBOUR.victims}, MissionSettings())
CELLS = [cell for room in HARBOUR.rooms for cell in room.cells]


@given(
    st.sampled_from(CELLS), st.sampled_from(Heading), st.sampled_from(sorted(SCENE.waiting)),
    st.sampled_from(Level),
)  # fmt: skip
def test_a_course_leads_from_here_to_the_treatment(
    cell: tuple[int, int], heading: Heading, goal: str, level: Level
) -> None:
    said = course(SCENE, Pose(cell, heading), goal, level)
    assert said[0] == instruct(SCENE, Pose(cell, heading), goal, level)
    assert [one.treats for one in said] == [False] * (len(said) - 1) + [True]
    assert all(before.end == after.start for before, after in pairwise(said))
    assert all(one.level is level and one.text for one in said)
    to_go = SCENE.floodfills.to(SCENE.victim(goal).cell)
    distances = [to_go[HARBOUR.plan.index(one.start.cell)] for one in said]
    assert distances == sorted(distances, reverse=True)


def test_at_c3_the_course_is_one_instruction() -> None:
    start = Pose(HARBOUR.start, HARBOUR.start_heading)
    assert len(course(SCENE, start, "v01", Level.C3)) == 1


def test_a_course_to_nobody_is_refused() -> None:
    with pytest.raises(ValueError, match="no victim"):
        course(SCENE, Pose(HARBOUR.start, Heading.NORTH), "v99", Level.C1)
