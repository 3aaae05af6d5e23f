"""`ana study` from the command line."""

from __future__ import annotations

from pathlib import Path

import pytest

from game.cli import main
from game.study.folder import Study, open_study
from game.study.ledger import ending_of
from tests.study.people import P01


def test_a_study_is_made_and_the_next_step_told(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    folder = tmp_path / "study"
    assert main(["study", "new", str(folder), "--seed", "3", "--blocks", "2"]) == 0
    assert f"ana study run {folder} --participant TEST --pilot" in capsys.readouterr().out
    assert (open_study(folder).settings.seed, open_study(folder).settings.blocks) == (3, 2)
    assert main(["study", "new", str(folder)]) == 2
    assert "something in it already" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (["--participant", "ann@example.org"], "pseudonym"),
        (["--participant", "P09"], "not a terminal"),
        ([], "--participant"),
    ],
)
def test_who_cannot_take_part_is_told_why(
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
    assert "was not changed" in capsys.readouterr().err


def test_withdrawal(copy: Study, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["study", "withdraw", str(copy.folder), "P01", "--pilot"]) == 0
    assert "what was recorded is deleted" in capsys.readouterr().out
    assert not copy.home(P01).exists()
    assert ending_of(copy.ledger.entries(), "P01", "pilot") == "withdrawn"
    assert main(["study", "withdraw", str(copy.folder), "P01", "--pilot"]) == 0
    assert "nothing had been recorded" in capsys.readouterr().out
