"""Faulty settings and texts are named when they are read, and disks that do not work when used."""

from __future__ import annotations

import csv
import errno
import fcntl
import io
import shutil
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from game.cli import main
from game.errors import AnaError
from game.study.folder import Identity, open_study
from game.study.lab.psychds import table_text
from game.tables.rows import FreeTextRow
from game.world.settings import MissionSettings
from tests.study.people import small_study, take_part

TEXTS = "texts.toml"


def spoilt(folder: Path, name: str, before: str, after: str) -> Path:
    small_study(folder)
    path = folder / name
    text = path.read_text(encoding="utf-8")
    assert before in text
    path.write_text(text.replace(before, after, 1), encoding="utf-8")
    return folder


@pytest.mark.parametrize(
    ("name", "before", "after", "told"),
    [
        (TEXTS, "You have {time} to", "You have {tme} to", r"\{tme\}.*Did you mean \{time\}"),
        (TEXTS, "**{code}**", "", r"debrief: the page lacks \{code\}"),
        (TEXTS, "Thank you for taking part", "{code}{name}", r"there is no \{name\}"),
        (TEXTS, 'stop_yes = "stop"', 'stop_yes = "{stop}"', "write the words themselves"),
        (TEXTS, "You have {time} to", "You have { time } to", r"'\{ time \}' is not filled in"),
        (TEXTS, "You have {time} to", "You have {time to", r"'\{time' is not.*Write \{time\}"),
        (TEXTS, "You have {time} to", "You have time} to", r"'time\}' is not.*Write \{time\}"),
        (TEXTS, "You have {time} to", "You have {{time}} to", r"'\{\{time\}\}' is not"),
        (TEXTS, "You have {time} to", "You have { tme } to", r"Write \{time\}"),
        (TEXTS, "You have {time} to", "You have \uff5btime\uff5d to", r"Write \{time\}"),
        (TEXTS, 'first = "', 'first = "" # "', "the names of the instructors must not be empty"),
        ("forms.toml", 'low = "', 'low = " " # "', "low and high must not be empty"),
        ("forms.toml", 'answers = ["', 'answers = ["", "', "must"),
        ("forms.toml", 'id = "pref1"', 'id = ""', "an id must be letters"),
        ("forms.toml", 'id = "pref1"', 'id = "engagement"', "two items have the id engagement"),
        ("study.toml", 'name = "Adaptive navigation assistance"', 'name = " "', "name must not"),
    ],
)
def test_faulty_texts_are_refused(
    tmp_path: Path, name: str, before: str, after: str, told: str
) -> None:
    folder = spoilt(tmp_path / "study", name, before, after)
    with pytest.raises(AnaError, match=told) as refused:
        open_study(folder)
    assert name in str(refused.value)


@pytest.mark.parametrize("name", ["study.toml", TEXTS, "forms.toml"])
def test_files_of_other_editors_are_read(tmp_path: Path, name: str) -> None:
    study = small_study(tmp_path / "study")
    path = study.folder / name
    text = path.read_text(encoding="utf-8").replace("\n", "\r\n")
    path.write_bytes(b"\xef\xbb\xbf" + text.encode())
    again = open_study(study.folder)
    assert (again.texts, again.forms, again.settings) == (study.texts, study.forms, study.settings)


@pytest.mark.parametrize("number", [errno.ENOLCK, errno.EOPNOTSUPP])
def test_a_disk_without_locks_is_named_at_login_and_at_withdrawal(
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    number: int,
    capsys: pytest.CaptureFixture[str],
) -> None:
    study = small_study(tmp_path / "study")
    take_part(study, Identity("live", "P01"))

    def refuse(_file: object, _operation: int) -> None:
        raise OSError(number, "No locks available")

    monkeypatch.setattr(fcntl, "flock", refuse)
    with pytest.raises(AnaError, match=r"files cannot be locked on this disk.*local disk"):
        take_part(study, Identity("live", "P02"))
    assert main(["study", "withdraw", str(study.folder), "P01", "--yes"]) == 2
    assert "local disk" in capsys.readouterr().err


def test_withdrawal_asks_and_refuses_whoever_never_was(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    study = small_study(tmp_path / "study")
    take_part(study, Identity("live", "P01"))
    before = study.ledger.path.read_bytes()
    assert main(["study", "withdraw", str(study.folder), "P10", "--yes"]) == 2
    assert "Did you mean P01?" in capsys.readouterr().err
    assert main(["study", "withdraw", str(study.folder), "P01"]) == 2
    assert "Give --yes" in capsys.readouterr().err
    assert study.ledger.path.read_bytes() == before
    assert study.home(Identity("live", "P01")).is_dir()


@given(st.sampled_from("=+-@\uff1d\uff0b\uff0d\uff20"), st.text(" \t\u3000\xa0", max_size=3))
def test_what_a_spreadsheet_would_compute_is_quoted(sign: str, blanks: str) -> None:
    told = f"{blanks}{sign}cmd()|calc"
    (read,) = csv.DictReader(
        io.StringIO(table_text(FreeTextRow, [FreeTextRow("P01", "reason", "Why?", told, 5)]))
    )
    assert read["answer"].startswith("'")
    assert read["answer"].removeprefix("'").strip() == told.strip()
    assert read["participant"] == "P01"


def test_the_notes_of_a_dataset_may_begin_with_a_byte_order_mark(tmp_path: Path) -> None:
    study = small_study(tmp_path / "study")
    take_part(study, Identity("live", "P01"))
    (study.folder / "dataset.toml").write_bytes(b'\xef\xbb\xbfauthors = ["The lab"]\r\n')
    assert main(["study", "export", str(study.folder), str(tmp_path / "out")]) == 0
    assert "The lab" in (tmp_path / "out/dataset_description.json").read_text()


def test_the_room_that_a_disk_should_have_is_a_setting(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    study = small_study(tmp_path / "study")
    settings = study.folder / "study.toml"
    settings.write_text(f"least_free_mb = 50\n{settings.read_text()}")
    usage = shutil.disk_usage(study.folder)
    for free_mb, wrong in ((51, False), (49, True)):
        monkeypatch.setattr(
            "shutil.disk_usage", lambda _, n=free_mb: usage._replace(free=n * 10**6)
        )
        assert main(["study", "status", str(study.folder)]) == wrong
        assert ("least_free_mb in study.toml" in capsys.readouterr().out) == wrong


def test_only_the_owner_simulates_into_a_study(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    study = small_study(tmp_path / "study")
    before = study.ledger.path.read_bytes()
    monkeypatch.setattr("os.geteuid", lambda: 54_321)
    assert main(["simulate", str(study.folder), "--participants", "2", "--seed", "1"]) == 2
    assert f"sudo -u {study.folder.owner()} ana simulate" in capsys.readouterr().err
    assert study.ledger.path.read_bytes() == before


@pytest.mark.parametrize("minutes", [1, 2, 4])
def test_reds_expire_at_half_time_whatever_the_length(minutes: int) -> None:
    rules = MissionSettings(duration_ms=60_000 * minutes)
    assert rules.reds_expire_ms == 30_000 * minutes
    assert MissionSettings(duration_ms=60_000, red_expiry_ms=50_000).reds_expire_ms == 50_000
