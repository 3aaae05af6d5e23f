"""What a coach is told, and what it is not."""

from __future__ import annotations

from dataclasses import fields
from inspect import signature

from game.coach.api import Briefing
from game.coach.spec import build_coach
from tests.coach.scripted import ADAPTIVE, PRACTICE, Game, N, W


def test_a_coach_is_built_from_the_mission_alone() -> None:
    assert [field.name for field in fields(Briefing)] == ["building", "settings", "seed", "phrases"]
    assert list(signature(build_coach).parameters) == ["spec", "briefing"]


def test_the_coach_says_the_same_to_everybody_who_does_the_same() -> None:
    """Another process of the same study, after any number of other missions."""
    Game(ADAPTIVE[1], PRACTICE).act(*[N] * 9)
    games = [Game(ADAPTIVE[0], PRACTICE) for _ in range(2)]
    for game in games:
        game.act(*[N] * 7, *[W] * 5)
    assert games[0].records == games[1].records
