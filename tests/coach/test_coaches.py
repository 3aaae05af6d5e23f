from __future__ import annotations

from collections.abc import Sequence
from dataclasses import fields
from inspect import signature
from itertools import pairwise
from typing import TypeVar

import msgspec
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from game.coach.api import Briefing
from game.coach.coaches import PaceCoach, StaticCoach
from game.coach.guide import ALL_SAFE, NOBODY_IN_TIME
from game.coach.instructions.corrections import WRONG_WAY
from game.coach.records import (
    BeliefChanged,
    Disobeyed,
    GoalSet,
    InstructionCompleted,
    InstructionIssued,
    Level,
    LevelChanged,
    Misstep,
    NothingLeft,
    PaceLearned,
    PosteriorEvaluated,
)
from game.coach.spec import CoachSpec, build_coach, parse_coach
from game.errors import AnaError
from game.rescuers.driver import drive
from game.rescuers.literal import LiteralReader
from game.session.run import MissionRun, RunRecord
from game.world import load_building
from game.world.building import Building
from game.world.events import Action, Expired, Rescued, TreatmentStarted
from game.world.floodfill import cost_to_go
from game.world.mission import COMPASS_ACTIONS, Mission
from game.world.reading import parse_building
from game.world.settings import Controls, MissionSettings

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

PRACTICE = load_building("practice")

STATIC = tuple(CoachSpec("static", level=level) for level in Level)
ADAPTIVE = tuple(CoachSpec("ana", preset=p) for p in ("calibrated", "literal", "fig10", "released"))
PACE = CoachSpec("pace", level=Level.C2)
EVERY = (*STATIC, *ADAPTIVE, PACE)

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


# --- the bar -----------------------------------------------------------------------------------


def test_the_first_instruction_is_there_before_anything_happens() -> None:
    game = Game(STATIC[0])
    assert [type(record) for record in game.records] == [BeliefChanged, GoalSet, InstructionIssued]
    issued = game.records[-1]
    assert isinstance(issued, InstructionIssued)
    assert game.coach.guidance.text == issued.text
    assert (issued.number, issued.reason, issued.notice) == (1, "goal", "")


def test_at_each_level_the_bar_speaks_of_the_same_goal_in_other_words() -> None:
    games = [Game(spec, PRACTICE) for spec in STATIC]
    assert len({game.coach.guidance.text for game in games}) == len(Level)
    assert len({only(GoalSet, game.records)[0].goal for game in games}) == 1


def test_while_the_rescuer_is_on_the_way_the_text_stays() -> None:
    game = Game(STATIC[0])
    text = game.coach.guidance.text
    assert not only(InstructionIssued, game.act(E, N, N))
    assert game.coach.guidance.text == text


def test_the_text_stays_through_the_treatment_and_then_the_next_goal_is_there_at_once() -> None:
    game = Game(STATIC[0])
    text = game.coach.guidance.text
    started = game.act(E, N, N, T)
    assert [record.number for record in only(InstructionCompleted, started)] == [1]
    assert game.coach.guidance.text == text
    after = game.wait(3_000)
    rescued = only(Rescued, after)[0]
    goal, issued = only(GoalSet, after)[0], only(InstructionIssued, after)[0]
    assert rescued.at_ms == goal.at_ms == issued.at_ms
    assert (goal.reason, issued.reason) == ("rescued", "goal")
    assert game.coach.guidance.text == issued.text


def test_a_treatment_broken_off_brings_the_instruction_back_from_there() -> None:
    game = Game(STATIC[0])
    game.act(E, N, N, T)
    resumed = only(InstructionIssued, game.act(E))
    assert [record.reason for record in resumed] == ["resumed"]
    assert resumed[0].position == game.mission.position
    settle(game)
    assert game.mission.rescued == 1


def test_a_bump_that_turns_the_rescuer_gets_words_for_the_new_heading() -> None:
    game = Game(STATIC[0])
    issued = only(InstructionIssued, game.act(S))
    assert [record.reason for record in issued] == ["off_path"]
    assert issued[0].text.startswith("Turn left. Walk forward 1 step.")
    assert not only(Misstep, game.records)


def test_words_at_c2_are_for_a_heading_until_the_victim_is_found() -> None:
    game = Game(STATIC[1], GALLERY)
    first = only(InstructionIssued, game.records)[0]
    assert (first.shown_level, first.treats) == (Level.C2, True)
    assert [record.reason for record in only(InstructionIssued, game.act(N))] == ["off_path"]
    game.act(*[E] * 19)
    assert not only(InstructionIssued, game.act(N, S))


