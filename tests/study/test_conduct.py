"""A whole session without a screen, and what it records."""

from __future__ import annotations

from collections import Counter
from pathlib import Path

import pytest
from msgspec import structs

from game.coach.acts import CoachRecord, InstructionIssued, Level
from game.coach.knowledge.assumed import QuizMark
from game.forms.items import SliderItem
from game.journal.history import History, history_of, read_history
from game.journal.records import (
    Allocated,
    Consented,
    Debriefed,
    Declined,
    Exposed,
    FreeText,
    MissionAbandoned,
    MissionStarted,
    PhaseEnded,
    PhaseStarted,
    PracticeChecked,
    PreferenceGiven,
    QuestionnaireAnswer,
    QuizAnswer,
    QuizSubmitted,
    SessionEnded,
    SessionStarted,
)
from game.journal.sink import MemorySink
from game.session.verification import verify
from game.study.folder import Study
from game.study.ledger import SessionOutcome, SlotTaken, ending_of
from game.study.protocol.conduct import instructor, quiz_marks
from game.study.protocol.practice import LEGS
from game.world import load_building
from game.world.events import Acted
from tests.study.people import MISSION_MS, P01, journal_of, small_study, take_part
from tests.study.recorded import endings, records, step_of


def test_a_session_passes_every_phase_in_order_and_ends(finished: Study) -> None:
    entries = journal_of(finished).entries
    ended = [step_of(entry) for entry in entries if isinstance(entry.record, PhaseEnded)]
    assert ended == list(finished.course)
    assert set(endings(finished).values()) == {"completed"}
    assert entries[-1].record == SessionEnded("finished")
    assert history_of((entry.envelope, entry.record) for entry in entries).over
    ledger = finished.ledger.entries()
    assert ending_of(ledger, "P01", "pilot") == "finished"


def test_every_question_is_answered(finished: Study) -> None:
    asked = records(finished, QuestionnaireAnswer)
    count = Counter(answer.item for answer in asked)
    check, sliders, likert = finished.forms.forms
    assert [count[it.id] for it in (*sliders.questions, *likert.questions)] == [2] * 8
    assert [count[it.id] for it in check.questions] == [1] * 4
    assert [submitted.asked for submitted in records(finished, QuizSubmitted)] == [20, 20]
    assert [submitted.right for submitted in records(finished, QuizSubmitted)] == [10, 10]
    assert records(finished, PreferenceGiven)[0].preferred_round == 2
    assert records(finished, FreeText)[0].answer == "clearer"


def test_what_was_shown_is_in_the_journal(finished: Study) -> None:
    (consented,) = records(finished, Consented)
    assert finished.texts.consent.body.strip() in consented.text
    assert finished.texts.consent.agree in consented.text
    (started,) = records(finished, SessionStarted)
    assert started.study == finished.copy
    slider = finished.forms.questions["engagement"]
    assert isinstance(slider, SliderItem)
    shown = [a for a in records(finished, QuestionnaireAnswer) if a.item == slider.id]
    assert {(a.text, a.anchors) for a in shown} == {(slider.text, (slider.low, slider.high))}


def test_the_design_cell_is_carried_out(finished: Study) -> None:
    (allocated,) = records(finished, Allocated)
    (taken,) = (e for e in finished.ledger.entries() if isinstance(e, SlotTaken))
    assert allocated.memorise_ms == (5_000 if taken.cell.long_memorise else 3_000)
    begun = [
        entry.record
        for entry in journal_of(finished).entries
        if isinstance(entry.record, MissionStarted) and entry.envelope.phase == "mission"
    ]
    assert tuple(start.building for start in begun) == tuple(
        finished.building(name).name for name in allocated.buildings
    )
    specs = [instructor(allocated, number, finished.settings, {}) for number in (1, 2)]
    assert [start.coach for start in begun] == specs
    assert {spec.kind for spec in specs} == {"ana", "static"}
    assert specs[0].kind == ("ana" if taken.cell.adaptive_first else "static")
    memorised = [
        entry.record.exposure_ms
        for entry in journal_of(finished).entries
        if isinstance(entry.record, PhaseEnded) and entry.envelope.phase == "memorise"
    ]
    assert memorised == [allocated.memorise_ms] * 2


def test_only_the_coach_that_asks_for_the_quiz_is_given_it(finished: Study) -> None:
    (allocated,) = records(finished, Allocated)
    quizzes: list[dict[str, QuizMark]] = [{"Archive": "right"}, {"Archive": "blank"}]
    for coach in ("ana", "static", "pace", "knowledge", "knowledge+quiz"):
        settings = structs.replace(finished.settings, coach=coach)
        for round_ in (1, 2):
            specs = [instructor(allocated, round_, settings, quiz) for quiz in quizzes]
            if specs[0].kind == "knowledge+quiz":
                assert [spec.quiz for spec in specs] == quizzes
            else:
                assert specs[0] == specs[1]
    kinds = {instructor(allocated, round_, settings, {}).kind for round_ in (1, 2)}
    assert kinds == {"static", "knowledge+quiz"}


def test_a_label_is_right_wrong_or_left_blank() -> None:
    names = [room.name for room in load_building("practice").rooms]
    history = History()
    for room, label in ((names[0], names[0]), (names[1], names[2])):
        history.labels[2, room] = QuizAnswer(room, label, label == room, 0), 0
    marks = quiz_marks(history, load_building("practice"), 2)
    assert [marks[name] for name in names[:3]] == ["right", "wrong", "blank"]
    assert set(quiz_marks(history, load_building("practice"), 1).values()) == {"blank"}


