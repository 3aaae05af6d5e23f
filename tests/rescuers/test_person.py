"""The bounded person: what they know, how they read and press, and that they see no more than a
screen shows."""

from __future__ import annotations

from dataclasses import replace
from random import Random
from statistics import mean

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from game.coach.acts import CoachRecord, Disobeyed
from game.coach.spec import CoachSpec, parse_coach
from game.errors import AnaError
from game.journal.records import RunRecord
from game.rescuers.catalogue import RESCUERS, character
from game.rescuers.driver import Wait, drive
from game.rescuers.literal.grammar import parse
from game.rescuers.person import POPULATIONS, BoundedPerson, MapMemory, Traits, drawn, memorised
from game.rescuers.person.experience import Experience, Style, style_of
from game.rescuers.person.hands import Hands
from game.rescuers.person.memory import nothing_memorised
from game.rescuers.person.quiz import labels
from game.rescuers.person.randomness import normal, stream
from game.rescuers.person.responses import Respondent, strain_of
from game.session.playing import assemble, start_in_memory
from game.session.run import MissionRun
from game.world import load_building
from game.world.building import Building
from game.world.events import Action, MissionEvent, Rescued
from game.world.mission import Mission
from game.world.observation import Guidance, Observation
from game.world.settings import Controls, MissionSettings

SETTINGS = MissionSettings()
HARBOUR, FOUNDRY, PRACTICE = map(load_building, ("harbour", "foundry", "practice"))
MINUTE_MS = 60_000
FLAWLESS = replace(
    Traits(), slip=0.0, mirror=0.0, miscount=0.0, miscount_unknowing=0.0, stray=0.0, fatigue=0.0
)


def all_known(building: Building) -> MapMemory:
    places = {room.label: room.name for room in building.rooms}
    return MapMemory(tuple(places), places, {})


def played(
    building: Building,
    spec: CoachSpec,
    memory: MapMemory,
    traits: Traits = FLAWLESS,
    seed: int = 1,
    rules: MissionSettings = SETTINGS,
) -> tuple[list[RunRecord], BoundedPerson]:
    person = BoundedPerson(traits, memory, rules.controls, stream(seed, "mission"))
    happened: list[RunRecord] = []
    run = assemble(building, rules, spec, seed, happened.extend)
    run.begin()
    drive(run, person)
    return happened, person


def rescues(happened: list[RunRecord]) -> int:
    return sum(isinstance(record, Rescued) for record in happened)


class SaysOnly:
    """A coach who says one thing, whatever happens."""

    next_evaluation_ms: int | None = None

    def __init__(self, text: str) -> None:
        self.guidance = Guidance(text)

    def begin(self, observation: Observation) -> list[CoachRecord]:
        return []

    def on_event(self, event: MissionEvent, observation: Observation) -> list[CoachRecord]:
        return []

    def evaluate(self, at_ms: int, observation: Observation) -> list[CoachRecord]:
        return []


Decided = tuple[Observation, Action | Wait | None]


def watched(building: Building, text: str) -> list[Decided]:
    """All that somebody without any knowledge saw and did who was told one thing for a minute."""
    rules = replace(SETTINGS, duration_ms=60_000)
    run = MissionRun(Mission(building, rules), SaysOnly(text), lambda _: None)
    person = BoundedPerson(FLAWLESS, nothing_memorised(building), "compass", Random(1))
    seen: list[Decided] = []

    class Watched:
        def decide(self, observation: Observation) -> Action | Wait | None:
            decided = person.decide(observation)
            seen.append((observation, decided))
            return decided

    run.begin()
    drive(run, Watched())
    return seen


# --- the mission --------------------------------------------------------------------------------


def test_the_same_person_plays_the_same_mission() -> None:
    spec, traits = parse_coach("ana"), drawn(POPULATIONS["hasty"], 1)

    def once(seed: int) -> list[RunRecord]:
        memory = memorised(HARBOUR, MINUTE_MS, traits, stream(1, "map"))
        return played(HARBOUR, spec, memory, traits, seed)[0]

    assert once(1) == once(1)
    assert once(1) != once(2)


@pytest.mark.parametrize("building", [HARBOUR, FOUNDRY], ids=lambda building: building.name)
def test_knowing_the_rooms_saves_people_at_c3(building: Building) -> None:
    spec = parse_coach("static", 3)
    knowing, unknowing = (
        mean(rescues(played(building, spec, know(building), seed=s)[0]) for s in range(3))
        for know in (all_known, nothing_memorised)
    )
    assert knowing >= 14
    assert unknowing <= knowing - 2


