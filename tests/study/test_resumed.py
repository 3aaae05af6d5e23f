"""A session that was interrupted: killed, left, dropped out of, or changed in the middle."""

from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from game.journal.history import history_of
from game.journal.journal_error import JournalError
from game.journal.records import (
    Exposed,
    PhaseEnded,
    PhaseStarted,
    QuizAnswer,
    Resumed,
    SessionEnded,
    StudyAmended,
)
from game.journal.sink import FileSink
from game.session.verification import verify
from game.study.folder import Identity, Study, open_study
from game.study.lab.leaving import drop_out
from game.study.ledger import CameBack, NoPlace, ending_of, slot_of
from game.study.lock import SessionBusy, SessionLock
from game.study.protocol.conduct import Stopped
from tests.study.people import P01, cut_off, journal_of, small_study, take_part
from tests.study.recorded import answers, endings, records, step_of

P05 = Identity("live", "P05")


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