def test_practice_shows_every_level_equally_and_never_adapts(finished: Study) -> None:
    entries = [e for e in journal_of(finished).entries if e.envelope.phase == "practice"]
    begun = [e.record for e in entries if isinstance(e.record, MissionStarted)]
    assert Counter(start.coach.level for start in begun) == dict.fromkeys(Level, 2)
    assert {start.coach.kind for start in begun} == {"static"}
    assert records(finished, PracticeChecked) == [PracticeChecked(right=2, asked=4)]


def test_a_slot_is_taken_after_practice(finished: Study) -> None:
    kinds = [type(entry.record) for entry in journal_of(finished).entries]
    assert kinds.index(Allocated) > kinds.index(PracticeChecked)
    before = [e for e in journal_of(finished).entries if isinstance(e.record, PhaseStarted)]
    first = next(e for e in before if e.envelope.phase == "memorise")
    assert kinds.index(Allocated) < first.envelope.seq


def test_timed_phases_record_their_exposure_every_second(finished: Study) -> None:
    for phase, limit_ms in (("memorise", 5_000), ("mission", MISSION_MS)):
        seen = [
            entry.record.exposure_ms
            for entry in journal_of(finished).entries
            if isinstance(entry.record, Exposed)
            and (entry.envelope.phase, entry.envelope.round) == (phase, 1)
        ]
        gaps = [later - earlier for earlier, later in zip([0, *seen], seen, strict=False)]
        assert gaps
        assert max(gaps) <= 1500
        assert limit_ms - seen[-1] <= 1500


def test_missions_of_the_journal_replay_to_the_same(finished: Study) -> None:
    transcript = journal_of(finished)
    history = read_history(transcript)
    assert len(history.missions) == 8
    assert not history.strays
    verdict = verify(finished.home(P01) / "journal.jsonl")
    assert verdict.difference is None


def test_two_sessions_of_one_participant_are_equal_and_every_page_is_complete(
    finished: Study, tmp_path: Path
) -> None:
    again = small_study(tmp_path / "again")
    _, person = take_part(again)
    assert not any("{" in page.title + page.body for page in person.read_pages)
    assert any("7 of them" in page.body for page in person.read_pages)
    assert [e.record for e in journal_of(again).entries][1:] == [
        e.record for e in journal_of(finished).entries
    ][1:]


def test_the_completion_code_is_easy_to_read(finished: Study) -> None:
    (debriefed,) = records(finished, Debriefed)
    assert len(debriefed.completion_code) == 8
    assert not set(debriefed.completion_code) & set("01OIS5lo")


def test_a_finished_session_shows_its_last_page_again(copy: Study) -> None:
    before = (copy.home(P01) / "journal.jsonl").read_bytes()
    outcome, person = take_part(copy)
    (code,) = (entry.completion_code for entry in records(copy, Debriefed))
    assert outcome == "over"
    assert len(person.read_pages) == 1
    assert code in person.read_pages[0].body
    assert (copy.home(P01) / "journal.jsonl").read_bytes() == before


def test_only_the_refusal_is_kept_of_people_who_decline(tmp_path: Path) -> None:
    study = small_study(tmp_path / "study")
    outcome, person = take_part(study, agrees=False)
    kept = [entry.record for entry in journal_of(study).entries]
    assert outcome == "over"
    assert person.read_pages == [study.texts.declined]
    assert [type(record) for record in kept] == [SessionStarted, Declined, SessionEnded]
    assert isinstance(kept[0], SessionStarted)
    assert kept[0].terminal is None
    assert not any(isinstance(entry, SlotTaken) for entry in study.ledger.entries())
    assert isinstance(study.ledger.entries()[-1], SessionOutcome)


def test_before_consent_nothing_is_written(tmp_path: Path) -> None:
    study = small_study(tmp_path / "study")

    def closed(what: str) -> None:
        if what == "agree":
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        take_part(study, moment=closed)
    assert not study.home(P01).exists()


@pytest.mark.parametrize("labels", [True, False])
def test_a_coach_knows_nothing_of_the_quiz(tmp_path: Path, finished: Study, labels: bool) -> None:
    """Nor about the memorise time, the order or the other round: it gets only the briefing."""
    study = small_study(
        tmp_path / "study", memorise_seconds="[1, 2]" if labels else "[3, 5]", label_seconds="9"
    )
    take_part(study, labels=labels)

    def told(which: Study) -> list[object]:
        return [
            entry.record
            for entry in journal_of(which).entries
            if isinstance(entry.record, CoachRecord | Acted) and entry.envelope.phase == "mission"
        ]

    assert any(isinstance(record, InstructionIssued) for record in told(study))
    assert told(study) == told(finished)


def test_a_leg_of_practice_ends_as_done(finished: Study) -> None:
    left = records(finished, MissionAbandoned)
    assert [record.reason for record in left] == ["leg_done"] * LEGS


def test_a_simulated_session_has_the_same_form(tmp_path: Path, finished: Study) -> None:
    study = small_study(tmp_path / "study")
    take_part(study, sink=MemorySink)
    assert [e.record for e in journal_of(study).entries][1:] == [
        e.record for e in journal_of(finished).entries
    ][1:]
