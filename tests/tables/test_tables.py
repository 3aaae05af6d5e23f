"""Journals as tidy tables: a row says what the records say."""

from __future__ import annotations

from collections import Counter

import msgspec
import pytest
from hypothesis import given
from hypothesis import strategies as st

from game.coach.acts import InstructionIssued, Level, PosteriorEvaluated
from game.journal.clock import VirtualClock
from game.journal.journal_error import JournalError
from game.journal.reader import Transcript, parse_journal
from game.journal.records import (
    Allocated,
    FreeText,
    PhaseEnded,
    PhaseStarted,
    PreferenceGiven,
    QuestionnaireAnswer,
    QuizAnswer,
    QuizSubmitted,
    Record,
    SessionEnded,
    SessionStarted,
    Versions,
)
from game.journal.sink import MemorySink
from game.journal.writer import Journal
from game.session.playing import begin_mission
from game.tables.columns import cell, cells, col, columns
from game.tables.session_tables import (
    LIKERT_ITEMS,
    MENTAL_STATES,
    NO_RESULT,
    ROW_TYPES,
    Tables,
    combined,
    minutes_of,
    session_tables,
)
from game.world.events import Acted
from tests.session.toy import HUT, SETTINGS, SPEC, WALK, press, toy

ALLOCATED = Allocated(
    slot=3,
    refill=False,
    memorise_ms=60_000,
    adaptive_first=True,
    static_level=Level.C1,
    buildings=("hut", "barn"),
)


class Written:
    """A session written record by record."""

    def __init__(self, participant: str = "P01") -> None:
        self.clock = VirtualClock()
        self.sink = MemorySink()
        self.journal = Journal(self.sink, self.clock)
        self.journal.append(
            SessionStarted(
                session=participant,
                mode="live",
                simulated=False,
                rescuer="person",
                participant=participant,
                versions=Versions(game="0.1.0", schema=1, python="3.11.2"),
                settings=SETTINGS,
                seed=7,
                terminal=None,
            )
        )

    def write(self, *records: Record) -> None:
        for record in records:
            self.clock.now_ms += 10
            self.journal.append(record)

    def mission(self) -> None:
        run = begin_mission(self.journal, HUT, SETTINGS, SPEC, 7, build=toy)
        zero_ms = self.clock.now_ms
        clock = VirtualClock()
        press(run, clock, WALK)
        run.advance(SETTINGS.duration_ms)
        self.clock.now_ms = zero_ms + SETTINGS.duration_ms

    @property
    def transcript(self) -> Transcript:
        return parse_journal(bytes(self.sink.data), "journal.jsonl")

    @property
    def tables(self) -> Tables:
        return session_tables(self.transcript)


def answer(item: str, value: int, changes: int = 0) -> QuestionnaireAnswer:
    return QuestionnaireAnswer(
        item=item,
        text=f"{item}?",
        anchors=("low", "high"),
        place=0,
        value=value,
        response_ms=900,
        changes=changes,
    )


def first_round(*, mission_ending: str = "completed") -> Written:
    """A session up to the end of its first round."""
    written = Written()
    written.journal.enter("memorise", 1)
    written.write(ALLOCATED, PhaseStarted(60_000), PhaseEnded("completed", 60_000))
    written.journal.enter("label", 1)
    written.write(
        PhaseStarted(240_000),
        QuizAnswer("Küche", "Stube", correct=False, response_ms=500),
        QuizAnswer("Küche", "Küche", correct=True, response_ms=1_500),
        QuizAnswer("Stube", "Küche", correct=False, response_ms=500),
        QuizAnswer("Stube", None, correct=False, response_ms=600),
        QuizSubmitted(right=1, asked=2),
        PhaseEnded("completed", 90_000),
    )
    written.journal.enter("mission", 1)
    written.write(PhaseStarted(20_000))
    written.mission()
    written.write(msgspec.convert({"type": "phase_ended", "ending": mission_ending,
                                   "exposure_ms": 20_000}, PhaseEnded))  # fmt: skip
    written.journal.enter("sliders", 1)
    written.write(*(answer(item, 40 + place) for place, item in enumerate(MENTAL_STATES)))
    written.write(answer("engagement", 77, changes=1))
    written.journal.enter("likert", 1)
    written.write(*(answer(item, place + 1) for place, item in enumerate(LIKERT_ITEMS)))
    return written