def test_the_next_words_know_who_is_rescued() -> None:
    game = Game(STATIC[0])
    settle(game, E, N, N)
    assert game.coach.guidance.text == "Stop. Utilize medical equipment."
    settle(game)
    assert game.mission.rescued == 2


# --- missteps and disobedience -------------------------------------------------------------------


def test_a_misstep_is_corrected_from_where_the_rescuer_stands() -> None:
    game = Game(STATIC[0])
    happened = game.act(W)
    misstep, issued = only(Misstep, happened)[0], only(InstructionIssued, happened)[0]
    assert (misstep.number, misstep.excess, misstep.level) == (1, 1, Level.C1)
    assert (issued.number, issued.reason, issued.notice) == (2, "misstep", WRONG_WAY)
    assert game.coach.guidance.notice == WRONG_WAY
    assert issued.text.startswith("Turn around. Walk forward 2 steps.")
    assert not only(Disobeyed, happened)


def test_a_few_steps_astray_at_c2_are_left_alone() -> None:
    game = Game(STATIC[1], PRACTICE)
    assert not only(InstructionIssued, game.act(_away(game)))


def test_a_misstep_always_has_a_correction() -> None:
    game = Game(STATIC[2], GALLERY)
    happened = game.act(*[E] * 9, *[W] * 8)
    assert only(Misstep, happened)[0].excess == 8
    assert [record.notice for record in only(InstructionIssued, happened)] == [WRONG_WAY]


def test_whoever_strays_to_another_victim_is_led_there() -> None:
    game = Game(STATIC[2])
    assert only(GoalSet, game.records)[0].goal == "v02"
    happened = game.act(*[E] * 6, N, N, *[E] * 2)
    assert only(Misstep, happened)
    assert [(record.goal, record.reason) for record in only(GoalSet, happened)] == [
        ("v03", "strayed")
    ]
    assert only(InstructionIssued, happened)[-1].goal == "v03"


def test_a_correction_leaves_the_bar_once_it_is_heeded() -> None:
    game = Game(STATIC[2])
    game.act(*[E] * 12, *[W] * 12)
    game.wait(1)
    assert only(Misstep, game.records)
    assert game.coach.guidance.notice == ""


def test_a_misstep_again_long_after_the_correction_is_disobedience() -> None:
    game = Game(STATIC[0])
    game.act(W)
    game.wait(5_000)
    assert [record.kind for record in only(Disobeyed, game.act(E, E, E))] == ["repeat_misstep"]


def test_an_instruction_completed_between_two_missteps_forgives_the_first() -> None:
    game, reader = Game(STATIC[0], PRACTICE), LiteralReader("compass")
    game.act(_away(game))
    game.wait(5_000)
    while not only(InstructionCompleted, game.records):
        action = reader.decide(game.run.observation())
        assert action is not None
        game.act(action)
    game.wait(7_000)
    game.act(_away(game))
    assert len(only(Misstep, game.records)) == 2
    assert not only(Disobeyed, game.records)


def test_a_victim_treated_instead_counts_once() -> None:
    game = Game(STATIC[0], settings=MissionSettings(red_expiry_ms=12_000))
    happened = game.act(E, N, N, T, S, N, T)
    assert len(only(TreatmentStarted, happened)) == 2
    assert [r.kind for r in only(Disobeyed, happened)].count("other_victim") == 1


def test_treating_another_victim_is_disobedience_and_the_route_is_planned_anew() -> None:
    game = Game(STATIC[0], settings=MissionSettings(red_expiry_ms=12_000))
    goal = only(GoalSet, game.records)[0].goal
    assert goal == "v03"
    happened = settle(game, E, N, N)
    assert [record.kind for record in only(Disobeyed, happened)] == ["other_victim"]
    assert only(TreatmentStarted, happened)[0].victim != goal
    assert only(GoalSet, happened)[-1].reason == "other_rescued"


def test_a_victim_that_fits_the_words_as_well_is_adopted() -> None:
    game = Game(STATIC[2])
    goal = only(GoalSet, game.records)[0].goal
    happened = settle(game, E, N, N, *[W] * 2 if goal == "v02" else [E] * 2)
    treated = only(TreatmentStarted, happened)[0].victim
    assert treated != goal
    assert not only(Disobeyed, happened)
    assert len(only(InstructionCompleted, happened)) == 1
    assert only(GoalSet, happened)[0].reason == "rescued"


