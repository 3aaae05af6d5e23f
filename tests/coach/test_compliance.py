from __future__ import annotations

from itertools import pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st

from game.coach.acts import Level
from game.coach.compliance import (
    HEEDED_CELLS,
    LOST_MS,
    MISSTEP_EXCESS,
    NOTHING_ASKED,
    NOTICE_MS,
    NOTICE_MS_PER_LETTER,
    READING_MS,
    READING_MS_PER_LETTER,
    Compliance,
    fits,
    reached,
    track,
)
from game.coach.instructions import Instruction, Pose, Scene, instruct
from game.world import load_building
from game.world.building import Severity
from game.world.floodfill import Floodfills
from game.world.geometry import Cell, Heading
from game.world.settings import MissionSettings

BUILDING = load_building("practice")
FLOODFILLS = Floodfills(BUILDING.plan)
SITES = {site.id: site for site in BUILDING.victims}
SCENE = Scene(BUILDING, SITES, MissionSettings())
START = Pose(BUILDING.start, BUILDING.start_heading)


STEP_MS, LATER_MS = 200, 60_000


def walk(level: Level, distances: list[int]) -> list[Compliance]:
    """The states after each of the distances, a step apart, long after the words were read; the
    first is where the instruction is issued."""
    states = [NOTHING_ASKED.issued(level, distances[0], 0, "")]
    for step, distance in enumerate(distances[1:]):
        states.append(states[-1].acted(distance, LATER_MS + STEP_MS * step))
    return states


def straight(
    path: list[Cell], start: Heading, end: Heading, *, treats: bool = False
) -> Instruction:
    return Instruction(
        level=Level.C1,
        shown_level=Level.C1,
        goal="v01",
        tuples=(),
        sentences=(),
        text="",
        start=Pose(path[0], start),
        end=Pose(path[-1], end),
        path=tuple(path),
        treats=treats,
        accepts=frozenset({"v01"}),
    )


@pytest.mark.parametrize(("level", "excess"), [(Level.C1, 1), (Level.C2, 3), (Level.C3, 8)])
def test_a_misstep_is_a_rise_above_the_minimum_by_what_the_level_allows(
    level: Level, excess: int
) -> None:
    down, up = [20, 19, 18], [18 + rise for rise in range(1, excess + 1)]
    *before, last = walk(level, down + up)
    assert last.misstep
    assert last.excess == excess == MISSTEP_EXCESS[level]
    assert not any(state.misstep for state in before)


@given(st.sampled_from(Level), st.lists(st.sampled_from([-1, 0, 1]), max_size=60))
def test_only_an_action_that_leads_away_is_a_misstep(level: Level, steps: list[int]) -> None:
    distances = [30]
    for step in steps:
        distances.append(distances[-1] + step)
    for before, after, state in zip(
        distances, distances[1:], walk(level, distances)[1:], strict=False
    ):
        assert not state.misstep or after > before
        assert state.excess >= 0


def test_walking_on_the_right_way_is_never_a_misstep() -> None:
    for level in Level:
        assert not any(state.misstep for state in walk(level, list(range(40, 0, -1))))


WORDS, NOTICE = "Walk forward 4 steps.", "That is the wrong way."


def test_no_step_is_a_misstep_before_the_words_can_be_read() -> None:
    state = NOTHING_ASKED.issued(Level.C1, 5, 1_000, WORDS)
    readable_ms = 1_000 + READING_MS + READING_MS_PER_LETTER * len(WORDS)
    early, late = state.acted(6, readable_ms - 1), state.acted(6, readable_ms)
    assert early.astray
    assert not early.misstep
    assert late.misstep
    assert not early.restated(Level.C1, 6).acted(7, readable_ms - 1).misstep
    assert early.restated(Level.C1, 6).acted(7, readable_ms).misstep


def test_a_second_misstep_is_disobedience_unless_something_was_completed_between() -> None:
    first = walk(Level.C1, [5, 6])[-1]
    assert first.misstep
    assert not first.disobeys
    again = first.corrected().issued(Level.C1, 6, LATER_MS, WORDS, notice=NOTICE)
    assert again.acted(7, 2 * LATER_MS).disobeys
    forgiven = again.completed().issued(Level.C1, 6, LATER_MS, WORDS)
    assert not forgiven.acted(7, 2 * LATER_MS).disobeys


def test_missteps_while_a_notice_is_being_read_belong_to_it() -> None:
    state = walk(Level.C1, [5, 6])[-1].corrected().issued(Level.C1, 6, 0, WORDS, notice=NOTICE)
    notice_ms = NOTICE_MS + NOTICE_MS_PER_LETTER * len(NOTICE)
    missteps, disobeyed, distance = 0, [], 6
    for at_ms in range(0, 3 * notice_ms, STEP_MS):
        distance += 1
        state = state.acted(distance, at_ms)
        missteps += state.misstep
        if state.misstep and state.may_notice:
            disobeyed.append(at_ms)
            assert state.disobeys
            state = state.corrected().issued(Level.C1, distance, at_ms, WORDS, notice=NOTICE)
        elif state.astray:
            assert not state.disobeys
            state = state.restated(Level.C1, distance)
    assert missteps > len(disobeyed) > 1
    assert all(later - earlier >= notice_ms for earlier, later in pairwise(disobeyed))


def test_at_c3_no_misstep_is_disobedience_nor_leads_to_it() -> None:
    astray = walk(Level.C3, [5, 13])[-1]
    assert astray.misstep
    assert not astray.corrected().issued(Level.C2, 13, 0, "").acted(16, LATER_MS).disobeys
    strict = walk(Level.C2, [5, 8])[-1].corrected()
    assert not strict.issued(Level.C3, 8, 0, "").acted(16, LATER_MS).disobeys
    assert strict.issued(Level.C1, 8, 0, "").acted(9, LATER_MS).disobeys


