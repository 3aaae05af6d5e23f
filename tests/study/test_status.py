"""The status of a study: read while sessions write, and silent about allocation."""

from __future__ import annotations

import json
import os
import shutil
from datetime import UTC, datetime, timedelta
from pathlib import Path

import pytest
from click.testing import CliRunner, Result
from msgspec.structs import replace

from game.commands.ana_study import study_group
from game.journal.folders import JOURNAL
from game.journal.reader import read_journal
from game.screens.lab.status_screen import NOTHING, status_rows
from game.study.design import design_cell
from game.study.folder import Identity, Study, StudyError, open_study
from game.study.lab.attendance import Attendance, SessionStatus
from game.study.lab.leaving import drop_out, withdraw
from game.study.lab.status_text import age, page, session_cells
from game.study.lab.study_status import StatusReader, breakdown
from game.study.ledger import NoPlace, Unblinded
from game.study.lock import LOCK, SessionLock
from game.tables.exclusions import ExclusionRule
from tests.study.people import cut_off, small_study, take_part
from tests.study.server import ANA
from tests.terminal import Terminal

P01, P02, P03 = (Identity("live", f"P0{number}") for number in (1, 2, 3))
CELL_WORDS = ("slot", "complexity", "memorise_ms", "static_level", "adaptive", "C1", "C2", "C3")


@pytest.fixture
def study(tmp_path: Path) -> Study:
    return small_study(tmp_path / "study")


def seen(study: Study, now: datetime | None = None) -> dict[str, SessionStatus]:
    return {one.participant: one for one in Attendance(study.folder).look(study.settings, now)}


def command(study: Study, *arguments: str) -> Result:
    return CliRunner().invoke(
        study_group, ["status", str(study.folder), *arguments], standalone_mode=False
    )


def written_at(study: Study, identity: Identity) -> datetime:
    last = read_journal(study.home(identity) / JOURNAL).entries[-1]
    return datetime.fromisoformat(last.envelope.utc)


def test_each_session_is_where_it_is(study: Study) -> None:
    take_part(study, P01)
    take_part(study, P02, agrees=False)
    cut_off(study, P03, at="label")
    now = seen(study, written_at(study, P03) + timedelta(seconds=5))
    assert (now["P01"].state, now["P01"].phase) == ("finished", "debrief")
    assert (now["P02"].state, now["P02"].problems) == ("declined", ())
    third = now["P03"]
    assert (third.state, third.phase, third.round) == ("cut off", "label", 1)
    assert third.limit_s == study.settings.label_seconds
    assert third.silent_s == pytest.approx(5)
    assert third.problems == ("the program ended unexpectedly; the participant can log in again",)


def test_resumed_sessions_are_counted(study: Study) -> None:
    cut_off(study, P01, at="label")
    take_part(study, P01)
    now = seen(study)["P01"]
    assert (now.state, now.interruptions, now.resumed) == ("finished", 1, 1)


def test_a_session_that_broke_off_is_interrupted_before_anybody_comes_back(study: Study) -> None:
    cut_off(study, P01, at="label")
    assert (seen(study)["P01"].interruptions, seen(study)["P01"].resumed) == (1, 0)


def test_pilots_and_simulated_people_are_counted_and_are_no_problem(study: Study) -> None:
    take_part(study, Identity("pilot", "T01"))
    for participant in ("S1", "S2"):
        cut_off(study, Identity("simulated", participant), at="label")
    now = replace(StatusReader(study.folder).look(), hindrances=())
    assert now.problems == ()
    told = list(page(now))
    assert told[2:4] == [
        "Pilot sessions: started 1, finished 1",
        "Simulated sessions: started 2, cut off 2",
    ]
    assert all(line.split()[-3] == "-" for line in told if line.startswith("S1 "))
    screen = ["".join(text for text, _ in row) for row in status_rows(now)]
    assert " Simulated sessions: started 2, cut off 2" in screen
    narrow = [row[0] for row in status_rows(now, 60) if row]
    assert {style for text, style in narrow if "S1" in text} == {"quiet"}
    wrapped = narrow[: next(n for n, (text, _) in enumerate(narrow) if "participant" in text)]
    assert max(len(text) for text, _ in wrapped) < 60
    assert any("dropped out 0" in text for text, _ in wrapped)


@pytest.mark.parametrize("columns", [120, 80, 60, 40])
def test_a_narrow_screen_cuts_nothing(columns: int, study: Study) -> None:
    who = Identity("live", "K7QX-a-long-name-of-somebody")
    cut_off(study, who, at="label", since="look")
    take_part(study, P01)
    now = replace(StatusReader(study.folder).look(), hindrances=())
    told = [text for row in status_rows(now, columns) for text, _ in row]
    assert max(map(len, told)) <= columns
    words = " ".join(" ".join(told).split())
    for session in now.sessions:
        for cell in session_cells(session):
            assert cell in words or cell in NOTHING
    assert words.count("interrupted") == 1