def test_who_knows_no_room_does_as_well_at_c1() -> None:
    spec = parse_coach("static", 1)
    knowing, unknowing = (
        rescues(played(HARBOUR, spec, know(HARBOUR))[0]) for know in (all_known, nothing_memorised)
    )
    assert unknowing == knowing >= 10


def test_what_cannot_be_seen_changes_nothing() -> None:
    """Elsewhere victims may lie anywhere: the keys are the same until one is seen."""
    near = HARBOUR.room_at(HARBOUR.start)
    moved = [
        site if HARBOUR.room_of(site) is near else replace(site, cell=room.cells[0])
        for site, room in zip(HARBOUR.victims, HARBOUR.rooms, strict=True)
    ]
    here, there = (
        watched(building, "Go to the Archive. Triage the red victim.")
        for building in (HARBOUR, replace(HARBOUR, victims=tuple(moved)))
    )
    same = 0
    while here[same][0] == there[same][0]:
        assert here[same][1] == there[same][1]
        same += 1
    assert same >= 20


@pytest.mark.parametrize("controls", ["compass", "turn"])
@pytest.mark.parametrize("level", [1, 2, 3])
def test_both_controls_and_all_levels_can_be_played(controls: Controls, level: int) -> None:
    rules = MissionSettings(controls=controls, duration_ms=120_000)
    traits = replace(FLAWLESS, slip=0.02, mirror=0.05)
    memory = all_known(PRACTICE)
    happened, _ = played(PRACTICE, parse_coach("static", level), memory, traits, rules=rules)
    assert rescues(happened) >= 4


@settings(max_examples=15)
@given(
    seed=st.integers(0, 10_000),
    population=st.sampled_from(list(POPULATIONS)),
    coach=st.sampled_from([("static", 1), ("static", 2), ("static", 3), ("ana", None)]),
    memorise_ms=st.integers(0, 3 * MINUTE_MS),
)
def test_whoever_plays_the_mission_ends(
    seed: int, population: str, coach: tuple[str, int | None], memorise_ms: int
) -> None:
    traits = drawn(POPULATIONS[population], seed)
    memory = memorised(PRACTICE, memorise_ms, traits, stream(seed, "map"))
    rules = replace(SETTINGS, duration_ms=60_000)
    happened, person = played(PRACTICE, parse_coach(*coach), memory, traits, seed, rules)
    assert person.experience.total_ms <= rules.duration_ms
    assert sum(person.experience.style_ms.values()) <= rules.duration_ms
    assert person.experience.rescued <= rescues(happened)


def test_nobody_presses_a_key_before_the_first_sentence_is_read() -> None:
    for text, words in (("Walk forward 2 steps. Stop.", 4), ("Exit by the nearest door.", 5)):
        first = next(
            observation.time_ms
            for observation, decided in watched(HARBOUR, text)
            if isinstance(decided, Action)
        )
        assert first >= FLAWLESS.reaction_ms + words * FLAWLESS.ms_per_word


def test_who_goes_their_own_way_disobeys() -> None:
    kinds = (FLAWLESS, replace(FLAWLESS, stray=0.5, trust=0.2))
    disobeyed = [
        sum(
            isinstance(record, Disobeyed)
            for record in played(FOUNDRY, parse_coach("static", 1), all_known(FOUNDRY), traits)[0]
        )
        for traits in kinds
    ]
    assert disobeyed[0] == 0
    assert disobeyed[1] >= 3


def test_miscounted_doors_lead_astray() -> None:
    astray = replace(FLAWLESS, miscount=0.7)
    corrections = [
        played(FOUNDRY, parse_coach("static", 2), all_known(FOUNDRY), traits)[
            1
        ].experience.corrections
        for traits in (FLAWLESS, astray)
    ]
    assert corrections[1] > corrections[0]


# --- hands --------------------------------------------------------------------------------------


