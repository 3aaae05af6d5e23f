"""The export: a valid Psych-DS dataset, always the same bytes, without withdrawn participants."""

from __future__ import annotations

import csv
import json
import shutil
import stat
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest
from click.testing import CliRunner

from analysis.sources.longcsv import read_long_csv
from game.commands.ana_study import study_group
from game.journal.reader import read_journal
from game.session.verification import verify
from game.study.folder import Identity, Study, StudyError
from game.study.lab.export import export_study, without_free_text
from game.study.lab.leaving import withdraw
from game.study.lab.psychds import alphanumeric
from game.study.ledger import Unblinded
from tests.study.people import small_study, take_part
from tests.study.psychds_rules import broken_rules

WORDS = "clearer"
"""The reason that the scripted participant gives."""

P01, P02 = Identity("live", "P01"), Identity("live", "P02")
Files = dict[str, bytes]


@pytest.fixture(scope="module")
def several(tmp_path_factory: pytest.TempPathFactory) -> Study:
    """A study with two finished sessions, one that was declined, and a pilot."""
    study = small_study(tmp_path_factory.mktemp("export") / "study")
    take_part(study, P01)
    take_part(study, P02)
    take_part(study, Identity("live", "P03"), agrees=False)
    take_part(study, Identity("pilot", "T01"))
    return study


@pytest.fixture
def study(several: Study, tmp_path: Path) -> Study:
    folder = tmp_path / "study"
    shutil.copytree(several.folder, folder)
    return replace(several, folder=folder)


def contents(folder: Path) -> Files:
    return {
        path.relative_to(folder).as_posix(): path.read_bytes()
        for path in sorted(folder.rglob("*"))
        if path.is_file()
    }


def table(out: Path, name: str, mode: str = "live") -> list[dict[str, str]]:
    (path,) = out.rglob(f"*_session-{mode}_description-{name}_data.csv")
    with path.open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def test_the_dataset_keeps_the_rules_of_psych_ds(study: Study, tmp_path: Path) -> None:
    out = tmp_path / "out"
    export_study(study.folder, out, ("live", "pilot"))
    assert broken_rules(out) == []
    shutil.rmtree(out / "data" / "identifying")
    assert broken_rules(out) == []


@pytest.mark.parametrize(
    ("break_it", "complaint"),
    [
        (lambda out: (out / "dataset_description.json").unlink(), "dataset_description.json"),
        (lambda out: next(out.glob("data/*rounds_data.csv")).unlink(), "no data file"),
        (lambda out: (out / "data" / "rounds.csv").write_text("a\n1\n"), "not keyword-value"),
        (lambda out: (out / ".psychds-ignore").unlink(), ""),
        (lambda out: [path.unlink() for path in out.glob(".psychds*")], "not checked"),
        (lambda out: (out / "data" / "study-a_data.csv").write_text("a\n1,2\n"), "2 cells"),
        (lambda out: (out / "data" / "stu-a_data.csv").write_text("round\n1\n"), "no official"),
    ],
)
def test_the_rules_find_what_is_broken(
    study: Study, tmp_path: Path, break_it: Callable[[Path], object], complaint: str
) -> None:
    out = tmp_path / "out"
    export_study(study.folder, out)
    break_it(out)
    found = broken_rules(out)
    assert bool(found) is bool(complaint)
    assert not complaint or any(complaint in one for one in found)


def test_the_same_call_gives_the_same_bytes(study: Study, tmp_path: Path) -> None:
    out = tmp_path / "out"
    export_study(study.folder, out)
    before = contents(out)
    export_study(study.folder, out)
    assert contents(out) == before
    export_study(study.folder, tmp_path / "elsewhere")
    assert contents(tmp_path / "elsewhere") == before


