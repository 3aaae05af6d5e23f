"""Notices say what happened, and never what did not."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from game.coach.acts import Level
from game.coach.instructions import Pose, correction, instruct
from game.world.geometry import Heading
from tests.coach.instructions.office import goal_at, office, pose, poses, scene

N, E, S, W = Heading
STORE_ROOM_BLUE, ARCHIVE_RED = (11, 2), (28, 15)
START = pose(1, 6, E)


@pytest.mark.parametrize(
    ("level", "now", "notice"),
    [
        (Level.C2, pose(15, 6, E), "passed_door"),
        (Level.C1, pose(15, 6, E), "too_far"),
        (Level.C3, pose(15, 6, E), None),
        (Level.C2, pose(8, 6, E), None),
        (Level.C2, pose(26, 10, S), "wrong_way"),
        (Level.C3, pose(26, 10, S), "wrong_way"),
    ],
)
def test_what_is_said_on_the_way_to_the_store_room(
    level: Level, now: Pose, notice: str | None
) -> None:
    place = scene()
    instruction = instruct(place, START, goal_at(STORE_ROOM_BLUE), level)
    assert correction(place, instruction, now) == notice


@given(
    st.sampled_from(poses()),
    st.sampled_from(poses()),
    st.sampled_from([site.id for site in office().victims]),
    st.sampled_from(Level),
)
def test_a_notice_is_true(start: Pose, now: Pose, goal: str, level: Level) -> None:
    place = scene()
    instruction = instruct(place, start, goal, level)
    notice = correction(place, instruction, now)
    distances = place.floodfills.to(place.waiting[goal].cell)
    here = distances[office().plan.index(now.cell)]
    if now.cell in instruction.path:
        assert not notice
    if notice == "wrong_way":
        assert here > distances[office().plan.index(start.cell)]
    if notice in ("passed_door", "too_far"):
        assert instruction.shown_level < Level.C3
        assert here > min(distances[office().plan.index(cell)] for cell in instruction.path)
        assert any(now.cell[axis] == cell[axis] for cell in instruction.path for axis in (0, 1))
    if notice == "passed_door":
        assert any(office().plan.is_door(cell) for cell in instruction.path)