def test_a_wrong_key_is_taken_back_and_then_the_right_one_pressed() -> None:
    mission = Mission(HARBOUR, SETTINGS)
    hands = Hands(FLAWLESS, "compass", Random(3))
    hands.mean(Action.NORTH)
    wrong = hands.press(mission.observation(), slips=1.0, slowness=1.0)
    assert wrong in (Action.WEST, Action.EAST)
    mission.step(wrong, 0)
    keys = []
    for now_ms in range(200, 3000, 200):
        mission.step(None, now_ms)
        hands.see(mission.observation(), reaction_ms=300)
        if hands.idle:
            break
        key = hands.press(mission.observation(), slips=0.0, slowness=1.0)
        if isinstance(key, Action):
            assert now_ms >= 300
            mission.step(key, now_ms)
            keys.append(key)
    assert keys == [Action.EAST if wrong is Action.WEST else Action.WEST, Action.NORTH]
    x, y = HARBOUR.start
    assert mission.position == (x, y - 1)


def test_another_key_takes_longer_than_the_same() -> None:
    hands = Hands(FLAWLESS, "compass", Random(1))
    now = Mission(HARBOUR, SETTINGS).observation()
    hands.mean(Action.NORTH)
    assert hands.press(now, 0.0, 1.0) is Action.NORTH
    hands.mean(Action.NORTH)
    assert hands.press(now, 0.0, 1.0) == Wait(round(FLAWLESS.step_ms))
    hands.let_go()
    hands.mean(Action.EAST)
    assert hands.press(now, 0.0, 2.0) == Wait(round(2 * FLAWLESS.key_change_ms))


# --- memory and quiz ----------------------------------------------------------------------------


@given(seed=st.integers(0, 10_000), short=st.integers(0, 200_000), more=st.integers(0, 200_000))
def test_looking_longer_never_means_knowing_less(seed: int, short: int, more: int) -> None:
    traits = replace(FLAWLESS, mix_up=0.0)
    less, rather = (
        memorised(HARBOUR, ms, traits, Random(seed)).names for ms in (short, short + more)
    )
    assert less.items() <= rather.items()
    assert rather.items() <= {room.label: room.name for room in HARBOUR.rooms}.items()


def test_memorise_times_spread_knowledge_widely() -> None:
    for minutes, low, high in ((1, 0.25, 0.45), (3, 0.6, 0.8)):
        shares = [
            memorised(
                HARBOUR, minutes * MINUTE_MS, drawn(POPULATIONS["default"], s), Random(s)
            ).knowledge
            for s in range(200)
        ]
        assert low < mean(shares) < high
        assert max(shares) - min(shares) > 0.4


@given(
    seen=st.lists(st.tuples(st.sampled_from(HARBOUR.rooms), st.sampled_from(HARBOUR.rooms))),
    seed=st.integers(0, 1000),
)
def test_a_name_belongs_to_one_place(seen: list[tuple[object, object]], seed: int) -> None:
    memory = memorised(HARBOUR, MINUTE_MS, Traits(), Random(seed))
    for at, named in seen:
        memory.learn(at.label, named.name)  # type: ignore[attr-defined]
        assert memory.place(named.name) == at.label  # type: ignore[attr-defined]
        assert len(set(memory.names.values())) == len(memory.names)


def test_the_search_goes_to_every_room_before_it_gives_up() -> None:
    memory = nothing_memorised(HARBOUR)
    tried: set[tuple[int, int]] = set()
    while True:
        guess = memory.next_guess(
            HARBOUR.terrain.floodfills, "Archive", HARBOUR.start, frozenset(tried)
        )
        if guess is None:
            break
        assert guess not in tried
        tried.add(guess)
    assert tried == {room.label for room in HARBOUR.rooms}


def test_a_hunch_draws_the_search() -> None:
    archive = HARBOUR.room("Archive").label
    memory = MapMemory(tuple(room.label for room in HARBOUR.rooms), {}, {"Archive": archive})
    assert (
        memory.next_guess(HARBOUR.terrain.floodfills, "Archive", HARBOUR.start, frozenset())
        == archive
    )


@given(seed=st.integers(0, 10_000), memorise_ms=st.integers(0, 180_000))
def test_the_quiz_shows_what_is_known(seed: int, memorise_ms: int) -> None:
    traits = drawn(POPULATIONS["default"], seed)
    memory = memorised(HARBOUR, memorise_ms, traits, Random(seed))
    names = [room.name for room in HARBOUR.rooms]
    given_names = labels(memory, traits, HARBOUR.rooms, names, Random(seed))
    assert len(set(given_names.values())) == len(given_names)
    assert memory.names.items() <= given_names.items()


# --- answers ------------------------------------------------------------------------------------


def a_mission(style: Style, knowledge: float, lost: float = 0.0) -> Experience:
    experience = Experience(knowledge)
    experience.style = style
    experience.passed(round(240_000 * lost), searching=True, puzzled=False)
    experience.passed(240_000, searching=False, puzzled=False)
    return experience


