"""The columns that a study's own forms add to its tables."""

from __future__ import annotations

import asyncio
from pathlib import Path

import pytest

from game.forms.reading import FormsError, paper_forms
from game.journal.clock import VirtualClock
from game.rescuers.person import POPULATIONS
from game.simulation.simulated_participant import SimulatedParticipant
from game.study.folder import Study, open_study
from game.study.protocol.conduct import conduct
from game.study.protocol.study_session import open_session
from game.study.ready import ready_text
from game.tables.asked import asked_columns, outcomes_of
from game.tables.columns import columns
from game.tables.session_tables import ROW_TYPES, row_types, session_tables
from tests.study.people import P01, TERMINAL, QuickSink, journal_of, small_study

MOOD = """
[[form]]
id = "mood"
place = ["before", "at the end"]
answers = ["bad", "fair", "good"]
[[form.item]]
kind = "scale"
id = "well"
text = "How are you"
[[form.item]]
kind = "text"
id = "why"
text = "Why?"
required = false
"""


def wide_study(folder: Path) -> Study:
    """A small study with every ready form, and one that is asked twice."""
    study = small_study(folder)
    names = ("nasa-tlx", "sus", "demographics", "gaming-experience", "attention-check")
    with (study.folder / "forms.toml").open("a") as file:
        for name in names:
            file.write(f"\n{ready_text(name)}")
        file.write(MOOD)
    return open_study(study.folder)


@pytest.fixture(scope="module")
def wide(tmp_path_factory: pytest.TempPathFactory) -> Study:
    """It was finished by one simulated person."""
    study = wide_study(tmp_path_factory.mktemp("asked") / "wide")
    clock = VirtualClock()
    session = open_session(study, P01, TERMINAL, clock=clock, sink=QuickSink.begin)
    person = SimulatedParticipant(session, clock, POPULATIONS["default"])
    assert asyncio.run(conduct(session, person)) == "over"
    return study


def test_the_papers_forms_add_no_column() -> None:
    assert row_types(paper_forms()) == ROW_TYPES
    assert {column.name for column in asked_columns(paper_forms())} == {
        *outcomes_of(paper_forms()).ranges,
        "preference",
    }


def test_every_answer_has_its_column(wide: Study) -> None:
    tables = session_tables(journal_of(wide), forms=wide.forms)
    (person,) = tables.participants
    first, last = tables.rounds
    assert 18 <= person.age <= 110  # type: ignore[attr-defined]
    assert person.well_before in (1, 2, 3)  # type: ignore[attr-defined]
    assert person.well_at_the_end in (1, 2, 3)  # type: ignore[attr-defined]
    assert person.attention_failed in (0, 1)  # type: ignore[attr-defined]
    marked = [getattr(person, f"games_kinds_{n}") for n in range(1, 7)]
    often = person.games_often  # type: ignore[attr-defined]
    assert (marked == [None] * 6) if often == 1 else any(marked)
    assert first.attention_check is None  # type: ignore[attr-defined]
    assert last.attention_check in range(1, 6)  # type: ignore[attr-defined]
    for row in (first, last):
        six = [getattr(row, name) for name in outcomes_of(wide.forms).composites["tlx_raw"]]
        assert row.tlx_raw == pytest.approx(sum(six) / 6)  # type: ignore[attr-defined]
        assert row.preference == sum((row.pref1, row.pref2, row.pref3, row.pref4))  # type: ignore[arg-type]
        assert 0 <= row.sus <= 100  # type: ignore[attr-defined]


def test_the_codebook_says_what_each_column_means(wide: Study) -> None:
    types = row_types(wide.forms)
    named = {one.name: one for row in types.values() for one in columns(row)}
    assert named["age"].unit == "years"
    assert named["age"].meaning == "Answer to: How old are you? 18 to 110."
    assert "Whether 'strategy games' was marked." in named["games_kinds_3"].meaning
    assert named["well_before"].meaning == "Answer to: How are you. 1 bad; 2 fair; 3 good."
    assert "Turned round" in named["sus2"].meaning
    assert all(one.meaning.endswith((".", "?", ":")) for one in named.values())


def test_the_items_are_in_their_order_and_rounds(wide: Study) -> None:
    phases = [step.phase for step in wide.course]
    assert phases.index("mood.before") == phases.index("gaming_experience") + 1
    assert phases[-2:] == ["mood.at_the_end", "debrief"]
    assert phases.count("tlx") == 2
    assert phases.count("attention") == 1


@pytest.mark.parametrize("name", ["victims", "round", "quiz", "attention_failed", "moves"])
def test_an_id_that_names_another_column_is_refused(tmp_path: Path, name: str) -> None:
    study = small_study(tmp_path / "study")
    place = "before" if name == "attention_failed" else "after each mission"
    with (study.folder / "forms.toml").open("a") as file:
        file.write(MOOD.replace('["before", "at the end"]', f'"{place}"').replace("well", name))
    with pytest.raises(FormsError, match=f"the id {name} is the name of another column"):
        open_study(study.folder)


def test_an_item_of_the_paper_can_be_left_out_or_have_other_ends(tmp_path: Path) -> None:
    study = small_study(tmp_path / "study")
    path = study.folder / "forms.toml"
    text = path.read_text().replace('id = "confusion"', 'id = "joy"')
    path.write_text(text.replace('low = "not engaged', 'from = 0\nto = 10\nlow = "not engaged'))
    forms = open_study(study.folder).forms
    assert outcomes_of(forms).mental_states == ("engagement", "confidence", "frustration", "joy")
    assert outcomes_of(forms).ranges["engagement"] == (0, 10)
    meaning = {one.name: one.meaning for one in columns(row_types(forms)["rounds"])}
    assert "0 (not engaged at all) to 10" in meaning["engagement"]
    assert meaning["confidence"] == "Slider: how confident, 1 to 100."
