"""Every check of `ana doctor`: what passes, what fails, and that it says what to do."""

import io
import json
from pathlib import Path

import pytest

from game import places
from game.cli import main
from game.commands import ana_doctor as doctor
from game.commands.ana_doctor import Check, KeyReading

UP = b"\x1b[A"


@pytest.mark.parametrize(
    ("check", "status"),
    [
        (doctor.check_python((3, 11, 0)), "ok"),
        (doctor.check_python((3, 10, 14)), "fail"),
        (doctor.check_terminal(interactive=True, term="xterm"), "ok"),
        (doctor.check_terminal(interactive=True, term="dumb"), "fail"),
        (doctor.check_terminal(interactive=True, term=""), "fail"),
        (doctor.check_terminal(interactive=False, term="xterm"), "fail"),
        (doctor.check_size((120, 40)), "ok"),
        (doctor.check_size((119, 40)), "warn"),
        (doctor.check_size((80, 24)), "warn"),
        (doctor.check_size((79, 24)), "fail"),
        (doctor.check_size((80, 23)), "fail"),
        (doctor.check_size(None), "warn"),
        (doctor.check_encoding("utf-8"), "ok"),
        (doctor.check_encoding("UTF8"), "ok"),
        (doctor.check_encoding("iso-8859-1"), "fail"),
        (doctor.check_keys(KeyReading(UP, 3.0), 500), "ok"),
        (doctor.check_keys(KeyReading(b"\x1bOD", 500.0), 500), "ok"),
        (doctor.check_keys(KeyReading(UP, 501.0), 500), "fail"),
        (doctor.check_keys(KeyReading(b"\x1b", 0.0), 500), "warn"),
        (doctor.check_keys(KeyReading(b"x", 0.0), 500), "warn"),
        (doctor.check_keys(None, 500), "warn"),
        (doctor.check_space(10**10), "ok"),
        (doctor.check_space(10**6), "fail"),
        (doctor.check_clock(monotonic=True, resolution_s=1e-9), "ok"),
        (doctor.check_clock(monotonic=True, resolution_s=0.016), "fail"),
        (doctor.check_clock(monotonic=False, resolution_s=1e-9), "fail"),
    ],
)
def test_verdict_and_hint(check: Check, status: str) -> None:
    assert check.status == status
    assert bool(check.hint) == (status != "ok")


@pytest.mark.parametrize(
    ("env", "found", "status"),
    [
        ({"COLORTERM": "truecolor", "TERM": "xterm"}, "truecolor", "ok"),
        ({"TERM": "xterm-256color"}, "256", "ok"),
        ({"TERM": "xterm"}, "16", "warn"),
        ({"NO_COLOR": "1", "COLORTERM": "truecolor"}, "none", "ok"),
    ],
)
def test_colours(env: dict[str, str], found: str, status: str) -> None:
    check = doctor.check_colours(env)
    assert check.found.startswith(found)
    assert check.status == status


def test_for_a_slow_key_a_longer_delay_is_suggested() -> None:
    assert "ESCDELAY=1400" in doctor.check_keys(KeyReading(UP, 700.0), 500).hint


def test_the_log_folder_is_made_and_left_empty(tmp_path: Path) -> None:
    folder = tmp_path / "data" / "sessions"
    assert doctor.check_folder(folder).status == "ok"
    assert list(folder.iterdir()) == []


def test_a_log_folder_that_cannot_be_made(tmp_path: Path) -> None:
    (tmp_path / "data").write_text("in the way")
    check = doctor.check_folder(tmp_path / "data" / "sessions")
    assert check.status == "fail"
    assert "--log DIR" in check.hint


def test_without_a_terminal_it_reports_and_asks_nothing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(places, "sessions_folder", lambda: tmp_path / "sessions")
    monkeypatch.setattr("sys.stdin", io.StringIO())
    assert main(["doctor", "--json"]) == 1
    out, err = capsys.readouterr()
    report = json.loads(out)
    assert err == ""
    assert report["playable"] is False
    by_name = {check["name"]: check for check in report["checks"]}
    assert by_name["terminal"]["status"] == "fail"
    assert by_name["log folder"]["found"] == str(tmp_path / "sessions")
    assert "keys" not in by_name


def test_playable_means_that_nothing_failed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(places, "sessions_folder", lambda: tmp_path)
    monkeypatch.setattr(
        doctor, "check_terminal", lambda **_: Check("terminal", "ok", "as in a window")
    )
    monkeypatch.setattr(doctor, "check_encoding", lambda _: Check("encoding", "ok", "UTF-8"))
    assert main(["doctor", "--no-keys"]) == 0
    assert "You can play here" in capsys.readouterr().out
