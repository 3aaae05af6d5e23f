"""One list of sessions: what is out of place is refused by name, by all who walk the list."""

from __future__ import annotations

import json
import re
import shutil
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest

from analysis.sources.absent import SourceError
from analysis.sources.study_folder import read_study_folder
from game.cli import main
from game.errors import AnaError
from game.journal.folders import JOURNAL, all_journals, transcripts
from game.journal.reader import read_journal
from game.study.folder import Identity, Study, open_study, roster_of
from game.study.lab.export import export_study
from game.study.lab.readiness import shortfalls
from game.study.lab.study_status import StatusReader
from tests.study.people import small_study, take_part

P01, P02 = Identity("live", "P01"), Identity("live", "P02")


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Study:
    study = small_study(tmp_path_factory.mktemp("list") / "study")
    take_part(study, P01)
    take_part(study, P02)
    return study


@pytest.fixture
def study(made: Study, tmp_path: Path) -> Study:
    folder = tmp_path / "study"
    shutil.copytree(made.folder, folder)
    return replace(made, folder=folder)


def copied(study: Study) -> str:
    home = study.home(P01)
    shutil.copytree(home, home.with_name("P01-old"))
    return "participant P01, in the folder of P01-old"


def foreign(study: Study) -> str:
    path = study.folder / "study.toml"
    journal = study.home(P01) / JOURNAL
    journal.write_bytes(journal.read_bytes().replace(b"seed = 7", b"seed = 8"))
    assert path.is_file()
    return "of another study: its seed is 8, here it is 7"


def gone(study: Study) -> str:
    shutil.rmtree(study.home(P01))
    return r"P01 \(live\) has place 0, but no session"


def emptied(study: Study) -> str:
    (study.home(P01) / JOURNAL).write_bytes(b"")
    return r"P01 \(live\) has place 0, but no session"


def moved_away(study: Study) -> str:
    study.home(P01).rename(study.folder / "P01")
    return r"P01 \(live\) has place 0, but no session"


def of_another_mode(study: Study) -> str:
    home = study.home(Identity("pilot", "P02"))
    home.parent.mkdir(parents=True, exist_ok=True)
    shutil.copytree(study.home(P02), home)
    shutil.rmtree(study.home(P02))
    return "mode live among the pilot ones"


