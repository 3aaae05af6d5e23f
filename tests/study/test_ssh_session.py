"""One participant does the whole study over SSH, using only keys, and is cut off in mid-mission.

The journal must then hold what was pressed and answered, and nothing else.
"""

from __future__ import annotations

import signal
import subprocess
import time
from dataclasses import dataclass
from typing import TypeVar

import pytest

from game.journal.folders import JOURNAL
from game.journal.history import Step
from game.journal.reader import Entry
from game.journal.records import (
    ROUNDS,
    Allocated,
    Consented,
    Debriefed,
    FreeText,
    Interruption,
    MissionAbandoned,
    MissionStarted,
    PhaseEnded,
    PhaseStarted,
    PracticeChecked,
    PreferenceGiven,
    Preflighted,
    QuestionnaireAnswer,
    QuizAnswer,
    QuizSubmitted,
    Resumed,
    SessionEnded,
    TakenOver,
)
from game.study.folder import Identity, Study
from game.study.ledger import SlotTaken, ending_of
from game.study.lock import SessionBusy, SessionLock
from game.study.protocol.practice import LEGS, practice_legs
from game.study.protocol.study_session import session_seed
from game.world.events import Acted, Action, MissionEnded, Rescued
from tests.study.participant import PATIENCE_S, TerminalParticipant
from tests.study.people import journal_of, small_study
from tests.study.server import ANA, BY_KEY, SSH, SSHD, Server, login

Kind = TypeVar("Kind")

pytestmark = [
    pytest.mark.long,
    pytest.mark.skipif(
        SSHD is None or SSH is None, reason="OpenSSH's server or client is not installed"
    ),
]
P01 = Identity("live", "P01")
QUICK = {
    "memorise_seconds": "[1, 2]",
    "label_seconds": "60",
    "duration_ms": "4000",
    "moves_per_second": "100",
    "treat_red_ms": "200",
    "treat_blue_ms": "100",
}
CHECK = (1, 2, 3, 3)
"""Answers to the practice check, the third of them wrong."""
SLIDERS = (
    {"engagement": 81, "confidence": 100, "frustration": 7, "confusion": 42},
    {"engagement": 1, "confidence": 50, "frustration": 93, "confusion": 68},
)
STATEMENTS = (
    {"pref1": 5, "pref2": 4, "pref3": 3, "pref4": 1},
    {"pref1": 2, "pref2": 2, "pref3": 1, "pref4": 5},
)
REASON = "It was clearer where to go"


@dataclass(frozen=True)
class TakenPart:
    """What P01 did: for each round, the names given to rooms and the keys of the mission."""

    labels: tuple[dict[str, str], dict[str, str]]
    pressed: tuple[list[Action], list[Action]]
    code: str
    slots_during_practice: int
    entries: tuple[Entry, ...]

    def of(self, kind: type[Kind], *steps: Step) -> list[Kind]:
        """The records of a kind, in these steps or in all."""
        return [
            entry.record
            for entry in self.entries
            if isinstance(entry.record, kind)
            and (not steps or Step(entry.envelope.phase, entry.envelope.round) in steps)
        ]


def slots(study: Study, participant: str) -> list[SlotTaken]:
    return [
        entry
        for entry in study.ledger.entries()
        if isinstance(entry, SlotTaken) and entry.participant == participant
    ]


@pytest.fixture(scope="module")
def study(tmp_path_factory: pytest.TempPathFactory) -> Study:
    return small_study(tmp_path_factory.mktemp("session") / "study", **QUICK)


@pytest.fixture(scope="module")
def taken_part(study: Study, tmp_path_factory: pytest.TempPathFactory) -> TakenPart:
    keys = tmp_path_factory.mktemp("server") / "keys"
    with Server(study.folder, keys, {"p01": BY_KEY.format("P01")}) as server:
        return take_part(server, study)


def until_free(study: Study) -> None:
    """Wait until the program behind the dropped connection has left the session."""
    until = time.monotonic() + PATIENCE_S
    while True:
        try:
            SessionLock(study.home(P01)).release()
        except SessionBusy:
            if time.monotonic() > until:
                raise
            time.sleep(0.05)
        else:
            return


def take_part(server: Server, study: Study) -> TakenPart:
    """From login to the last page, with a dropped connection and a second login in between."""
    with login(server, "p01") as terminal:
        person = TerminalParticipant(terminal, study, P01)
        person.preflight()
        person.consent()
        person.practise()
        slots_during_practice = len(slots(study, "P01"))
        person.answer_check(CHECK)
        person.memorise()
        first_labels = person.label(1, right=3, wrong=1)
        person.begin_mission()
        person.walk(lambda now: now.exposure_ms >= 1_000)
        first_pressed = person.pressed
        terminal.kill(signal.SIGKILL)
        terminal.wait()
    until_free(study)
    with login(server, "p01") as terminal:
        person = TerminalParticipant(terminal, study, P01)
        terminal.wait_for("The mission was interrupted")
        person.slide(SLIDERS[0])
        person.rate(STATEMENTS[0])
        person.memorise()
        second_labels = person.label(2, right=2, wrong=2)
        person.begin_mission()
        person.walk()
        person.slide(SLIDERS[1])
        person.rate(STATEMENTS[1])
        person.prefer(2)
        person.explain(REASON)
        code = person.leave()
    return TakenPart(
        (first_labels, second_labels),
        (first_pressed, person.pressed),
        code,
        slots_during_practice,
        journal_of(study, P01).entries,
    )