@pytest.mark.parametrize(("ms", "minutes"), [(60_000, 1.0), (20_000, 0.333), (90_000, 1.5)])
def test_memorise_times_are_written_in_readable_minutes(ms: int, minutes: float) -> None:
    assert minutes_of(ms) == minutes


def test_a_round_has_the_outcomes_of_its_mission_and_its_last_answers() -> None:
    (row,) = first_round().tables.rounds
    assert (row.participant, row.round, row.adaptivity) == ("P01", 1, "adaptive")
    assert (row.complexity, row.order, row.building) == ("C1", "adaptive_first", "hut")
    assert (row.memorise_minutes, row.memorise_ms) == (1.0, 60_000)
    assert (row.victims, row.reds_rescued, row.blues_rescued, row.reds_expired) == (2, 0, 2, 1)
    assert (row.engagement, row.confidence) == (77, 41)
    assert (row.pref1, row.pref4, row.preference) == (1, 4, 10)
    assert (row.quiz, row.quiz_right, row.quiz_asked) == (0.5, 1, 2)
    assert (row.memorise_exposure_ms, row.label_exposure_ms) == (60_000, 90_000)
    assert (row.interrupted, row.void) == (False, False)


def test_the_level_shares_of_a_mission_add_up_and_agree_with_its_stretches() -> None:
    tables = first_round().tables
    (row,) = tables.rounds
    shares = (row.share_c1, row.share_c2, row.share_c3)
    assert sum(share or 0 for share in shares) == pytest.approx(1)
    assert row.switches == len(tables.levels) - 1 > 0
    ends = [0, *(stretch.until_ms for stretch in tables.levels)]
    assert [stretch.from_ms for stretch in tables.levels] == ends[:-1]
    assert ends[-1] == SETTINGS.duration_ms


def test_each_record_of_a_mission_has_its_row() -> None:
    written = first_round()
    tables, entries = written.tables, written.transcript.entries
    written_kinds = Counter(type(entry.record) for entry in entries)
    (row,) = tables.rounds
    assert len(tables.actions) == written_kinds[Acted] > 20
    assert len(tables.instructions) == row.instructions == written_kinds[InstructionIssued] > 3
    assert len(tables.posteriors) == written_kinds[PosteriorEvaluated] > 3
    assert row.moves == sum(action.outcome == "moved" for action in tables.actions)
    assert row.bumps == sum(action.outcome == "bumped" for action in tables.actions)
    fates = {victim.victim: victim.fate for victim in tables.victims}
    assert sorted(fates.values()) == ["expired", "rescued", "rescued"]
    for before, after in zip(tables.instructions, tables.instructions[1:], strict=False):
        assert before.until_ms == after.at_ms
    assert {
        label.room: (label.answer, label.correct, label.changes) for label in tables.labels
    } == {"Küche": ("Küche", True, 1)}


def test_a_void_round_keeps_its_conditions_and_loses_its_outcomes() -> None:
    (row,) = first_round(mission_ending="void").tables.rounds
    assert row.void
    assert not row.counts
    assert row.interrupted
    outcomes = ("victims", "reds_rescued", "preference", *MENTAL_STATES, *LIKERT_ITEMS)
    assert [getattr(row, name) for name in outcomes] == [None] * len(outcomes)
    assert (row.quiz, row.complexity, row.building) == (0.5, "C1", "hut")


def test_a_mission_that_is_not_over_has_no_result() -> None:
    written = first_round()
    written.journal.enter("memorise", 2)
    written.write(PhaseStarted(60_000), PhaseEnded("completed", 60_000))
    written.journal.enter("mission", 2)
    written.write(PhaseStarted(20_000))
    written.mission()
    done, going_on = written.tables.rounds
    assert (done.mission_ending, done.counts) == ("completed", True)
    assert (going_on.mission_ending, going_on.counts) == ("unfinished", False)
    assert [getattr(going_on, name) for name in NO_RESULT] == [None] * len(NO_RESULT)
    assert going_on.instructions and going_on.moves  # what happened so far is kept
    written.write(PhaseEnded("interrupted", 9_000))
    _, ended = written.tables.rounds
    assert (ended.mission_ending, ended.interrupted, ended.counts) == ("interrupted", True, True)
    assert ended.victims == 2