@pytest.mark.parametrize("spoil", [copied, foreign])
def test_what_is_out_of_place_is_refused_by_everybody(
    study: Study, spoil: Callable[[Study], str], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    named = spoil(study)
    with pytest.raises(AnaError, match=named):
        transcripts(study.folder, "live")
    with pytest.raises(AnaError, match=named):
        export_study(study.folder, tmp_path / "out")
    assert not (tmp_path / "out").exists()
    with pytest.raises(SourceError, match=named):
        read_study_folder(study.folder, "live", check=False)
    assert main(["verify", str(study.folder)]) == 2
    assert named in capsys.readouterr().err
    assert any(named in it for it in StatusReader(study.folder).look().hindrances)
    assert main(["study", "status", str(study.folder)]) == 1
    assert named in capsys.readouterr().out


def test_a_session_among_those_of_another_mode_is_refused(study: Study) -> None:
    named = of_another_mode(study)
    with pytest.raises(AnaError, match=named):
        transcripts(study.folder, "pilot")


def test_a_place_that_the_ledger_does_not_know_is_refused(study: Study, tmp_path: Path) -> None:
    lines = study.ledger.path.read_text().splitlines(keepends=True)
    kept = [line for line in lines if '"P02"' not in line]
    study.ledger.path.write_text("".join(kept))
    with pytest.raises(AnaError, match="the ledger gave its participant none"):
        export_study(study.folder, tmp_path / "out")


@pytest.mark.parametrize("spoil", [gone, emptied, moved_away])
def test_a_place_whose_session_is_gone_is_missed_by_everybody(
    study: Study, spoil: Callable[[Study], str], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    named = spoil(study)
    with pytest.raises(AnaError, match=named):
        export_study(study.folder, tmp_path / "out")
    for command in (["analyse", "--json", str(tmp_path / "out.json")], ["verify"]):
        assert main([command[0], str(study.folder), *command[1:]]) == 2
        assert re.search(named, capsys.readouterr().err)
    assert not (tmp_path / "out.json").exists()
    assert main(["study", "status", str(study.folder)]) == 1
    assert re.search(named, capsys.readouterr().out)
    out = str(tmp_path / "without")
    assert main(["study", "export", str(study.folder), out, "--without", "P01"]) == 0
    assert "Left out on purpose: P01" in (tmp_path / "without/README.md").read_text()


def test_what_is_left_of_a_withdrawal_that_was_cut_off_is_neither_analysed_nor_verified(
    study: Study, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    study.ledger.end_session("P01", "live", "withdrawn")
    for command in (["analyse", "--json", str(tmp_path / "out.json")], ["verify"]):
        assert main([command[0], str(study.folder), *command[1:]]) == 2
        assert "P01 (live) has withdrawn" in capsys.readouterr().err
    assert main(["study", "withdraw", str(study.folder), "P01", "--yes"]) == 0
    assert main(["verify", str(study.folder)]) == 0


def test_a_bad_session_can_be_left_out_and_the_dataset_says_so(
    study: Study, tmp_path: Path
) -> None:
    copied(study)
    out = tmp_path / "out"
    assert main(["study", "export", str(study.folder), str(out), "--without", "P01-old"]) == 0
    assert "Left out on purpose: P01-old" in (out / "README.md").read_text()
    description = json.loads((out / "dataset_description.json").read_text())
    assert "P01-old" in description["description"]
    assert sorted(path.name for path in (out / "data/raw/live").iterdir()) == ["P01", "P02"]
    assert main(["study", "export", str(study.folder), str(out), "--without", "P09"]) == 2


def test_a_whole_study_is_verified(study: Study, capsys: pytest.CaptureFixture[str]) -> None:
    assert len(all_journals(study.folder)) == 2
    assert main(["verify", str(study.folder)]) == 0
    assert capsys.readouterr().out.count("reproduced") == 2


def test_ids_that_differ_in_case_alone_and_a_place_without_a_session_are_told(
    study: Study,
) -> None:
    take_part(study, Identity("live", "p01"))
    study.ledger.allocate("P09", "live")
    told = "\n".join(StatusReader(study.folder).look().hindrances)
    assert "P01 and p01 (live) differ in case alone" in told
    assert "P09 (live) has place" in told


def test_an_unrecorded_change_is_told_at_once(
    study: Study, capsys: pytest.CaptureFixture[str]
) -> None:
    assert StatusReader(study.folder).look().hindrances == ()
    texts = study.folder / "texts.toml"
    texts.write_text(texts.read_text().replace("Thank you", "Thanks", 1))
    assert main(["study", "status", str(study.folder)]) == 1
    told = capsys.readouterr().out.splitlines()
    assert told[1] == "Something is wrong:"
    assert "nobody can log in: texts.toml changed after" in told[2]
    texts.write_text("[")
    assert main(["study", "status", str(study.folder)]) == 1
    assert "nobody can log in" in capsys.readouterr().out


def test_an_anonymous_export_names_nobody(study: Study, tmp_path: Path) -> None:
    out = tmp_path / "out"
    assert main(["study", "export", str(study.folder), str(out), "--anonymous"]) == 0
    files = [path for path in (out / "data").rglob("*") if path.is_file()]
    assert not [path for path in files if "freetext" in path.name]
    assert not [path for path in files if b"P01" in path.read_bytes() or "P01" in path.as_posix()]
    raw = sorted((out / "data/raw/live").glob("*/journal.jsonl"))
    assert [path.parent.name for path in raw] == ["A001", "A002"]
    times = [read_journal(path).entries[0].envelope.utc for path in raw]
    before = read_journal(study.home(P01) / JOURNAL).entries[0].envelope.utc
    assert len({*times, before}) == 3
    assert main(["verify", *map(str, raw)]) == 0


def test_participants_get_their_own_data(study: Study, tmp_path: Path) -> None:
    out = tmp_path / "mine"
    assert main(["study", "data", str(study.folder), "P01", str(out)]) == 0
    assert (out / JOURNAL).read_bytes() == (study.home(P01) / JOURNAL).read_bytes()
    assert "P01" in (out / "rounds.csv").read_text()
    assert main(["study", "data", str(study.folder), "P01", str(out)]) == 2
    assert main(["study", "data", str(study.folder), "P7", str(tmp_path / "no")]) == 2


def test_only_whoever_is_on_the_roster_is_let_in(study: Study) -> None:
    (study.folder / "roster.csv").write_text("\ufeffid,group\r\nP03,a\r\nP01,a\r\n", "utf-8")
    study = open_study(study.folder)
    with pytest.raises(AnaError, match="P04 is not on the roster"):
        take_part(study, Identity("live", "P04"))
    take_part(study, Identity("pilot", "T01"))
    assert StatusReader(study.folder).look().not_come == ("P03",)


def test_another_account_is_refused_with_the_line_to_type(
    study: Study, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    owner = study.folder.owner()
    monkeypatch.setattr("os.geteuid", lambda: 54_321)
    for command in ("status", "export"):
        assert main(["study", command, str(study.folder), "out"][: 3 + (command == "export")]) == 2
        assert f"sudo -u {owner} ana study {command} {study.folder}" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("roster", "told"),
    [
        (b"P03\nP03\n", "roster.csv, line 2: P03 stands there twice"),
        (b"id,group\nP03,a\n\nP 04,b\n", "roster.csv, line 4: 'P 04' is not a participant ID"),
        ("id\nM\u00fcller\n".encode("latin-1"), "the roster cannot be read"),
        (b"", "has no ID in it"),
        (b"participant;group\n", "has no ID in it"),
    ],
)
def test_a_roster_that_cannot_be_used_hides_nobody_and_is_told(
    study: Study, roster: bytes, told: str, capsys: pytest.CaptureFixture[str]
) -> None:
    (study.folder / "roster.csv").write_bytes(roster)
    assert main(["study", "status", str(study.folder)]) == 1
    shown = capsys.readouterr().out
    assert told in shown
    assert "finished 2" in shown
    assert any(told in it for it in shortfalls(open_study(study.folder)))


@pytest.mark.parametrize("mark", [",", ";", "\t"])
def test_a_roster_is_read_whatever_parts_its_columns(study: Study, mark: str) -> None:
    lines = [("name", "participant"), ("x", "P03"), ("y", "P04")]
    (study.folder / "roster.csv").write_text("\n".join(mark.join(line) for line in lines))
    assert roster_of(study.folder) == ("P03", "P04")


def test_settings_that_cannot_be_used_hide_nobody(
    study: Study, capsys: pytest.CaptureFixture[str]
) -> None:
    (study.folder / "study.toml").write_text("label_seconds = 6 6")
    assert main(["study", "status", str(study.folder)]) == 1
    shown = capsys.readouterr().out
    assert "nobody can log in" in shown
    assert "study.toml" in shown
    assert "finished 2" in shown


def test_a_damaged_journal_can_be_withdrawn(
    study: Study, capsys: pytest.CaptureFixture[str]
) -> None:
    (study.home(P01) / JOURNAL).write_bytes(b"no journal\n")
    assert main(["study", "withdraw", str(study.folder), "P01", "--yes"]) == 0
    assert not study.home(P01).exists()
    assert main(["study", "status", str(study.folder)]) == 0
    assert "finished 1, declined 0, withdrawn 1" in capsys.readouterr().out
