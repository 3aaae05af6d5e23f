"""`ana study` on the command line."""

from __future__ import annotations

import errno
import os
from pathlib import Path
from unittest.mock import Mock

import pytest
from click.testing import CliRunner, Result

from game.cli import main
from game.commands.ana_study import study_group
from game.study.files import NEW_STUDY
from game.study.folder import Identity, Study, open_study
from game.study.ledger import Unblinded, ending_of
from tests.study.people import P01, small_study, take_part


def test_a_study_is_created_and_the_next_step_is_shown(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    folder = tmp_path / "study"
    assert main(["study", "new", str(folder), "--seed", "3", "--blocks", "2"]) == 0
    assert f"ana study run {folder} --participant TEST --pilot" in capsys.readouterr().out
    assert (open_study(folder).settings.seed, open_study(folder).settings.blocks) == (3, 2)
    assert main(["study", "new", str(folder)]) == 2
    assert "the folder is not empty" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (["--participant", "ann@example.org"], "pseudonym"),
        (["--participant", "P09"], "not a terminal"),
        ([], "--participant"),
    ],
)
def test_people_who_cannot_take_part_are_told_why(
    copy: Study, capsys: pytest.CaptureFixture[str], arguments: list[str], told: str
) -> None:
    assert main(["study", "run", str(copy.folder), *arguments]) == 2
    assert told in capsys.readouterr().err


def test_a_change_is_amended(copy: Study, capsys: pytest.CaptureFixture[str]) -> None:
    copy.ledger.allocate("P09", "live")
    path = copy.folder / "study.toml"
    path.write_text(path.read_text().replace("label_seconds = 6", "label_seconds = 8"))
    assert main(["study", "amend", str(copy.folder), "--why", "too short"]) == 0
    assert main(["study", "amend", str(copy.folder), "--why", "too short"]) == 2
    assert "nothing has changed" in capsys.readouterr().err


def test_withdrawal(copy: Study, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["study", "withdraw", str(copy.folder), "P01", "--pilot", "--yes"]) == 0
    told = capsys.readouterr().out
    assert "their data are deleted\nDatasets exported before" in told
    assert not copy.home(P01).exists()
    assert ending_of(copy.ledger.entries(), "P01", "pilot") == "withdrawn"
    assert main(["study", "withdraw", str(copy.folder), "P01", "--pilot", "--yes"]) == 0
    assert "nothing had been recorded\n" in capsys.readouterr().out


def test_a_pilot_is_not_taken_for_a_live_participant(
    copy: Study, capsys: pytest.CaptureFixture[str]
) -> None:
    for command in (["withdraw"], ["data", "out"]):
        name, *rest = command
        assert main(["study", name, str(copy.folder), "P01", *rest]) == 2
        assert "P01 is a pilot: add --pilot" in capsys.readouterr().err


def test_closing_says_what_happens_to_everyone(
    copy: Study, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["study", "close", str(copy.folder)]) == 0
    told = capsys.readouterr().out
    assert "Anyone who has a place can finish" in told
    assert "newcomers when they log in" in told


# --- analysing a live study ---------------------------------------------------------------------


@pytest.fixture
def live(tmp_path: Path) -> Study:
    """A study with one live session and a pilot."""
    study = small_study(tmp_path / "study")
    for identity in (P01, Identity("live", "P01")):
        assert take_part(study, identity)[0] == "over"
    return study


def unblindings(study: Study) -> list[str]:
    return [entry.why for entry in study.ledger.entries() if isinstance(entry, Unblinded)]


def analyse(study: Study, *options: str) -> int:
    out = study.folder.parent / "results.json"
    status = main(["analyse", str(study.folder), "--json", str(out), "--no-verify", *options])
    assert out.exists()
    out.unlink()
    return status


def test_analysing_an_open_study_unblinds_it_as_an_export_does(
    live: Study, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["study", "export", str(live.folder), str(tmp_path / "dataset")]) == 0
    words = capsys.readouterr().err
    assert words.startswith("The study is still open, and this shows who was allocated what: ")
    assert analyse(live) == 2, "one participant is too few for every model"
    assert capsys.readouterr().err == words
    assert unblindings(live) == ["ana study export", "ana analyse"]


def test_an_export_that_unblinds_is_asked_about_at_a_terminal(
    live: Study, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("game.commands.ana_study.sys", Mock(stdin=Mock(isatty=lambda: True)))
    out = tmp_path / "dataset"

    def export(answer: str, *options: str) -> Result:
        arguments = ["export", str(live.folder), str(out), *options]
        return CliRunner().invoke(study_group, arguments, input=answer)

    refused = export("n\n")
    assert refused.exit_code == 1
    assert "the ledger will record that the study was unblinded" in refused.output
    assert not out.exists()
    assert unblindings(live) == []
    assert export("", "--mode", "pilot").exit_code == 0
    assert unblindings(live) == []
    done = export("", "--yes")
    assert "the earlier export had pilot sessions too, and was replaced" in done.output
    export("y\n")
    live.ledger.close()
    assert export("").exit_code == 0
    assert len(unblindings(live)) == 2


def test_an_export_of_nobody_says_who_is_there(
    copy: Study, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["study", "export", str(copy.folder), str(tmp_path / "dataset")]) == 2
    told = capsys.readouterr().err
    assert "no live sessions to export. It has 1 pilot session: give --mode pilot" in told
    assert not (tmp_path / "dataset").exists()
    assert unblindings(copy) == []


@pytest.mark.parametrize("command", ["status", "close", "design"])
def test_a_folder_that_is_no_study_is_told(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], command: str
) -> None:
    for folder in (tmp_path, tmp_path / "nowhere"):
        assert main(["study", command, str(folder)]) == 2
        told = capsys.readouterr().err
        assert told == f"ana: {folder}: there is no study here. {NEW_STUDY}\n"


def test_a_source_that_is_not_there_is_told_first(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["analyse", "nowhere"]) == 2
    assert "nowhere: there is nothing there" in capsys.readouterr().err


def test_analysing_a_closed_study_or_pilots_is_not_recorded(
    live: Study, capsys: pytest.CaptureFixture[str]
) -> None:
    analyse(live, "--mode", "pilot")
    live.ledger.close()
    analyse(live)
    assert unblindings(live) == []
    assert capsys.readouterr().err == ""


def test_a_failed_analysis_is_not_recorded(live: Study, tmp_path: Path) -> None:
    source, out = str(live.folder), str(tmp_path / "results.json")
    assert main(["analyse", source, "--json", out, "--quiz", "quiz.csv"]) == 2
    assert unblindings(live) == []


def test_a_copy_with_a_read_only_ledger_is_still_analysed(
    live: Study, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    opened = os.open

    def read_only(path: Path, flags: int, *mode: int, **keywords: int) -> int:
        if path == live.ledger.path:
            raise OSError(errno.EROFS, os.strerror(errno.EROFS))
        return opened(path, flags, *mode, **keywords)

    with monkeypatch.context() as patched:
        patched.setattr("os.open", read_only)
        analyse(live)
    assert "could not be recorded" in capsys.readouterr().err
    assert unblindings(live) == []
    live.ledger.path.unlink()
    analyse(live)
    assert "could not be recorded" in capsys.readouterr().err