def test_a_rescuer_is_lost_who_does_not_come_nearer() -> None:
    state = NOTHING_ASKED.issued(Level.C2, 9, 3_000, WORDS)
    assert state.lost_at_ms == 3_000 + LOST_MS
    for step in range(40):
        state = state.acted(9 + step % 2, 4_000 + STEP_MS * step)
    assert state.lost_at_ms == 3_000 + LOST_MS
    assert state.restated(Level.C2, 10).lost_at_ms == 3_000 + LOST_MS
    assert state.acted(8, 20_000).lost_at_ms == 20_000 + LOST_MS
    assert state.acted(11, 20_000, nearer=True).lost_at_ms == 20_000 + LOST_MS


def test_a_correction_is_heeded_after_some_cells_the_right_way() -> None:
    states = walk(Level.C2, list(range(20, 10, -1)))
    assert [state.heeded for state in states] == [n >= HEEDED_CELLS for n in range(10)]


def test_steps_astray_after_a_correction_do_not_keep_it_up() -> None:
    astray = [20, 21, 22, 23, 24]
    states = walk(Level.C3, [*astray, *range(23, 15, -1)])
    turned_back = states[len(astray) :]
    assert [state.heeded for state in turned_back] == [n >= HEEDED_CELLS for n in range(1, 9)]


def test_the_track_has_the_poses_that_carrying_out_passes_and_no_others() -> None:
    path: list[Cell] = [(4, 4), (5, 4), (5, 5)]
    turning = straight(path, Heading.WEST, Heading.SOUTH)
    walked = {
        Pose((4, 4), Heading.WEST),
        Pose((4, 4), Heading.EAST),
        Pose((5, 4), Heading.EAST),
        Pose((5, 4), Heading.SOUTH),
        Pose((5, 5), Heading.SOUTH),
    }
    assert track(turning, "compass") == walked
    between = {Pose((4, 4), Heading.NORTH), Pose((4, 4), Heading.SOUTH)}
    assert track(turning, "turn") == walked | between


@pytest.mark.parametrize("level", [Level.C1, Level.C2])
@pytest.mark.parametrize("goal", sorted(SITES))
def test_whoever_walks_the_path_is_on_the_track(level: Level, goal: str) -> None:
    instruction = instruct(SCENE, START, goal, level)
    poses = track(instruction, "compass")
    assert {START, instruction.end} <= poses
    assert {pose.cell for pose in poses} == set(instruction.path)


def test_an_instruction_is_reached_at_its_end_cell_however_one_faces() -> None:
    instruction = straight([(4, 4), (5, 4)], Heading.EAST, Heading.EAST)
    assert reached(instruction, Pose((5, 4), Heading.NORTH))
    assert not reached(instruction, Pose((4, 4), Heading.EAST))
    treating = straight([(4, 4), (5, 4)], Heading.EAST, Heading.EAST, treats=True)
    assert not reached(treating, Pose((5, 4), Heading.EAST))


def test_an_instruction_that_only_turns_is_reached_with_the_turn() -> None:
    turning = straight([(4, 4)], Heading.EAST, Heading.SOUTH)
    assert not reached(turning, Pose((4, 4), Heading.EAST))
    assert reached(turning, Pose((4, 4), Heading.SOUTH))


def test_the_words_decide_who_may_be_treated_instead() -> None:
    harbour = load_building("harbour")
    sites = {site.id: site for site in harbour.victims}
    scene = Scene(harbour, sites, MissionSettings())
    goal = next(site for site in harbour.victims if site.severity is Severity.BLUE)
    alike = next(s for s in harbour.victims if s.severity is Severity.BLUE and s is not goal)
    other = next(site for site in harbour.victims if site.severity is Severity.RED)
    beside = Pose(
        next(h.from_cell(goal.cell) for h in Heading if _floor(scene, h.from_cell(goal.cell))),
        Heading.NORTH,
    )
    for level in Level:
        instruction = instruct(scene, beside, goal.id, level)
        assert fits(scene, instruction, goal.id, ())
        assert not fits(scene, instruction, other.id, [goal.cell, other.cell])
    named = instruct(scene, beside, goal.id, Level.C2)
    assert named.treats
    assert fits(scene, named, alike.id, [goal.cell])
    word_by_word = instruct(scene, beside, goal.id, Level.C1)
    assert not fits(scene, word_by_word, alike.id, [goal.cell])
    afar = instruct(scene, Pose(harbour.start, harbour.start_heading), goal.id, Level.C2)
    assert afar.treats or not fits(scene, afar, alike.id, [goal.cell])


def _floor(scene: Scene, cell: Cell) -> bool:
    return scene.building.plan.walkable(cell)


def test_the_time_to_read_follows_the_text_in_any_language() -> None:
    """A wide character counts as three letters, a letter with an accent as one."""
    here, german, japanese = (
        NOTHING_ASKED.issued(Level.C1, 5, 0, opening, notice=opening)
        for opening in ("Turn left.", "Zur Tür...", "左へ曲がる。")
    )
    assert here.read_ms == READING_MS + 20 * READING_MS_PER_LETTER
    assert here.notice_ms == NOTICE_MS + 10 * NOTICE_MS_PER_LETTER
    assert (german.read_ms, german.notice_ms) == (here.read_ms, here.notice_ms)
    assert japanese.read_ms == READING_MS + 36 * READING_MS_PER_LETTER
    assert japanese.notice_ms == NOTICE_MS + 18 * NOTICE_MS_PER_LETTER
