"""pi^HR: what a rescuer who follows the directions does next (paper 5.1.3).

A step to a place is softmax-rational: its probability is proportional to exp(-beta D(end)), which
is the `boltzmann` likelihood of the goal inference. A belief over places mixes such steps.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import exp
from typing import Protocol

from game.coach.acts import Level
from game.coach.belief import Belief
from game.world.events import Action
from game.world.floodfill import UNREACHABLE, Floodfills
from game.world.geometry import Cell, Heading
from game.world.mission import COMPASS_ACTIONS
from game.world.sight import Sight


class Stance(Protocol):
    """Where somebody stands, and which way they face."""

    @property
    def cell(self) -> Cell: ...

    @property
    def heading(self) -> Heading: ...


class Directions(Protocol):
    """What the policy needs to know of an instruction (`game.coach.instructions.Instruction`)."""

    @property
    def shown_level(self) -> Level: ...

    @property
    def goal(self) -> str: ...

    @property
    def start(self) -> Stance: ...

    @property
    def end(self) -> Stance: ...

    @property
    def path(self) -> Sequence[Cell]: ...

    @property
    def treats(self) -> bool: ...


@dataclass(frozen=True)
class Moves:
    """A distribution over ways to go, for somebody facing `heading`; triage where it is empty."""

    heading: Heading
    ways: Mapping[Heading, float]


def directed_moves(
    directions: Directions, belief: Belief, floodfills: Floodfills, sight: Sight, beta: float
) -> Moves:
    """Which way the rescuer goes next under `directions`, by the level that is shown.

    Without a place to go to every step is as likely as any other: the rescuer explores. At C3 a
    room whose place is not known is sought in every place it may be, by its probability.
    """
    if directions.shown_level is Level.C1:
        return _word_by_word(directions)
    position = belief.position
    if directions.shown_level is Level.C2:
        if directions.treats and position == directions.end.cell:
            return Moves(belief.heading, {})
        targets = _along(directions.path, sight.field(position), belief)
    else:
        cell = belief.space.victims[directions.goal]
        known = directions.goal in belief.victims
        if known and abs(cell[0] - position[0]) + abs(cell[1] - position[1]) <= 1:
            return Moves(belief.heading, {})
        room = belief.space.rooms[directions.goal]
        targets = {cell: 1.0} if known else belief.place_distribution(room) if room else {}
    ways = dict.fromkeys(open_ways(position, floodfills), 0.0)
    for target, weight in (targets or {position: 1.0}).items():
        for way, share in steps_to(target, position, floodfills, beta).items():
            ways[way] += weight * share
    return Moves(belief.heading, ways)


def open_ways(position: Cell, floodfills: Floodfills) -> tuple[Heading, ...]:
    """The ways in which a step from `position` is possible."""
    return tuple(way for way in Heading if floodfills.plan.walkable(way.from_cell(position)))


def steps_to(
    target: Cell, position: Cell, floodfills: Floodfills, beta: float
) -> dict[Heading, float]:
    """The next step of somebody at `position` who heads for `target`, with its probabilities; any
    step where that is unreachable or already reached."""
    field, index = floodfills.to(target), floodfills.plan.index
    here, ways = field[index(position)], open_ways(position, floodfills)
    if here in (0, UNREACHABLE):
        return dict.fromkeys(ways, 1 / len(ways))
    risen = {way: field[index(way.from_cell(position))] + 1 - here for way in ways}
    weights = {way: exp(-beta * rise) for way, rise in risen.items()}
    total = sum(weights.values())
    return {way: weight / total for way, weight in weights.items()}


def action_probabilities(moves: Moves, actions: Sequence[Action]) -> dict[Action, float]:
    """The distribution over `actions` that carries out `moves` with the controls they belong to."""
    probabilities = dict.fromkeys(actions, 0.0)
    if not moves.ways:
        probabilities[Action.TRIAGE] = 1.0
    for way, share in moves.ways.items():
        probabilities[_action_towards(way, moves.heading, actions)] += share
    return probabilities


def _word_by_word(directions: Directions) -> Moves:
    """At C1 the action is the instruction itself: its first step, turn or treatment."""
    heading, path = directions.start.heading, directions.path
    if len(path) > 1:
        (x, y), (to_x, to_y) = path[:2]
        towards = next(way for way in Heading if way.step == (to_x - x, to_y - y))
    elif directions.treats:
        return Moves(heading, {})
    else:
        towards = directions.end.heading
    return Moves(heading, {towards: 1.0})


def _along(path: Sequence[Cell], view: int, belief: Belief) -> dict[Cell, float]:
    """The next cell of the way for somebody on it, for others the last of its cells in view;
    nothing where it is at its end or out of view."""
    if belief.position in path:
        following = path[path.index(belief.position) + 1 :][:1]
    else:
        index = belief.space.plan.index
        following = [cell for cell in path if view >> index(cell) & 1][-1:]
    return dict.fromkeys(following, 1.0)


def _action_towards(way: Heading, heading: Heading, actions: Sequence[Action]) -> Action:
    if Action.FORWARD not in actions:
        return next(action for action in actions if COMPASS_ACTIONS.get(action) is way)
    if way is heading:
        return Action.FORWARD
    return Action.TURN_LEFT if way is heading.left else Action.TURN_RIGHT
