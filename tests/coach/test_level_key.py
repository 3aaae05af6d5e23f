"""The level key: recorded by every coach, granted by every one that adapts."""

from __future__ import annotations

from dataclasses import replace
from typing import get_args

import pytest
from hypothesis import given
from hypothesis import strategies as st

from game.coach.acts import (
    InstructionIssued,
    KnowledgeJudged,
    Level,
    LevelChanged,
    PosteriorEvaluated,
)
from game.coach.levels import MOST_PREFERENCE, SHIFT, granted, preferring, thresholds
from game.coach.presets import FLOODFILL, PRESETS
from game.coach.spec import CoachSpec
from game.world.events import Action, LevelAsked, LevelWish, TreatmentStarted
from game.world.settings import FREE_PLAY, MissionSettings
from tests.coach.scripted import (
    ADAPTIVE,
    EVERY,
    KNOWLEDGE,
    PACE,
    PRACTICE,
    STATIC,
    Game,
    away,
    check_records,
    nearer,
    only,
)

WISHES: tuple[LevelWish, ...] = get_args(LevelWish)


def named(spec: CoachSpec) -> str:
    return f"{spec.kind}-{spec.preset or spec.level}"


def said(game: Game) -> Level:
    """The level in force."""
    return only(InstructionIssued, game.records)[-1].level


def ask(game: Game, want: LevelWish) -> list[object]:
    before = len(game.records)
    game.run.ask_level(want, game.now_ms)
    return list(game.records[before:])


@pytest.mark.parametrize("spec", EVERY, ids=named)
def test_a_coach_that_adapts_grants_every_request_at_once(spec: CoachSpec) -> None:
    game = Game(spec, PRACTICE, FREE_PLAY)
    last = {"simpler": Level.C1, "shorter": Level.C3}
    for step in range(60):
        game.act(nearer(game) if step % 7 else away(game))
        if step % 4 == 0:
            want = WISHES[step // 12 % 2]
            before = said(game)
            asked, *then = ask(game, want)
            assert asked == LevelAsked(game.now_ms, want)
            after = said(game)
            if spec.level is not None or before is last[want]:
                assert after is before
            else:
                assert (after < before) == (want == "simpler") and after is not before
            changes = [it for it in then if isinstance(it, LevelChanged)]
            assert [(it.before, it.after) for it in changes] == [(before, after)] * len(changes)
            assert bool(changes) == (after is not before)
    check_records(game, spec)


@given(st.sampled_from(WISHES), st.sampled_from(Level), st.sampled_from([None, *Level]))
def test_what_is_granted(want: LevelWish, before: Level, chosen: Level | None) -> None:
    there = [it for it in Level if (it < before if want == "simpler" else it > before)]
    nearest = (max if want == "simpler" else min)(there, default=before)
    assert granted(want, before, chosen) is (chosen if chosen in there else nearest)


@pytest.mark.parametrize("spec", [*STATIC, PACE], ids=named)
def test_a_coach_with_one_level_only_records_it(spec: CoachSpec) -> None:
    game = Game(spec, PRACTICE, FREE_PLAY)
    for want in WISHES * 3:
        assert ask(game, want) == [LevelAsked(0, want)]


@pytest.mark.parametrize("spec", ADAPTIVE[:4], ids=named)
def test_ana_shifts_both_thresholds(spec: CoachSpec) -> None:
    assert spec.preset is not None
    preset = PRESETS[spec.preset]
    for want, sign in (("simpler", 1), ("shorter", -1)):
        game = Game(spec, PRACTICE, FREE_PLAY)
        ask(game, "simpler" if want == "simpler" else "shorter")
        while not (evaluated := only(PosteriorEvaluated, game.records)):
            if only(TreatmentStarted, game.act(nearer(game), Action.TRIAGE)):
                game.wait(game.settings.treat_red_ms)
        shifted = evaluated[0].lower_below, evaluated[0].raise_above
        assert shifted == thresholds(preset, sign)
        low, high = shifted
        assert low == pytest.approx(max(0.05, preset.lower_below + sign * SHIFT))
        assert high == pytest.approx(min(0.95, preset.raise_above + sign * SHIFT))


def test_knowledge_speaks_at_c1_to_somebody_who_asks_for_it_and_at_c3_again() -> None:
    game = Game(KNOWLEDGE[0], PRACTICE, FREE_PLAY)
    for _ in range(MOST_PREFERENCE):
        ask(game, "simpler")
    assert only(KnowledgeJudged, game.records)[-1].chosen is Level.C1
    for _ in range(2 * MOST_PREFERENCE):
        ask(game, "shorter")
    last = only(KnowledgeJudged, game.records)[-1]
    assert (last.chosen, last.why) == (Level.C3, "asked")


def test_asking_for_simpler_words_speaks_against_knowing_the_room() -> None:
    known = []
    for want in WISHES:
        game = Game(KNOWLEDGE[2], PRACTICE, FREE_PLAY)
        while game.coach.guidance.text[:5] != "Go to":
            ask(game, "shorter")
        ask(game, want)
        last = only(KnowledgeJudged, game.records)[-1]
        assert last.room is not None
        known.append(last.known[last.room])
    simpler, shorter = known
    assert simpler < shorter


@given(st.lists(st.sampled_from(WISHES), max_size=12))
def test_a_preference_is_bounded_and_taken_back_by_its_opposite(wishes: list[LevelWish]) -> None:
    preference = 0
    for want in wishes:
        before, preference = preference, preferring(preference, want)
        assert abs(preference) <= MOST_PREFERENCE
        assert (preference >= before) == (want == "simpler") or preference == before
        low, high = thresholds(FLOODFILL, preference)
        assert 0 < low < high < 1


def test_where_the_rules_do_not_allow_it_there_is_no_level_key() -> None:
    game = Game(STATIC[0], PRACTICE, replace(MissionSettings(), level_key=False))
    with pytest.raises(ValueError, match="not allowed"):
        game.run.ask_level("simpler", 0)
