"""Who may come in, and what runs for them."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from game.errors import AnaError
from game.study.folder import Study, open_study
from game.study.links import study_key, token
from game.web.doors import PASSED_ON, PlayDoor, StudyDoor, environment
from tests.study.people import small_study

PROLIFIC = "5f0a1b2c3d4e5f6071829304"


@pytest.fixture
def study(tmp_path: Path) -> Study:
    return small_study(tmp_path / "a study; rm -rf $HOME")


def changed(study: Study, **changes: str) -> Study:
    path = study.folder / "study.toml"
    lines = path.read_text().splitlines()
    for key, value in changes.items():
        lines = [f"{key} = {value}" if it.startswith(f"{key} = ") else it for it in lines]
    path.write_text("\n".join(lines))
    return open_study(study.folder)


def test_a_link_leads_to_its_participants_program_and_to_no_shell(study: Study) -> None:
    door = StudyDoor(study)
    ticket = door.ticket({"link": token(study_key(study.folder), "P01")})
    visitor = door.visitor(ticket, "abcdefgh")
    assert visitor.name == "live/P01"
    assert visitor.command[1:] == ("study", "login", str(study.folder.resolve()))
    assert Path(visitor.command[0]).name == "ana"
    assert visitor.env["ANA_PARTICIPANT"] == "P01"
    assert (visitor.size.columns, visitor.size.rows) == (120, 40)


def test_a_pilots_link_leads_to_a_pilot_session(study: Study) -> None:
    door = StudyDoor(study)
    ticket = door.ticket({"link": token(study_key(study.folder), "P01", pilot=True)})
    visitor = door.visitor(ticket, "abcdefgh")
    assert (visitor.name, visitor.command[-1]) == ("pilot/P01", "--pilot")


def test_all_windows_of_one_participant_are_one_visitor(study: Study) -> None:
    door = StudyDoor(study)
    ticket = token(study_key(study.folder), "P01")
    assert door.visitor(ticket, "abcdefgh").name == door.visitor(ticket, "other123").name


@pytest.mark.parametrize(
    "query",
    [{}, {"link": ""}, {"link": "P01"}, {"link": "P01.x"}, {"link": "../../etc/passwd"},
     {"id": "P01"}, {"participant": "P01"}, {"PROLIFIC_PID": ""}, {"PROLIFIC_PID": "../P01"},
     {"PROLIFIC_PID": "P01; id"}, {"PROLIFIC_PID": "a" * 65}, {"prolific_pid": PROLIFIC},
     {"link": "P01.x", "PROLIFIC_PID": PROLIFIC}],
)  # fmt: skip
def test_nobody_comes_in_with_anything_else(study: Study, query: dict[str, str]) -> None:
    with pytest.raises(AnaError):
        StudyDoor(study).ticket(query)


@pytest.mark.parametrize("wrong", ["", ".", "P01", "P01.", "P01.AAAA", "--pilot", "P01.pilot.x"])
def test_no_ticket_but_a_signed_one_gets_a_program(study: Study, wrong: str) -> None:
    with pytest.raises(AnaError):
        StudyDoor(study).visitor(wrong, "abcdefgh")


# --- panels -------------------------------------------------------------------------------------


def test_a_panels_id_becomes_a_pseudonym(study: Study) -> None:
    door = StudyDoor(study)
    query = {"PROLIFIC_PID": PROLIFIC, "STUDY_ID": "s", "SESSION_ID": "x y;"}
    ticket = door.ticket(query)
    assert PROLIFIC not in ticket
    assert door.ticket(query) == ticket
    visitor = door.visitor(ticket, "abcdefgh")
    assert PROLIFIC not in str(visitor)
    assert visitor.env["ANA_PARTICIPANT"].startswith("h")


def test_a_study_may_record_the_panels_ids_themselves(study: Study) -> None:
    door = StudyDoor(changed(study, hash_ids="false"))
    visitor = door.visitor(door.ticket({"PROLIFIC_PID": PROLIFIC}), "abcdefgh")
    assert visitor.env["ANA_PARTICIPANT"] == PROLIFIC


def test_a_study_may_name_another_panels_parameter_or_none(study: Study) -> None:
    assert StudyDoor(changed(study, panel_id='"workerId"')).ticket({"workerId": "A1"})
    for other in ('"workerId"', '""'):
        with pytest.raises(AnaError):
            StudyDoor(changed(study, panel_id=other)).ticket({"PROLIFIC_PID": PROLIFIC})


@pytest.mark.parametrize("hash_ids", ["true", "false"])
def test_a_roster_is_asked_about_panel_ids(study: Study, hash_ids: str) -> None:
    (study.folder / "roster.csv").write_text(f"id\n{PROLIFIC}\n")
    door = StudyDoor(changed(study, hash_ids=hash_ids))
    assert door.ticket({"PROLIFIC_PID": PROLIFIC})
    with pytest.raises(AnaError, match="not on the roster"):
        door.ticket({"PROLIFIC_PID": PROLIFIC[::-1]})


# --- the end ------------------------------------------------------------------------------------


async def test_only_whoever_finished_is_sent_back_with_the_code(finished: Study) -> None:
    copied = StudyDoor(finished)
    copied.study = finished
    ticket = token(study_key(finished.folder), "P01", pilot=True)
    ending = await copied.visitor(ticket, "abcdefgh").ending(0)
    assert len(ending.code) >= 6
    assert ending.url == ""
    absent = token(study_key(finished.folder), "P77")
    nothing = await copied.visitor(absent, "abcdefgh").ending(0)
    assert (nothing.code, nothing.url) == ("", "")


# --- play and the environment -------------------------------------------------------------------


def test_each_window_plays_by_itself() -> None:
    door = PlayDoor()
    ticket = door.ticket({})
    first, second = (door.visitor(ticket, tab) for tab in ("abcdefgh", "other123"))
    assert first.name != second.name
    with pytest.raises(AnaError):
        door.visitor("P01", "abcdefgh")


def test_nothing_of_the_servers_environment_is_passed_on(monkeypatch: pytest.MonkeyPatch) -> None:
    for name in ("SECRET", "PYTHONPATH", "LD_PRELOAD", "ANA_PARTICIPANT", "NO_COLOR", "COLUMNS"):
        monkeypatch.setenv(name, "x")
    kept = environment()
    ours = {"TERM", "COLORTERM", "LANG", "PATH"}
    assert set(kept) <= set(PASSED_ON) | ours
    assert kept["PATH"] == os.defpath
    assert (kept["TERM"], kept["COLORTERM"]) == ("xterm-256color", "truecolor")