def test_the_analysis_table_has_one_row_per_participant_and_instructor(
    study: Study, tmp_path: Path
) -> None:
    export_study(study.folder, tmp_path / "out")
    rows = table(tmp_path / "out", "rounds")
    assert [(row["participant"], row["round"]) for row in rows] == [
        ("P01", "1"), ("P01", "2"), ("P02", "1"), ("P02", "2"),
    ]  # fmt: skip
    assert {row["adaptivity"] for row in rows[:2]} == {"static", "adaptive"}
    assert {row["engagement"] for row in rows} == {"42"}
    assert {row["preference"] for row in rows} == {"12"}
    assert {row["simulated"] for row in rows} == {"false"}
    people = table(tmp_path / "out", "participants")
    endings = {row["participant"]: row["session_ending"] for row in people}
    assert endings == {"P01": "finished", "P02": "finished", "P03": "declined"}


def test_the_analysis_reads_the_table_as_it_is(study: Study, tmp_path: Path) -> None:
    export_study(study.folder, tmp_path / "out")
    (rounds,) = (tmp_path / "out").rglob("*description-rounds_data.csv")
    (people,) = (tmp_path / "out").rglob("*description-participants_data.csv")
    read = read_long_csv(rounds, people)
    assert list(read.participants.index) == ["P01", "P02"]
    assert set(read.participants["quiz_static"]) == {0.5}
    assert set(read.rounds["preference"]) == {12}


def test_no_file_mixes_modes(study: Study, tmp_path: Path) -> None:
    out = tmp_path / "out"
    export_study(study.folder, out)
    assert not list(out.rglob("*pilot*"))
    assert b"T01" not in b"".join(contents(out).values())
    export_study(study.folder, out, ("live", "pilot"))
    assert [row["participant"] for row in table(out, "participants", "pilot")] == ["T01"]
    assert "T01" not in {row["participant"] for row in table(out, "participants", "live")}


def test_withdrawn_participants_are_gone_even_from_an_earlier_export(
    study: Study, tmp_path: Path
) -> None:
    out = tmp_path / "out"
    export_study(study.folder, out)
    withdraw(study, P02)
    export_study(study.folder, out)
    assert not [path for path in out.rglob("*") if "P02" in path.name]
    assert b"P02" not in b"".join(contents(out).values())


def test_a_withdrawal_that_was_cut_off_counts(study: Study, tmp_path: Path) -> None:
    study.ledger.end_session("P02", "live", "withdrawn")
    export_study(study.folder, tmp_path / "out")
    assert b"P02" not in b"".join(contents(tmp_path / "out").values())


def test_free_text_is_in_its_own_file_and_nowhere_else(study: Study, tmp_path: Path) -> None:
    out = tmp_path / "out"
    export_study(study.folder, out)
    holding = [name for name, data in contents(out).items() if WORDS.encode() in data]
    assert [Path(name).parent.as_posix() for name in holding] == ["data/identifying"]
    assert {row["answer"] for row in table(out, "freetext")} == {WORDS}


def test_raw_journals_are_kept_and_still_verify(study: Study, tmp_path: Path) -> None:
    export_study(study.folder, tmp_path / "out")
    raw = tmp_path / "out" / "data" / "raw" / "live" / "P01" / "journal.jsonl"
    original = study.home(P01) / "journal.jsonl"
    kept = [line for line in raw.read_bytes().splitlines() if b"free_text" not in line]
    written = [line for line in original.read_bytes().splitlines() if b"free_text" not in line]
    assert kept == written
    assert len(read_journal(raw).entries) == len(read_journal(original).entries)
    assert verify(raw).reproduced


def test_an_unfinished_line_with_free_text_is_left_out() -> None:
    whole = b'{"seq":1,"type":"free_text","answer":"I am me"}\n{"seq":2,"type":"x"}\n'
    assert without_free_text(whole) == (
        b'{"seq":1,"type":"free_text","answer":""}\n{"seq":2,"type":"x"}\n'
    )
    assert without_free_text(b'{"type":"free_text","answer":"I a\n{"type":"y"}\n') == (
        b'{"type":"y"}\n'
    )