def test_a_round_whose_mission_was_not_begun_has_no_result() -> None:
    written = Written()
    written.journal.enter("memorise", 1)
    written.write(ALLOCATED, PhaseStarted(60_000))
    (row,) = written.tables.rounds
    assert (row.mission_ending, row.counts) == (None, False)


def test_a_statement_left_out_leaves_no_sum() -> None:
    written = Written()
    written.journal.enter("memorise", 1)
    written.write(ALLOCATED, PhaseStarted(60_000))
    written.journal.enter("likert", 1)
    written.write(answer("pref1", 5))
    (row,) = written.tables.rounds
    assert (row.pref1, row.pref2, row.preference, row.victims) == (5, None, None, None)


def test_the_preferred_round_is_translated_into_its_instructor() -> None:
    written = first_round()
    written.journal.enter("preference")
    written.write(
        PreferenceGiven(
            item="preferred_instructor",
            text="Which?",
            options=("Amber", "Slate"),
            preferred_round=2,
            response_ms=700,
        ),
        FreeText("reason", "Why?", "I am P. Body\nand liked it", 4_000),
        SessionEnded("finished"),
    )
    tables = written.tables
    (person,) = tables.participants
    assert (person.preferred_instructor, person.preferred_round) == ("static", 2)
    assert (person.quiz_adaptive, person.quiz_static) == (0.5, None)
    assert (person.session_ending, person.slot) == ("finished", 3)
    (text,) = tables.freetext
    assert "I am P. Body and liked it" in list(cells(text))


def test_a_participant_never_allocated_has_no_rounds() -> None:
    written = Written()
    written.journal.enter("practice")
    written.write(PhaseStarted(None))
    tables = written.tables
    assert tables.rounds == ()
    (person,) = tables.participants
    assert (person.session_ending, person.last_phase, person.complexity) == (
        "unfinished",
        "practice",
        None,
    )


def test_a_participant_without_a_place_is_marked_until_there_is_one() -> None:
    written = Written()
    written.journal.enter("practice")
    written.write(SessionEnded("turned_away"))
    assert [person.session_ending for person in written.tables.participants] == ["turned_away"]
    written.write(ALLOCATED)
    assert [person.session_ending for person in written.tables.participants] == ["unfinished"]


def test_a_round_without_allocation_is_refused() -> None:
    written = Written()
    written.journal.enter("memorise", 1)
    written.write(PhaseStarted(60_000))
    with pytest.raises(JournalError, match="never allocated"):
        _ = written.tables


def test_sessions_are_combined_in_their_order() -> None:
    one, other = first_round().tables, Written("P00").tables
    whole = combined([one, other])
    assert [row.participant for row in whole.participants] == ["P01", "P00"]
    assert whole.actions == one.actions


def test_a_column_means_the_same_in_every_table() -> None:
    meanings: dict[str, set[tuple[str, str]]] = {}
    for row in ROW_TYPES.values():
        for one in columns(row):
            meanings.setdefault(one.name, set()).add((one.meaning, one.unit))
    assert {name: told for name, told in meanings.items() if len(told) > 1} == {}


def test_every_column_has_a_meaning_and_a_unit() -> None:
    for row in ROW_TYPES.values():
        for one in columns(row):
            assert one.meaning.endswith("."), one
            assert one.values, one
            assert one.unit or not one.name.endswith("_ms"), one


def test_a_column_without_a_description_is_refused() -> None:
    class Bare(msgspec.Struct):
        number: int

    with pytest.raises(TypeError, match="number"):
        columns(Bare)
    assert col("A number.", "cells").extra == {"unit": "cells"}


@given(st.one_of(st.text(), st.integers(), st.booleans(), st.none(), st.floats(allow_nan=False)))
def test_a_cell_is_one_line(value: object) -> None:
    text = cell(value)
    assert len(text.splitlines()) <= 1
    assert text == text.strip()


def test_cells_are_the_same_on_every_machine() -> None:
    assert [cell(value) for value in (1 / 3, -0.0, 1e-12, True, None, 7, "a\n b")] == [
        "0.333333333", "0.0", "0.0", "true", "", "7", "a b",
    ]  # fmt: skip
