"""A whole session without a screen: what it records, and what happens if it is interrupted."""

from __future__ import annotations

from collections import Counter
from pathlib import Path
from typing import Any

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from msgspec import structs

from game.coach.acts import CoachRecord, InstructionIssued, Level
from game.coach.knowledge.assumed import QuizMark
from game.forms.items import SliderItem
from game.journal.history import History, Step, history_of, read_history
from game.journal.journal_error import JournalError
from game.journal.reader import Entry
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
    Resumed,
    SessionEnded,
    SessionStarted,
    StudyAmended,
)
from game.journal.sink import FileSink, MemorySink
from game.session.verification import verify
from game.study.folder import Identity, Study, open_study
from game.study.lab.leaving import drop_out
from game.study.ledger import CameBack, NoPlace, SessionOutcome, SlotTaken, ending_of, slot_of
from game.study.lock import SessionBusy, SessionLock
from game.study.protocol.conduct import Stopped, instructor, quiz_marks
from game.study.protocol.practice import LEGS
from game.world import load_building
from game.world.events import Acted
from tests.study.people import MISSION_MS, P01, cut_off, journal_of, small_study, take_part

P05 = Identity("live", "P05")


def step_of(entry: Entry) -> Step:
    return Step(entry.envelope.phase, entry.envelope.round)


def records(study: Study, *kinds: type) -> list[Any]:
    return [e.record for e in journal_of(study).entries if isinstance(e.record, kinds)]


def endings(study: Study) -> dict[Step, str]:
    return {
        step_of(entry): entry.record.ending
        for entry in journal_of(study).entries
        if isinstance(entry.record, PhaseEnded)
    }


def answers(entries: tuple[Entry, ...]) -> dict[tuple[Step, str], object]:
    """Every answer by its step and question."""
    found: dict[tuple[Step, str], object] = {}
    for entry in entries:
        match entry.record:
            case QuestionnaireAnswer(item=item, value=value):
                found[step_of(entry), item] = value
            case QuizAnswer(room=room, answer=answer):
                found[step_of(entry), room] = answer
            case PreferenceGiven(item=item, preferred_round=preferred):
                found[step_of(entry), item] = preferred
            case FreeText(item=item, answer=text):
                found[step_of(entry), item] = text
    return found


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