# --- goals that end otherwise --------------------------------------------------------------------


def test_when_all_are_rescued_the_bar_says_so_and_the_coach_rests() -> None:
    for spec in (STATIC[0], *ADAPTIVE, PACE):
        game = Game(spec)
        settle(game, E, N, N)
        settle(game, W)
        happened = settle(game, E, S, S, *[E] * 5, N, N, *[E] * 3)
        assert game.mission.rescued == 3
        assert [record.notice for record in only(NothingLeft, happened)] == [ALL_SAFE]
        guidance = game.coach.guidance
        assert (guidance.text, guidance.notice) == ("", ALL_SAFE)
        later = game.act(W, E, N, T) + game.wait(60_000)
        assert not only(PosteriorEvaluated, later)
        assert not only(InstructionIssued, later)
        assert game.coach.guidance == guidance


def test_a_red_goal_that_cannot_be_treated_in_time_is_given_up_at_once() -> None:
    game = Game(STATIC[1], settings=MissionSettings(red_expiry_ms=12_000))
    assert only(GoalSet, game.records)[0].goal == "v03"
    game.wait(7_000)
    goals = only(GoalSet, game.act(W))
    assert [record.reason for record in goals] == ["too_late"]
    assert goals[0].goal != "v03"
    expired = game.wait(8_000)
    assert only(Expired, expired)
    assert not only(GoalSet, expired)


def test_a_goal_that_expires_is_followed_by_another() -> None:
    game = Game(STATIC[1], settings=MissionSettings(red_expiry_ms=12_000))
    happened = game.wait(12_000)
    assert [record.reason for record in only(GoalSet, happened)] == ["expired"]


def test_a_goal_that_expires_during_another_treatment_gives_way_to_it() -> None:
    game = Game(STATIC[0], settings=MissionSettings(red_expiry_ms=12_000, treat_blue_ms=20_000))
    assert only(GoalSet, game.records)[0].goal == "v03"
    game.act(E, N, N, T)
    happened = game.wait(12_000)
    treated = only(TreatmentStarted, game.records)[0].victim
    assert [(g.goal, g.reason) for g in only(GoalSet, happened)] == [(treated, "expired")]
    assert isinstance(happened[-1], InstructionCompleted)
    assert only(GoalSet, game.wait(10_000))[0].reason == "rescued"
    game.act(T)
    game.wait(21_000)
    assert game.mission.rescued == 2
    assert game.coach.guidance.notice == NOBODY_IN_TIME


def test_when_nobody_can_be_reached_the_bar_says_so() -> None:
    alone = parse_building(BOX.text.replace(".o.o.", ".....").replace("o = blue victim\n", ""))
    game = Game(STATIC[1], alone, MissionSettings(red_expiry_ms=5_000))
    assert game.coach.guidance.notice == NOBODY_IN_TIME
    assert [type(record) for record in game.records] == [BeliefChanged, NothingLeft]
    game.wait(6_000)
    assert game.coach.guidance.notice == NOBODY_IN_TIME


def test_a_blue_victim_is_led_to_even_when_time_is_short() -> None:
    game = Game(STATIC[1], settings=MissionSettings(duration_ms=2_000, red_expiry_ms=1_000))
    assert only(GoalSet, game.records)[0].goal in ("v01", "v02")


# --- the coaches apart ---------------------------------------------------------------------------


def test_the_static_coach_keeps_its_level_and_evaluates_nothing() -> None:
    for spec in STATIC:
        game = Game(spec)
        assert game.coach.next_evaluation_ms is None
        game.act(*[W, E] * 20)
        assert {record.level for record in only(InstructionIssued, game.records)} == {spec.level}
        assert not only(LevelChanged, game.records)
        assert not only(PosteriorEvaluated, game.records)


def test_ana_lowers_the_level_of_someone_who_walks_away_and_says_it_anew_at_once() -> None:
    game = Game(ADAPTIVE[0], PRACTICE)
    happened = [record for _ in range(40) for record in game.act(_away(game))]
    changed = only(LevelChanged, happened)
    assert (changed[0].before, changed[0].after) == (Level.C2, Level.C1)
    position = happened.index(changed[0])
    issued = happened[position + 1]
    assert isinstance(issued, InstructionIssued)
    assert (issued.level, issued.reason) == (Level.C1, "level")
    evaluation = happened[position - 1]
    assert isinstance(evaluation, PosteriorEvaluated)
    assert evaluation.verdict == "lower"
    assert evaluation.comprehension == changed[0].comprehension < evaluation.lower_below