def answers(population: str, item: str, experience: Experience) -> list[int]:
    people = POPULATIONS[population]
    return [
        Respondent(people, drawn(people, seed), seed).slider(item, 1, experience)
        for seed in range(150)
    ]


def test_a_planted_effect_can_be_found_and_taken_out() -> None:
    bored, aligned = a_mission(1, 0.9), a_mission(1, 0.2)
    gap = mean(answers("default", "engagement", aligned)) - mean(
        answers("default", "engagement", bored)
    )
    assert 20 < gap < 40
    assert answers("indifferent", "engagement", aligned) == answers(
        "indifferent", "engagement", bored
    )


def test_being_lost_confuses_and_frustrates() -> None:
    for item in ("confusion", "frustration"):
        lost, found = (mean(answers("default", item, a_mission(3, 0.9, s))) for s in (0.6, 0.0))
        assert lost > found + 8


@given(
    seed=st.integers(0, 10_000),
    style=st.sampled_from([1, 2, 3]),
    knowledge=st.floats(0, 1),
    lost=st.floats(0, 1),
)
def test_answers_stay_on_their_scales(
    seed: int, style: Style, knowledge: float, lost: float
) -> None:
    people = POPULATIONS["default"]
    traits = drawn(people, seed)
    respondent, experience = Respondent(people, traits, seed), a_mission(style, knowledge, lost)
    slid = respondent.slider("confusion", 1, experience)
    assert 1 <= slid <= 100
    assert traits.coarseness < 2 / 3 or slid % 10 == 0 or slid == 1
    assert 1 <= respondent.scale("pref1", 1, experience, 5) <= 5
    assert respondent.preferred(experience, experience) in (1, 2)


def test_alignment_is_the_designs() -> None:
    """LOW is aligned with C1, MED with C2, HIGH with C3."""
    for style, knowledge in ((1, 0.2), (2, 0.55), (3, 0.9)):
        strain = strain_of(a_mission(style, knowledge))  # type: ignore[arg-type]
        assert strain.overload == strain.underload == pytest.approx(0)
    assert strain_of(a_mission(3, 0.2)).overload == pytest.approx(0.7)
    assert strain_of(a_mission(1, 0.9)).underload == pytest.approx(0.7)


@pytest.mark.parametrize(
    ("text", "style"),
    [
        ("Turn right. Walk forward 4 steps.", 1),
        ("Enter the third door on your left.", 2),
        ("Turn around. Proceed to the end of the hallway.", 2),
        ("Go to the Lobby. Triage the red victim.", 3),
        ("Turn left.", None),
    ],
)
def test_the_way_of_talking_is_told_from_the_words(text: str, style: Style | None) -> None:
    assert style_of(parse(text)) == style


# --- chance and catalogue -----------------------------------------------------------------------


def test_chance_has_the_spread_it_says() -> None:
    chance = stream(1, "test")
    draws = [normal(chance) for _ in range(4000)]
    assert abs(mean(draws)) < 0.06
    assert mean(draw**2 for draw in draws) == pytest.approx(1, abs=0.08)
    assert stream(1, "test").random() != stream(1, "other").random()


@pytest.mark.parametrize("name", list(RESCUERS))
def test_every_character_plays(name: str) -> None:
    rules = replace(SETTINGS, duration_ms=60_000)
    run, _ = start_in_memory(PRACTICE, rules, parse_coach("ana"), 3, rescuer=name)
    drive(run, character(name).make(PRACTICE, rules, 3))
    assert run.ended
    assert run.mission.rescued >= 1


def test_an_unknown_character_is_named_with_the_nearest() -> None:
    with pytest.raises(AnaError, match="Did you mean stranger"):
        character("strangr")


@pytest.mark.parametrize("controls", ["compass", "turn"])
def test_no_wrong_key_ends_a_mission_in_an_error(controls: Controls) -> None:
    rules = replace(SETTINGS, controls=controls)
    for seed in range(8):
        traits = replace(drawn(POPULATIONS["hasty"], seed), slip=0.25, stray=0.8)
        building = (HARBOUR, FOUNDRY, PRACTICE)[seed % 3]
        memory = memorised(building, MINUTE_MS, traits, stream(seed, "map"))
        for level in (2, 3):
            happened, _ = played(
                building, parse_coach("static", level), memory, traits, seed, rules
            )
            assert happened