def test_a_session_whose_process_lives_takes_part(study: Study) -> None:
    cut_off(study, P01, at="label")
    lock = SessionLock(study.home(P01))
    moment = written_at(study, P01)
    assert seen(study, moment)["P01"].state == "taking part"
    assert seen(study, moment + timedelta(seconds=3))["P01"].problems == ()
    (problem,) = seen(study, moment + timedelta(seconds=30))["P01"].problems
    assert "frozen" in problem
    lock.release()
    assert seen(study, moment)["P01"].state == "cut off"


def test_in_a_copy_of_a_study_nobody_takes_part(study: Study, tmp_path: Path) -> None:
    cut_off(study, P01, at="label")
    lock = SessionLock(study.home(P01))
    copy = open_study(Path(shutil.copytree(study.folder, tmp_path / "copy")))
    assert (copy.home(P01) / LOCK).read_text() == f"{os.getpid()}\n"
    assert seen(study)["P01"].state == "taking part"
    assert seen(copy)["P01"].state == "cut off"
    lock.release()


def test_before_consent_the_status_shows_only_that_someone_is_there(study: Study) -> None:
    lock = SessionLock(study.home(P01))
    (session,) = seen(study).values()
    assert (session.state, session.phase, session.silent_s) == ("taking part", "consent", None)
    lock.release()
    assert seen(study) == {}


def test_the_memorise_clock_is_hidden_because_it_reveals_the_allocation(study: Study) -> None:
    cut_off(study, P01, at="memorise", times=3)
    now = seen(study)["P01"]
    assert (now.phase, now.clock_s, now.limit_s) == ("memorise", None, None)


def test_the_clock_of_a_mission_is_what_was_played(study: Study) -> None:
    missions = study.settings.mission.duration_ms // 1000
    cut_off(study, P01, at="play", times=7, since="memorise")
    now = seen(study)["P01"]
    assert (now.phase, now.round, now.limit_s) == ("mission", 1, missions)
    assert now.clock_s == 3


def test_only_what_was_added_is_read_again(study: Study) -> None:
    take_part(study, P01)
    reader = Attendance(study.folder)
    first = reader.look(study.settings)
    journal = study.home(P01) / JOURNAL
    whole = journal.read_bytes()
    journal.write_bytes(b"x" * len(whole))
    assert [one.state for one in reader.look(study.settings)] == [one.state for one in first]
    journal.write_bytes(whole[: whole.index(b"\n") + 1])
    assert [one.state for one in reader.look(study.settings)] == ["cut off"]


def test_a_line_that_is_being_written_is_waited_for(study: Study) -> None:
    take_part(study, P01)
    journal = study.home(P01) / JOURNAL
    whole = journal.read_bytes()
    cut = whole.rindex(b"\n", 0, -1) + 20
    journal.write_bytes(whole[:cut])
    lock = SessionLock(study.home(P01))
    roll = Attendance(study.folder)
    (before,) = roll.look(study.settings, written_at(study, P01))
    assert (before.state, before.problems) == ("taking part", ())
    with journal.open("ab") as file:
        file.write(whole[cut:])
    (after,) = roll.look(study.settings)
    assert after.state == "finished"
    lock.release()


def test_problems_with_a_journal_are_reported(study: Study) -> None:
    take_part(study, P01)
    take_part(study, P02)
    journal = study.home(P01) / JOURNAL
    lines = journal.read_bytes().splitlines(keepends=True)
    journal.write_bytes(b"".join([*lines[:5], b'{"seq":\n', *lines[5:]]))
    with (study.home(P02) / JOURNAL).open("ab") as file:
        file.write(b'{"seq":9')
    now = seen(study)
    assert now["P01"].problems == ("1 lines of the journal cannot be read",)
    assert now["P02"].problems == ("the journal ends in an unfinished line (8 bytes, ignored)",)


def test_looking_changes_nothing(study: Study) -> None:
    take_part(study, P01)
    cut_off(study, P02, at="label")

    def state() -> dict[str, tuple[bytes, int]]:
        return {
            str(path): (path.read_bytes(), path.stat().st_mtime_ns)
            for path in study.folder.rglob("*")
            if path.is_file()
        }

    before = state()
    assert command(study).exception is None
    assert command(study, "--json").exception is None
    assert state() == before


def test_totals_are_of_live_sessions(study: Study) -> None:
    take_part(study, P01)
    take_part(study, P02, agrees=False)
    cut_off(study, P03, at="label")
    take_part(study, Identity("pilot", "T01"))
    withdraw(study, P01)
    totals = StatusReader(study.folder).look().totals
    assert (totals.places, totals.taken, totals.started) == (24, 2, 3)
    assert (totals.finished, totals.declined, totals.withdrawn, totals.cut_off) == (0, 1, 1, 1)