def test_each_phase_happened_once_and_the_interrupted_mission_ended(
    taken_part: TakenPart, study: Study
) -> None:
    ended = [
        (Step(entry.envelope.phase, entry.envelope.round), entry.record.ending)
        for entry in taken_part.entries
        if isinstance(entry.record, PhaseEnded)
    ]
    cut = Step("mission", 1)
    assert ended == [(step, "interrupted" if step == cut else "completed") for step in study.course]


def test_the_interruption_is_recorded_and_the_session_continues_after_it(
    taken_part: TakenPart, study: Study
) -> None:
    hang_up = Interruption("hang_up", signal="SIGHUP")
    assert hang_up in taken_part.of(Interruption, Step("mission", 1))
    (mission,) = taken_part.of(PhaseEnded, Step("mission", 1))
    assert 1_000 <= mission.exposure_ms < study.settings.mission.duration_ms
    back = [entry for entry in taken_part.entries if entry.envelope.segment == 1]
    assert isinstance(back[0].record, Resumed)
    went_on = next(entry for entry in back if isinstance(entry.record, PhaseStarted))
    assert (went_on.envelope.phase, went_on.envelope.round) == ("sliders", 1)
    assert len(taken_part.of(Resumed)) == 1
    assert not taken_part.of(TakenOver)


def test_preflight_and_consent_are_recorded(taken_part: TakenPart, study: Study) -> None:
    (preflight,) = taken_part.of(Preflighted)
    assert (preflight.terminal.columns, preflight.terminal.rows) == (120, 40)
    assert preflight.keys_work
    assert preflight.enough
    (consented,) = taken_part.of(Consented)
    assert consented.of_age
    assert study.texts.consent.body.strip() in consented.text


def test_every_leg_of_practice_was_walked_to_its_end(taken_part: TakenPart, study: Study) -> None:
    practice = Step("practice")
    planned = practice_legs(study.practice, session_seed(study, P01))
    assert [leg.coach for leg in taken_part.of(MissionStarted, practice)] == [
        leg.spec for leg in planned
    ]
    assert [leg.reason for leg in taken_part.of(MissionAbandoned, practice)] == ["leg_done"] * LEGS
    assert len(taken_part.of(Rescued, practice)) == LEGS


def test_the_check_is_scored_and_only_then_is_a_slot_taken(
    taken_part: TakenPart, study: Study
) -> None:
    assert taken_part.of(PracticeChecked) == [PracticeChecked(right=3, asked=4)]
    assert taken_part.slots_during_practice == 0
    (slot,) = slots(study, "P01")
    (allocated,) = taken_part.of(Allocated)
    assert allocated.slot == slot.slot
    kinds = [type(entry.record) for entry in taken_part.entries]
    assert kinds.index(PracticeChecked) < kinds.index(Allocated)


def test_the_map_was_shown_in_full_and_the_labels_are_those_given(taken_part: TakenPart) -> None:
    (allocated,) = taken_part.of(Allocated)
    for round_, given, right in zip(ROUNDS, taken_part.labels, (3, 2), strict=True):
        (shown,) = taken_part.of(PhaseEnded, Step("memorise", round_))
        assert shown.exposure_ms == allocated.memorise_ms
        answers = taken_part.of(QuizAnswer, Step("label", round_))
        assert {answer.room: answer.answer for answer in answers} == given
        assert [answer.correct for answer in answers] == [True] * right + [False] * (4 - right)
        (submitted,) = taken_part.of(QuizSubmitted, Step("label", round_))
        assert submitted.right == right


def test_each_key_of_a_mission_is_one_action(taken_part: TakenPart) -> None:
    for round_, pressed in zip(ROUNDS, taken_part.pressed, strict=True):
        actions = [acted.action for acted in taken_part.of(Acted, Step("mission", round_))]
        if round_ == ROUNDS[-1]:
            assert len(pressed) - len(actions) in (0, 1), "the end may overtake the last key"
        else:
            assert len(pressed) == len(actions)
        assert actions
        assert actions == pressed[: len(actions)]
    (ended,) = taken_part.of(MissionEnded)
    assert ended.rescued == len(taken_part.of(Rescued, Step("mission", 2))) > 0


def test_the_ratings_are_those_given(taken_part: TakenPart) -> None:
    for round_, sliders, statements in zip(ROUNDS, SLIDERS, STATEMENTS, strict=True):
        answers = taken_part.of(QuestionnaireAnswer, Step("sliders", round_))
        assert {answer.item: answer.value for answer in answers} == sliders
        answers = taken_part.of(QuestionnaireAnswer, Step("likert", round_))
        assert {answer.item: answer.value for answer in answers} == statements
    assert [given.preferred_round for given in taken_part.of(PreferenceGiven)] == [2]
    assert [given.answer for given in taken_part.of(FreeText)] == [REASON]


def test_the_session_is_finished_and_its_journal_holds(taken_part: TakenPart, study: Study) -> None:
    assert [debriefed.completion_code for debriefed in taken_part.of(Debriefed)] == [
        taken_part.code
    ]
    assert [ended.reason for ended in taken_part.of(SessionEnded)] == ["finished"]
    assert ending_of(study.ledger.entries(), "P01", "live") == "finished"
    verified = subprocess.run(
        [ANA, "verify", study.home(P01) / JOURNAL], capture_output=True, text=True, check=False
    )
    assert verified.returncode == 0, verified.stdout
    assert f"{LEGS + len(ROUNDS)} missions" in verified.stdout