@settings(max_examples=6, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(share=st.floats(0, 1))
def test_a_session_killed_at_any_byte_resumes_and_loses_nothing(
    finished: Study, tmp_path_factory: pytest.TempPathFactory, share: float
) -> None:
    resumes_and_loses_nothing(finished, tmp_path_factory.mktemp("cut"), share)


@pytest.mark.slow
@settings(max_examples=200, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(share=st.floats(0, 1))
def test_a_session_killed_at_two_hundred_bytes_resumes_and_loses_nothing(
    finished: Study, tmp_path_factory: pytest.TempPathFactory, share: float
) -> None:
    resumes_and_loses_nothing(finished, tmp_path_factory.mktemp("cut"), share)


def resumes_and_loses_nothing(finished: Study, folder: Path, share: float) -> None:
    """Cut a finished session's journal off after this share of its bytes, and take part again."""
    study = small_study(folder / "study")
    (study.folder / "ledger.jsonl").write_bytes(
        (finished.folder / "ledger.jsonl").read_bytes().rpartition(b'{"type":"session_ended"')[0]
    )
    whole = (finished.home(P01) / "journal.jsonl").read_bytes()
    path = study.home(P01) / "journal.jsonl"
    path.parent.mkdir(parents=True)
    cut_at = round(share * len(whole))
    path.write_bytes(whole[:cut_at])
    survived = b"\n" in whole[:cut_at]
    lines = whole[:cut_at].count(b"\n") + (whole[cut_at : cut_at + 1] == b"\n")
    before = journal_of(finished).entries[:lines] if survived else ()

    assert take_part(study)[0] == "over"

    entries = journal_of(study).entries
    assert entries[: len(before)] == before
    assert entries[-1].record == SessionEnded("finished")
    assert set(answers(entries)) == set(answers(journal_of(finished).entries))
    assert answers(entries).items() >= answers(before).items()
    ended = [step_of(entry) for entry in entries if isinstance(entry.record, PhaseEnded)]
    assert ended == list(finished.course)
    if survived and not isinstance(before[-1].record, SessionEnded):
        assert isinstance(entries[len(before)].record, Resumed)
    begun = history_of((entry.envelope, entry.record) for entry in before).begun
    cut = begun if begun is not None and begun.phase == "mission" else None
    assert [s for s, ending in endings(study).items() if ending == "interrupted"] == (
        [cut] if cut else []
    )
    assert verify(path).difference is None


@pytest.mark.parametrize("phase", ["memorise", "label"])
def test_a_timed_phase_continues_with_the_time_left(copy: Study, phase: str) -> None:
    path = copy.home(P01) / "journal.jsonl"
    lines = path.read_bytes().splitlines(keepends=True)
    at = max(
        number
        for number, entry in enumerate(journal_of(copy).entries)
        if isinstance(entry.record, Exposed | PhaseStarted) and step_of(entry) == (phase, 2)
    )
    path.write_bytes(b"".join(lines[: at + 1]))
    cut = journal_of(copy).entries[-1].record
    seen_ms = cut.exposure_ms if isinstance(cut, Exposed) else 0
    take_part(copy)
    resumed = [e for e in journal_of(copy).entries if e.envelope.segment == 1]
    started = next(e.record for e in resumed if isinstance(e.record, PhaseStarted))
    limit_ms = 6_000 if phase == "label" else 5_000
    assert started == PhaseStarted(limit_ms - seen_ms, continued=seen_ms > 0)
    if phase == "memorise":
        ended = next(e.record for e in resumed if isinstance(e.record, PhaseEnded))
        assert ended == PhaseEnded("completed", limit_ms)


def test_a_participant_who_stopped_continues_at_the_same_place(tmp_path: Path) -> None:
    study = small_study(tmp_path / "study")

    class Tired(Exception):
        """Not how a participant stops."""

    def leave(what: str) -> None:
        if what == "prefer":
            raise Tired

    with pytest.raises(Tired):
        take_part(study, moment=leave)
    assert take_part(study)[0] == "over"
    resumed = [e for e in journal_of(study).entries if e.envelope.segment == 1]
    assert step_of(resumed[1]) == ("preference", 0)


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


def test_a_full_disk_stops_the_session(tmp_path: Path) -> None:
    study = small_study(tmp_path / "study")

    class FullDisk(FileSink):
        """Breaks when the label phase begins."""

        def write(self, lines: bytes) -> None:
            if b'"quiz_answer"' in lines:
                raise JournalError("the disk is full", place=str(self.path))
            super().write(lines)

    given: list[str] = []
    with pytest.raises(JournalError, match="the disk is full"):
        take_part(study, sink=FullDisk.begin, moment=given.append)
    assert given[-1] == "label"
    assert not records(study, QuizAnswer)


def test_a_changed_study_is_refused_until_it_is_amended(copy: Study) -> None:
    ledger = copy.ledger
    ledger.allocate("P09", "live")
    path = copy.folder / "study.toml"
    path.write_text(path.read_text().replace("label_seconds = 6", "label_seconds = 7"))
    changed = open_study(copy.folder)
    with pytest.raises(Exception, match="ana study amend"):
        take_part(changed)
    ledger.amend(changed.inputs, "more time was needed")
    journal = copy.home(P01) / "journal.jsonl"
    lines = journal.read_bytes().splitlines(keepends=True)
    journal.write_bytes(b"".join(lines[:-1]))
    take_part(changed)
    (amended,) = records(changed, StudyAmended)
    assert (amended.study, amended.why) == (changed.copy, "more time was needed")


def test_a_drop_out_can_come_back_to_a_place_that_is_still_free(tmp_path: Path) -> None:
    study = small_study(tmp_path / "study", refill_dropouts="true")
    slot = dropped_out(study, P05)
    assert take_part(study, P05)[0] == "over"
    entries = study.ledger.entries()
    assert ending_of(entries, "P05", "live") == "finished"
    assert sum(isinstance(entry, CameBack) for entry in entries) == 1
    later = study.ledger.allocate("P06", "live", refill=True)
    assert (later.slot, later.refill) == (slot + 1, False)


def test_a_drop_out_whose_place_was_given_away_is_told_so(tmp_path: Path) -> None:
    study = small_study(tmp_path / "study", refill_dropouts="true")
    slot = dropped_out(study, P05)
    before = (study.home(P05) / "journal.jsonl").read_bytes()
    assert study.ledger.allocate("P06", "live", refill=True).slot == slot
    for _ in range(2):
        with pytest.raises(NoPlace, match="been given to someone else"):
            take_part(study, P05)
    assert (study.home(P05) / "journal.jsonl").read_bytes() == before
    assert ending_of(study.ledger.entries(), "P05", "live") == "dropped"


def test_leaving_the_last_page_by_ctrl_c_changes_nothing(copy: Study) -> None:
    def leave(_: str) -> None:
        raise Stopped

    before = (copy.home(P01) / "journal.jsonl").read_bytes()
    assert take_part(copy, moment=leave)[0] == "over"
    assert (copy.home(P01) / "journal.jsonl").read_bytes() == before


def test_the_sliders_page_says_that_the_mission_was_interrupted(tmp_path: Path) -> None:
    study = small_study(tmp_path / "study")
    cut_off(study, P01, at="play", since="label")
    _, person = take_part(study)
    first, second = person.slider_pages
    remark = study.texts.cut_off.mission
    assert first.body.startswith(f"**{remark}**\n\nThink of the mission")
    assert remark not in second.body


def test_nobody_is_dropped_while_taking_part(tmp_path: Path) -> None:
    study = small_study(tmp_path / "study")
    dropped_out(study, P05)
    lock = SessionLock(study.home(P05))
    with pytest.raises(SessionBusy):
        drop_out(study, P05)
    lock.release()


def dropped_out(study: Study, identity: Identity) -> int:
    """Let a participant leave in the label phase and drop out; returns their slot."""

    class Gone(Exception):
        pass

    def leave(what: str) -> None:
        if what == "label":
            raise Gone

    with pytest.raises(Gone):
        take_part(study, identity, moment=leave)
    drop_out(study, identity)
    taken = slot_of(study.ledger.entries(), identity.participant, identity.mode)
    assert taken is not None
    return taken.slot


def test_a_leg_of_practice_ends_as_done(finished: Study) -> None:
    left = records(finished, MissionAbandoned)
    assert [record.reason for record in left] == ["leg_done"] * LEGS


def test_a_simulated_session_has_the_same_form(tmp_path: Path, finished: Study) -> None:
    study = small_study(tmp_path / "study")
    take_part(study, sink=MemorySink)
    assert [e.record for e in journal_of(study).entries][1:] == [
        e.record for e in journal_of(finished).entries
    ][1:]