def test_a_drop_out_keeps_what_was_recorded(study: Study) -> None:
    cut_off(study, P01, at="label")
    take_part(study, P02)
    done = CliRunner().invoke(study_group, ["drop", str(study.folder), "P01"])
    assert done.stdout == "P01 dropped out; the place stays empty (refill_dropouts in study.toml)\n"
    assert StatusReader(study.folder).look().totals.dropped == 1
    assert (study.home(P01) / JOURNAL).exists()
    drop_out(study, P01)
    with pytest.raises(StudyError, match=r"P02 has already ended \(finished\)"):
        drop_out(study, P02)
    with pytest.raises(StudyError, match="has no place"):
        drop_out(study, P03)


def test_nothing_reveals_anyones_allocation(study: Study) -> None:
    for identity in (P01, P02):
        take_part(study, identity)
    cut_off(study, P03, at="memorise", times=2)
    told = command(study, "--json").stdout + command(study).stdout
    assert [word for word in CELL_WORDS if word in told] == []
    assert not [entry for entry in study.ledger.entries() if isinstance(entry, Unblinded)]


def test_unblinding_is_recorded_before_anything_is_shown(study: Study) -> None:
    for identity in (P01, P02):
        take_part(study, identity)
    told = json.loads(command(study, "--json", "--unblind").stdout)
    cells = {design_cell(study.settings.seed, "live", slot).code for slot in (0, 1)}
    assert {one["cell"] for one in told["design_cells"]} == cells
    assert {(one["allocated"], one["finished"]) for one in told["design_cells"]} == {(1, 1)}
    assert {name for one in told["design_cells"] for name in one["excluded"]} == {
        "disobeyed",
        "other_victim",
    }
    (entry,) = (one for one in study.ledger.entries() if isinstance(one, Unblinded))
    assert entry.why == "ana study status --unblind"


def test_people_turned_away_are_counted_if_there_are_any(study: Study) -> None:
    cut_off(study, P01, at="look")
    assert "turned away" not in command(study).stdout
    study.ledger.close()
    take_part(study, P01)
    take_part(study, P02)
    told = command(study).stdout
    assert "declined 0, turned away 1, withdrawn 0" in told
    assert told.count("turned away  practice") == 1
    assert "P02" not in told
    assert "Look at" not in told


def test_a_closed_study_shows_everything_and_admits_nobody(study: Study) -> None:
    take_part(study, P01)
    assert CliRunner().invoke(study_group, ["close", str(study.folder)]).exit_code == 0
    assert "design_cells" in json.loads(command(study, "--json").stdout)
    assert not [entry for entry in study.ledger.entries() if isinstance(entry, Unblinded)]
    with pytest.raises(NoPlace, match="closed"):
        study.ledger.allocate("P05", "live")
    assert study.ledger.allocate("P01", "live").slot == 0
    assert study.ledger.allocate("T01", "pilot").slot == 0
    study.ledger.close()
    assert command(study).stdout.count("closed") == 1


def test_exclusions_follow_the_rules_given(study: Study) -> None:
    take_part(study, P01)
    rules = [ExclusionRule("all", "Everybody.", "a test", "segments", 0)]
    (cell,) = breakdown(study.folder, rules, "a test")
    assert cell.excluded == {"all": 1}
    lenient = [ExclusionRule("all", "Everybody.", "a test", "segments", 1)]
    (cell,) = breakdown(study.folder, lenient, "a test")
    assert cell.excluded == {"all": 0}


@pytest.mark.parametrize(
    ("seconds", "words"),
    [(None, "-"), (0, "0 s"), (119, "119 s"), (120, "2 min"), (7_200, "2 h"), (200_000, "2 d")],
)
def test_an_age_is_shown_in_a_suitable_unit(seconds: float | None, words: str) -> None:
    assert age(seconds) == words


def test_watching_follows_the_study_and_q_quits(study: Study) -> None:
    take_part(study, P01)
    follow: list[str | Path] = [ANA, "study", "status", study.folder, "--watch"]
    with Terminal(follow, columns=100, rows=24) as terminal:
        assert "P01" in terminal.wait_for("leave")
        terminal.read_for(2)
        before = len(terminal.chunks)
        terminal.read_for(1.5)
        repainted = b"".join(chunk.data for chunk in terminal.chunks[before:])
        cut_off(study, P02, at="label")
        terminal.wait_for("P02")
        terminal.press("q")
        assert terminal.wait() == 0
    assert b"P01" not in repainted


def test_watching_needs_a_terminal_and_no_other_option(study: Study) -> None:
    assert "not a terminal" in str(command(study, "--watch").exception)
    assert "cannot be combined" in str(command(study, "--watch", "--json").exception)


def test_now_is_the_wall_clock(study: Study) -> None:
    take_part(study, P01)
    silent = seen(study)["P01"].silent_s
    assert silent is not None
    expected = (datetime.now(UTC) - written_at(study, P01)).total_seconds()
    assert silent == pytest.approx(expected, abs=60)
