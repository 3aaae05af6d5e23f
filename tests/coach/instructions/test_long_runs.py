"""Nobody is asked to count beyond twelve steps at C1."""

from __future__ import annotations

from itertools import pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st

from game.coach.acts import Level
from game.coach.instructions import Instruction, Pose, Scene, instruct
from game.coach.instructions.vocabulary import MOST_STEPS
from game.rescuers.literal import LiteralReader
from game.rescuers.literal.grammar import Walk, WalkTo, parse
from game.world import load_building
from game.world.geometry import Cell, Heading
from game.world.mission import Mission
from game.world.observation import Guidance
from game.world.settings import Controls, MissionSettings
from tests.coach.scripted import LONG

HARBOUR = load_building("harbour")
SITES = {site.id: site for site in HARBOUR.victims}
SCENE = Scene(HARBOUR, SITES, MissionSettings())
CELLS = sorted(HARBOUR.plan.cells(HARBOUR.plan.walkable_mask))


def runs(instruction: Instruction) -> list[list[Cell]]:
    """The straight runs of the path."""
    found: list[list[Cell]] = []
    before: Heading | None = None
    for start, end in pairwise(instruction.path):
        way = next(heading for heading in Heading if heading.from_cell(start) == end)
        if way is not before:
            found.append([])
        found[-1].append(end)
        before = way
    return found


@given(st.sampled_from(CELLS), st.sampled_from(Heading), st.sampled_from(sorted(SITES)))
def test_what_ends_a_run_is_named_where_it_is_too_long(
    cell: Cell, heading: Heading, goal: str
) -> None:
    instruction = instruct(SCENE, Pose(cell, heading), goal, Level.C1)
    said = [thing for action, thing in instruction.tuples if action == "Walkforward"]
    walked = runs(instruction)
    assert len(said) == len(walked)
    for thing, run in zip(said, walked, strict=True):
        if thing == "Wall":
            (x, y), (ahead_x, ahead_y) = run[-2:]
            assert len(run) > MOST_STEPS
            assert not HARBOUR.plan.walkable((2 * ahead_x - x, 2 * ahead_y - y))
        elif thing == "Door":
            assert len(run) > MOST_STEPS
            assert [HARBOUR.plan.is_door(one) for one in run] == [False] * (len(run) - 1) + [True]
        else:
            assert int(thing.split()[0]) == len(run) <= MOST_STEPS


@pytest.mark.parametrize("controls", ["compass", "turn"])
@pytest.mark.parametrize("end", ["wall", "door"])
def test_a_literal_reader_walks_to_what_ends_the_run(end: str, controls: Controls) -> None:
    mission = Mission(LONG, MissionSettings(controls=controls))
    reader, text = LiteralReader(controls), f"Walk forward to the {end}."
    met_door_ms = None
    for now_ms in range(0, 60_000, 200):
        action = reader.decide(mission.observation(Guidance(text)))
        if action is None:
            break
        mission.step(action, now_ms)
        if LONG.plan.is_door(mission.position) and met_door_ms is None:
            met_door_ms = now_ms
            if end == "door":
                break
        if not LONG.plan.walkable(mission.heading.from_cell(mission.position)):
            break
    assert met_door_ms is not None
    stands_at_wall = not LONG.plan.walkable(mission.heading.from_cell(mission.position))
    assert stands_at_wall == (end == "wall")


def test_the_grammar_knows_both() -> None:
    assert parse("Walk forward to the wall. Walk forward to the door. Walk forward 3 steps.") == (
        WalkTo("wall"),
        WalkTo("door"),
        Walk(3),
    )
