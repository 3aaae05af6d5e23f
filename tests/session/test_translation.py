"""A mission in another language is the same mission: only the words differ."""

import re
from pathlib import Path

import msgspec
import pytest

from game.coach.acts import InstructionIssued
from game.coach.instructions.phrasebook import Phrasebook
from game.coach.instructions.phrasebook_file import english, parse_phrasebook
from game.coach.spec import CoachSpec, parse_coach
from game.journal.clock import VirtualClock
from game.journal.records import MissionStarted, Record
from game.journal.sink import MemorySink
from game.journal.writer import Journal
from game.rescuers.driver import drive
from game.rescuers.literal import LiteralReader
from game.session.playing import begin_mission, end_free_play
from game.session.replay import Replay
from game.session.verification import verify_transcript
from game.world import load_building
from game.world.events import Acted
from game.world.settings import MissionSettings
from tests.session.test_real_coaches import wandered
from tests.session.toy import opening, transcript

ROOT = Path(__file__).parents[2]
JAPANESE = parse_phrasebook(
    (ROOT / "tests/data/japanese/instructions.toml").read_text(encoding="utf-8"),
    "instructions.toml",
)
RULES = MissionSettings(duration_ms=100_000)
COACHES = [
    *(parse_coach("static", level) for level in (1, 2, 3)),
    parse_coach("ana"),
    parse_coach("ana", preset="belief"),
    parse_coach("knowledge"),
]
CYRILLIC = {ord("a") + place: chr(0x430 + place) for place in range(26)}


def letter_for_letter() -> Phrasebook:
    """The English sentences in another script: each as long to read as before."""

    def other(match: re.Match[str]) -> str:
        parts = re.split(r"(\{.*?\})", match[0])
        return "".join(it if it.startswith("{") else it.translate(CYRILLIC) for it in parts)

    head, *tables = re.split(r"(?m)^(?=\[C1\])", english().text)
    sentences = re.sub(r'(?<== )"[^"]+"(?=$|,| \})', other, tables[0], flags=re.MULTILINE)
    return parse_phrasebook(head + sentences, "instructions.toml")


def told(
    spec: CoachSpec, phrases: Phrasebook | None, keys: tuple[Record, ...] = ()
) -> tuple[bytes, tuple[Record, ...]]:
    """The journal of a mission, and its records: of somebody who does just as told in English, or
    who presses the `keys` that are recorded there."""
    building, sink = load_building("practice"), MemorySink()
    journal = Journal(sink, VirtualClock())
    journal.append(opening(RULES))
    run = begin_mission(journal, building, RULES, spec, 3, phrases=phrases)
    if keys:
        for record in keys:
            if isinstance(record, Acted):
                run.act(record.action, record.at_ms, record.pressed_ms)
        run.advance(RULES.duration_ms)
    else:
        places = {room.name: room.label for room in building.rooms}
        drive(run, LiteralReader(RULES.controls, places))
    end_free_play(run, journal, run.mission.time_ms)
    return bytes(sink.data), records(bytes(sink.data))


def records(journal: bytes) -> tuple[Record, ...]:
    return tuple(entry.record for entry in transcript(journal).entries)


def without_words(record: Record) -> object:
    """What a record says in every language."""
    plain = msgspec.to_builtins(record)
    return {it: plain[it] for it in plain if it not in ("text", "notice", "instructions_text")}


@pytest.mark.parametrize("spec", COACHES, ids=lambda it: f"{it.kind}-{it.preset or it.level}")
def test_who_does_as_told_is_told_the_same_tuples_in_japanese(spec: CoachSpec) -> None:
    _, english_ones = told(spec, None)
    journal, japanese = told(spec, JAPANESE, english_ones)
    here, there = (
        [it for it in found if isinstance(it, InstructionIssued)]
        for found in (english_ones, japanese)
    )
    assert len(here) > 5
    assert [it.tuples for it in here] == [it.tuples for it in there]
    assert [without_words(it) for it in here] == [without_words(it) for it in there]
    for one, other in zip(here, there, strict=True):
        assert other.text == JAPANESE.render(other.shown_level, other.tuples) != one.text
    assert verify_transcript(transcript(journal)).reproduced


@pytest.mark.parametrize("spec", COACHES, ids=lambda it: f"{it.kind}-{it.preset or it.level}")
def test_words_that_take_as_long_to_read_change_nothing_but_the_words(spec: CoachSpec) -> None:
    """For somebody who wanders about as well, who is corrected, lost and too late."""
    other = letter_for_letter()
    here, _ = wandered(spec, "compass", 110, "practice")
    there, _ = wandered(spec, "compass", 110, "practice", other)
    assert b'"reason":"misstep"' in here or b'"reason":"lost"' in here
    assert list(map(without_words, records(here))) == list(map(without_words, records(there)))
    texts = [it.text for it in records(there) if isinstance(it, InstructionIssued)]
    assert len(texts) > 2
    assert all(any(letter in text for letter in CYRILLIC.values()) for text in texts)


def test_a_translated_journal_is_verified_by_the_sentences_that_it_holds() -> None:
    journal, happened = told(parse_coach("ana"), JAPANESE, told(parse_coach("ana"), None)[1])
    (started,) = (it for it in happened if isinstance(it, MissionStarted))
    assert started.instructions_text == JAPANESE.text
    assert verify_transcript(transcript(journal)).reproduced
    replay = Replay(transcript(journal))
    guidance = replay.observation().guidance
    assert guidance is not None and guidance.text.endswith("。")
    head, there, tail = journal.rpartition("進んで".encode())
    difference = verify_transcript(transcript(head + "行って".encode() + tail)).difference
    assert there and difference is not None
    assert difference.field == "instruction_issued.text"


def test_an_english_journal_holds_no_sentences() -> None:
    _, happened = told(parse_coach("static", 1), english())
    (started,) = (it for it in happened if isinstance(it, MissionStarted))
    assert started.instructions_text is None


def test_a_journal_whose_sentences_cannot_be_used_differs_where_the_mission_began() -> None:
    journal, _ = wandered(parse_coach("static", 1), "compass", 5, "practice", JAPANESE)
    broken = journal.replace(b"[C3]", b"[C5]", 1)
    difference = verify_transcript(transcript(broken)).difference
    assert difference is not None
    assert "C5" in str(difference)