def test_a_level_rises_with_a_rescue_and_not_with_a_goal_that_is_lost() -> None:
    game, reader = Game(ADAPTIVE[0], PRACTICE), LiteralReader("compass")
    while not only(Rescued, game.records):
        action = reader.decide(game.run.observation())
        game.wait(500) if action is None else game.act(action)
    rescued = only(Rescued, game.records)[0]
    changed = only(LevelChanged, game.records)
    assert [(record.at_ms, record.after) for record in changed] == [(rescued.at_ms, Level.C3)]

    lost = Game(ADAPTIVE[0], PRACTICE, MissionSettings(red_expiry_ms=20_000))
    for _ in range(12):
        lost.act(_nearer(lost))
    happened = lost.wait(20_000)
    assert "raise" in {record.verdict for record in only(PosteriorEvaluated, happened)}
    assert [record.reason for record in only(GoalSet, happened)] == ["expired"]
    assert not only(LevelChanged, happened)


def _away(game: Game) -> Action:
    """The step that leads farthest from the goal."""
    return max(_steps(game))[1]


def _nearer(game: Game) -> Action:
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


def test_each_preset_evaluates_on_its_own_occasions() -> None:
    when = {}
    for spec in ADAPTIVE:
        game = Game(spec, PRACTICE)
        drive(game.run, LiteralReader("compass", {r.name: r.label for r in PRACTICE.rooms}))
        when[spec.preset] = only(PosteriorEvaluated, game.records)
        if spec.preset == "literal":
            ended = [
                record.at_ms
                for record in game.records
                if isinstance(record, InstructionCompleted | Misstep)
            ]
            assert [record.at_ms for record in when["literal"]] == ended
    assert {record.at_ms % 3_000 for record in when["calibrated"]} == {0}
    assert {record.at_ms % 5_000 for record in when["fig10"]} == {0}
    assert len(when["released"]) > 100


def test_released_begins_every_leg_after_a_rescue_at_c2() -> None:
    game = Game(ADAPTIVE[3], PRACTICE)
    drive(game.run, LiteralReader("compass", {r.name: r.label for r in PRACTICE.rooms}))
    goals = [r.at_ms for r in only(GoalSet, game.records) if r.reason == "rescued"]
    firsts = [r for r in only(InstructionIssued, game.records) if r.reason == "goal"]
    assert len(goals) > 3
    assert {r.level for r in firsts if r.at_ms in goals} == {Level.C2}


def test_the_pace_coach_learns_how_fast_the_rescuer_walks_and_plans_by_it() -> None:
    game = Game(PACE)
    coach = game.coach
    assert isinstance(coach, PaceCoach)
    assert coach.ms_per_move == game.settings.pace_ms
    for action in [E, W] * 15:
        game.act(action)
        game.wait(800)
    settle(game, E, N, N)
    learned = only(PaceLearned, game.records)
    assert [record.ms_per_move for record in learned] == [1_000.0]
    assert coach.ms_per_move == 1_000


def test_a_slow_rescuer_is_led_another_way_by_the_pace_coach() -> None:
    routes = []
    for spec in (PACE, STATIC[1]):
        game, reader = Game(spec, load_building("harbour")), LiteralReader("compass")
        while not game.run.ended:
            action = reader.decide(game.run.observation())
            if action is not None:
                game.act(action)
            game.wait(300)
        routes.append([record.route for record in only(GoalSet, game.records)])
    assert routes[0][0] == routes[1][0]
    assert routes[0] != routes[1]


# --- every coach, whatever happens ---------------------------------------------------------------


@settings(max_examples=60)
@given(
    st.sampled_from(EVERY),
    st.sampled_from(["compass", "turn"]),
    st.sampled_from([BOX, PRACTICE]),
    st.lists(st.tuples(st.integers(0, 7), st.integers(0, 1_500)), max_size=120),
)
def test_whatever_the_rescuer_does_the_bar_and_the_records_agree(
    spec: CoachSpec,
    controls: Controls,
    building: Building,
    keys: list[tuple[int, int]],
) -> None:
    first, again = (_played(spec, controls, building, keys) for _ in range(2))
    assert first.records == again.records
    _check(first, spec)