def test_a_session_under_way_does_no_harm(study: Study, tmp_path: Path) -> None:
    with (study.home(P02) / "journal.jsonl").open("ab") as journal:
        journal.write(b'{"seq":99')
    (study.folder / "sessions" / "live" / "P09").mkdir()
    (study.folder / "sessions" / "live" / "P09" / "journal.jsonl").write_bytes(b'{"se')
    export_study(study.folder, tmp_path / "out")
    people = {row["participant"]: row for row in table(tmp_path / "out", "participants")}
    assert people["P02"]["torn_bytes"] == "9"
    assert "P09" not in people


def test_exporting_live_data_of_an_open_study_is_recorded_in_the_ledger(
    study: Study, tmp_path: Path
) -> None:
    def unblinded() -> int:
        return sum(isinstance(entry, Unblinded) for entry in study.ledger.entries())

    assert not export_study(study.folder, tmp_path / "out", ("pilot",)).unblinded
    assert unblinded() == 0
    assert export_study(study.folder, tmp_path / "out2").unblinded
    assert unblinded() == 1
    study.ledger.close()
    assert not export_study(study.folder, tmp_path / "out2").unblinded
    assert unblinded() == 1


def test_an_export_replaces_only_earlier_exports(study: Study, tmp_path: Path) -> None:
    out = tmp_path / "out"
    export_study(study.folder, out)
    (out / "thesis.md").write_text("mine")
    with pytest.raises(
        StudyError, match=r"contains thesis\.md, which is not part of an earlier export"
    ):
        export_study(study.folder, out)
    assert (out / "thesis.md").read_text() == "mine"
    other = tmp_path / "other"
    (other / "data").mkdir(parents=True)
    (other / "data" / "mine.csv").write_text("a\n")
    with pytest.raises(StudyError, match="not part of an earlier export"):
        export_study(study.folder, other)
    for holding in (study.folder, study.folder.parent):
        with pytest.raises(StudyError, match="contains the study itself"):
            export_study(study.folder, holding)


def test_what_the_lab_says_of_its_dataset_is_in_the_description(
    study: Study, tmp_path: Path
) -> None:
    notes = study.folder / "dataset.toml"
    notes.write_text('authors = ["A. B."]\nlicense = "CC-BY-4.0"\ncitation = "A. B. (2026)."\n')
    export_study(study.folder, tmp_path / "out")
    about = json.loads((tmp_path / "out" / "dataset_description.json").read_text())
    assert about["author"] == [{"@type": "Person", "name": "A. B."}]
    assert (about["license"], about["citation"]) == ("CC-BY-4.0", "A. B. (2026).")
    assert broken_rules(tmp_path / "out") == []
    notes.write_text('autors = ["A. B."]\n')
    with pytest.raises(StudyError, match=r"dataset\.toml"):
        export_study(study.folder, tmp_path / "out")


def test_an_export_is_private(study: Study, tmp_path: Path) -> None:
    export_study(study.folder, tmp_path / "out")
    for path in (tmp_path / "out").rglob("*"):
        assert stat.S_IMODE(path.stat().st_mode) == (0o700 if path.is_dir() else 0o600)


@pytest.mark.parametrize(
    ("words", "value"),
    [("Élan vital 2", "ElanVital2"), ("a-b_c", "ABC"), ("研究", "study"), ("abc", "Abc")],
)
def test_a_studys_name_becomes_a_value_of_a_file_name(words: str, value: str) -> None:
    assert alphanumeric(words) == value


def test_the_command_says_what_it_wrote(study: Study, tmp_path: Path) -> None:
    out = tmp_path / "out"
    done = CliRunner().invoke(
        study_group,
        ["export", str(study.folder), str(out), "--mode", "pilot"],
        standalone_mode=False,
    )
    assert done.exception is None
    assert done.stdout == f"{out}: pilot sessions 1, rounds 2\n"