def _played(
    spec: CoachSpec, controls: Controls, building: Building, keys: list[tuple[int, int]]
) -> Game:
    compass = (N, E, S, W, N, E, S, T)
    turning = (Action.FORWARD,) * 4 + (Action.TURN_LEFT, Action.TURN_RIGHT, Action.FORWARD, T)
    chosen = MissionSettings(controls=controls, red_expiry_ms=30_000, duration_ms=60_000)
    game = Game(spec, building, chosen)
    for key, pause_ms in keys:
        game.act((compass if controls == "compass" else turning)[key])
        game.wait(pause_ms)
    game.wait(60_000)
    return game


def _check(game: Game, spec: CoachSpec) -> None:
    """The laws of a coach's records."""
    goal, number, completed, level = "", 0, True, spec.level or Level.C2
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


@pytest.mark.parametrize("name", ["foundry", "harbour"])
@pytest.mark.parametrize("spec", STATIC[:2], ids=["C1", "C2"])
def test_a_literal_follower_saves_nearly_everybody_without_a_misstep(
    name: str, spec: CoachSpec
) -> None:
    game = Game(spec, load_building(name))
    drive(game.run, LiteralReader("compass"))
    assert game.mission.rescued in (18, 19)
    assert not only(Misstep, game.records)
    assert not [r for r in only(InstructionIssued, game.records) if r.reason == "off_path"]
    _check(game, spec)


@pytest.mark.slow
@pytest.mark.parametrize("controls", ["compass", "turn"])
@pytest.mark.parametrize("name", ["foundry", "harbour", "practice"])
@pytest.mark.parametrize("spec", EVERY, ids=lambda spec: str(spec.preset or spec.level))
def test_nobody_gets_stuck(name: str, spec: CoachSpec, controls: Controls) -> None:
    building = load_building(name)
    game = Game(spec, building, MissionSettings(controls=controls))
    drive(game.run, LiteralReader(controls, {room.name: room.label for room in building.rooms}))
    assert game.mission.rescued >= min(16, len(building.victims))
    assert not only(Disobeyed, game.records)
    _check(game, spec)


# --- what a coach is, and is not told ------------------------------------------------------------


def test_a_coach_is_built_from_the_mission_alone() -> None:
    assert [field.name for field in fields(Briefing)] == ["building", "settings", "seed"]
    assert list(signature(build_coach).parameters) == ["spec", "briefing"]


def test_the_coach_says_the_same_to_everybody_who_does_the_same() -> None:
    """Another process of the same study, after any number of other missions."""
    Game(ADAPTIVE[1], PRACTICE).act(*[N] * 9)
    games = [Game(ADAPTIVE[0], PRACTICE) for _ in range(2)]
    for game in games:
        game.act(*[N] * 7, *[W] * 5)
    assert games[0].records == games[1].records


@pytest.mark.parametrize("spec", EVERY, ids=lambda spec: str(spec.preset or spec.kind))
def test_a_spec_survives_the_journal(spec: CoachSpec) -> None:
    assert msgspec.json.decode(msgspec.json.encode(spec), type=CoachSpec) == spec
    game = Game(spec)
    assert isinstance(game.coach, StaticCoach) == (spec.kind == "static")


@pytest.mark.parametrize(
    "text",
    [
        '{"kind": "ana", "preset": "calibrate"}',
        '{"kind": "ana", "preset": "literal", "level": 1}',
        '{"kind": "static"}',
        '{"kind": "static", "level": 4}',
        '{"kind": "pace", "level": 1, "preset": "literal"}',
    ],
)
def test_a_spec_that_makes_no_sense_is_not_read(text: str) -> None:
    with pytest.raises(msgspec.ValidationError):
        msgspec.json.decode(text, type=CoachSpec)


def test_names_are_parsed_with_the_usual_choices() -> None:
    assert parse_coach("ana") == ADAPTIVE[0]
    assert parse_coach("ana", preset="fig10") == ADAPTIVE[2]
    assert parse_coach("static", 3) == STATIC[2]
    assert parse_coach("pace") == PACE


@pytest.mark.parametrize(
    ("arguments", "mend"),
    [
        (("sttic",), "Did you mean static?"),
        (("ana", None, "calibratd"), "Did you mean calibrated?"),
        (("static", 4), "Give 1, 2 or 3."),
        (("ana", 2), "Leave --level out"),
        (("pace", 2, "literal"), "Leave --preset out"),
    ],
)
def test_a_wrong_name_is_met_by_the_right_one(
    arguments: tuple[str, int | None, str | None], mend: str
) -> None:
    with pytest.raises(AnaError, match=mend.replace("?", r"\?")):
        parse_coach(*arguments)
