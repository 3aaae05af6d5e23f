"""`ana study serve` as it runs: a real study, and participants who come over websockets."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import time
from collections.abc import Iterator
from pathlib import Path

import aiohttp
import psutil
import pytest

from game.journal.records import Covered, Debriefed, Interruption, Preflighted, Resumed, TakenOver
from game.study.folder import Identity, Study, open_study
from game.study.links import LINK, panel_pseudonym, study_key, token
from game.study.lock import SessionLock
from game.web.hosted import COVERED, Goodbye, Limits
from tests.study.participant import TerminalParticipant
from tests.study.people import cut_off, finished_study, journal_of, small_study
from tests.study.server import ANA
from tests.web.client import TAB, WebTerminal, get
from tests.web.pages import told_by
from tests.web.served import Served, until

READY = "arrow keys"
"""On the first screen of a study; nothing is recorded before someone has agreed."""
MAP = "Memorise the map"
TO_NOTICE_S = 1.0
"""In so long a program has seen that its window has another size, even on a busy machine."""
P01, P02 = (Identity("live", name) for name in ("P01", "P02"))


@pytest.fixture(scope="module")
def study(tmp_path_factory: pytest.TempPathFactory) -> Study:
    return small_study(tmp_path_factory.mktemp("web") / "a study")


@pytest.fixture(scope="module")
def served(study: Study) -> Iterator[Served]:
    with Served(study) as server:
        yield server


def enter(server: Served, participant: str, tab: str = TAB) -> WebTerminal:
    """Open a participant's link, and the line that its page would."""
    status, page, _ = get(server.link(participant))
    assert status == 200
    return WebTerminal(server.address, told_by(page)["ticket"], tab=tab)


def ana_study(name: str, study: Study, *arguments: str) -> subprocess.CompletedProcess[str]:
    """Run `ana study NAME DIR ...`."""
    command = [str(ANA), "study", name, str(study.folder), *arguments]
    return subprocess.run(command, capture_output=True, text=True, timeout=60)


def test_the_server_says_how_participants_come_in(served: Served) -> None:
    expected = (
        f"participants come to {served.address} (Ctrl+C ends this)",
        f"ana study invite {served.study.folder} P01 P02 ... --url {served.address}",
        f"{served.address}?PROLIFIC_PID=ID",
    )
    until(lambda: all(line in "".join(served.said) for line in expected))


def test_an_invitations_link_opens_the_study(served: Served) -> None:
    invited = ana_study("invite", served.study, "P05", "P06", "--url", served.address)
    links = dict(line.split("\t") for line in invited.stdout.splitlines())
    assert list(links) == ["P05", "P06"]
    status, page, _ = get(links["P05"])
    assert status == 200
    with WebTerminal(served.address, told_by(page)["ticket"]) as terminal:
        terminal.wait_for(READY)
        (program,) = served.programs("P05")
        told = psutil.Process(program).environ()
        assert told["ANA_PARTICIPANT"] == "P05"
        assert "SECRET_OF_THE_SERVER" not in told
        parent = psutil.Process(program).ppid()
        assert parent == served.process.pid, "there is no shell in between"
        assert os.getsid(program) == program, "it has a session of its own"


def test_a_wrong_token_gets_a_page_that_says_so_and_no_line(served: Served) -> None:
    for link in ("P01.AAAAAAAAAAAAAAAAAAAAAA", "P01", token(b"x" * 32, "P01")):
        status, page, _ = get(f"{served.address}?{LINK}={link}")
        assert status == 403
        assert "This link does not work" in page
        with pytest.raises(aiohttp.WSServerHandshakeError) as refused:
            WebTerminal(served.address, link)
        assert refused.value.status == 403


def test_a_foreign_origin_gets_no_line(served: Served) -> None:
    with pytest.raises(aiohttp.WSServerHandshakeError) as refused:
        WebTerminal(served.address, served.ticket("P01"), Origin="https://evil.example")
    assert refused.value.status == 403


def test_a_panels_participant_is_nobody_by_name(served: Served) -> None:
    panel_id = "5f0a1b2c3d4e5f6071829304"
    name = panel_pseudonym(study_key(served.study.folder), panel_id)
    cut_off(served.study, Identity("live", name), at="memorise")
    invited = ana_study("invite", served.study, "--panel", panel_id)
    assert invited.stdout.startswith(f"{name}\t")
    status, page, _ = get(f"{served.address}?PROLIFIC_PID={panel_id}&STUDY_ID=1&SESSION_ID=2")
    assert status == 200
    with WebTerminal(served.address, told_by(page)["ticket"]) as terminal:
        terminal.wait_for(MAP)
    assert not [it for it in files(served.study) if panel_id.encode() in it.read_bytes()]


def files(study: Study) -> list[Path]:
    return [it for it in study.folder.rglob("*") if it.is_file()]


def test_no_address_is_in_any_file(served: Served) -> None:
    with enter(served, "P09") as terminal:
        terminal.wait_for(READY)
    assert not [it for it in files(served.study) if b"127.0.0.1" in it.read_bytes()]
    assert "127.0.0.1" not in "".join(served.said)


# --- coming back --------------------------------------------------------------------------------


def test_a_dropped_line_finds_the_running_program_and_the_gap_is_covered_time(
    served: Served,
) -> None:
    cut_off(served.study, P02, at="memorise")
    with enter(served, "P02") as terminal:
        terminal.wait_for(MAP)
        programs = served.programs("P02")
        terminal.drop()
        terminal.wait_closed()
    (program,) = programs
    until(lambda: window_of(program) == COVERED)
    time.sleep(TO_NOTICE_S)
    terminal = enter(served, "P02")
    with terminal:
        terminal.wait_for(MAP)
        assert served.programs("P02") == programs != []
        terminal.read_for(0.5)
        terminal.press("enter")
        until(lambda: b'"memorise"' in journal_path(served.study, P02).read_bytes())
    kinds = [type(entry.record) for entry in journal_of(served.study, P02).entries]
    assert Covered in kinds
    assert kinds.count(Resumed) == 1, "from the cut before, not from the dropped line"


def window_of(program: int) -> tuple[int, int]:
    """The size that a program's terminal has now, in columns and rows."""
    line = os.open(f"/proc/{program}/fd/0", os.O_RDONLY | os.O_NOCTTY)
    try:
        size = os.get_terminal_size(line)
        return size.columns, size.lines
    finally:
        os.close(line)


def journal_path(study: Study, identity: Identity) -> Path:
    return study.home(identity) / "journal.jsonl"


def test_a_second_window_takes_over_and_the_first_stays_out(served: Served) -> None:
    identity = Identity("live", "P07")
    cut_off(served.study, identity, at="memorise")
    with enter(served, "P07") as first:
        first.wait_for(MAP)
        programs = served.programs("P07")
        with enter(served, "P07", tab="second12") as second:
            assert first.wait_closed() == Goodbye.ELSEWHERE
            second.wait_for(MAP)
            assert served.programs("P07") == programs != []
            second.read_for(0.5)
            assert second.code is None
    kinds = [type(entry.record) for entry in journal_of(served.study, identity).entries]
    assert TakenOver not in kinds


def test_whoever_is_logged_in_elsewhere_is_asked_as_over_ssh(served: Served) -> None:
    home = served.study.home(Identity("live", "P08"))
    home.mkdir(parents=True)
    lock = SessionLock(home)
    try:
        with enter(served, "P08") as terminal:
            terminal.wait_for(served.study.texts.words.busy.title)
    finally:
        lock.release()


# --- the end ------------------------------------------------------------------------------------


@pytest.mark.slow
def test_whoever_finished_gets_the_code_and_the_way_back(tmp_path: Path) -> None:
    study = finished_study(tmp_path / "study")
    path = study.folder / "study.toml"
    panel = 'return_url = "https://panel.example/done?cc={code}"'
    path.write_text(path.read_text().replace('return_url = ""', panel))
    assert ana_study("amend", study, "--why", "panel").returncode == 0
    with Served(open_study(study.folder)) as server:
        ticket = server.ticket("P01", pilot=True)
        with WebTerminal(server.address, ticket) as terminal:
            terminal.wait_for(study.texts.debrief.title)
            terminal.read_for(1)
            terminal.press("enter")
            assert terminal.wait_closed(20) == Goodbye.ENDED
            told = json.loads(terminal.told[-1])
    codes = {it.record.completion_code for it in journal_of(study).entries
             if isinstance(it.record, Debriefed)}  # fmt: skip
    assert codes == {told["code"]}
    assert told["url"] == f"https://panel.example/done?cc={told['code']}"
    assert told["status"] == 0


def half_way(folder: Path) -> Study:
    """A study with two participants who were cut off while they memorised the map."""
    study = small_study(folder)
    for identity in (P01, P02):
        cut_off(study, identity, at="memorise")
    return study


@pytest.mark.parametrize(
    "number",
    [
        signal.SIGTERM,
        pytest.param(signal.SIGINT, marks=pytest.mark.slow),
        pytest.param(signal.SIGHUP, marks=pytest.mark.slow),
    ],
)
def test_a_server_that_is_ended_leaves_nothing_behind(tmp_path: Path, number: int) -> None:
    study = half_way(tmp_path / "study")
    with Served(study) as server:
        with enter(server, "P01") as first, enter(server, "P02") as second:
            first.wait_for(MAP)
            second.wait_for(MAP)
            server.process.send_signal(number)
            assert [it.wait_closed() for it in (first, second)] == [Goodbye.STOPPING] * 2
            assert server.process.wait(10) == 0
        assert server.programs() == []
    assert_hung_up(study)


def test_a_server_that_is_killed_leaves_nothing_behind(tmp_path: Path) -> None:
    study = half_way(tmp_path / "study")
    with Served(study) as server, enter(server, "P01") as first, enter(server, "P02") as second:
        first.wait_for(MAP)
        second.wait_for(MAP)
        os.kill(server.process.pid, signal.SIGKILL)
        server.process.wait(10)
        until(lambda: not server.programs(), 10)
    assert_hung_up(study)


def assert_hung_up(study: Study) -> None:
    for identity in (P01, P02):
        SessionLock(study.home(identity)).release()
        records = [entry.record for entry in journal_of(study, identity).entries]
        assert Interruption("hang_up", signal="SIGHUP") in records


@pytest.mark.slow
def test_a_line_away_for_too_long_is_hung_up_and_the_next_resumes(tmp_path: Path) -> None:
    study = half_way(tmp_path / "study")
    with Served(study, limits=Limits(away_s=0.5)) as server:
        for _ in range(2):
            with enter(server, "P01") as terminal:
                terminal.wait_for(MAP)
            until(lambda: not server.programs())
    kinds = [type(entry.record) for entry in journal_of(study, P01).entries]
    assert kinds.count(Resumed) == 2


# --- wrong from the start -----------------------------------------------------------------------


def test_a_port_in_use_is_named(served: Served) -> None:
    refused = ana_study("serve", served.study, "--port", str(served.port))
    assert refused.returncode == 2
    assert f"port {served.port}" in refused.stderr
    assert "--port" in refused.stderr


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (("invite", "P01", "../P02"), "'../P02' is not a participant ID"),
        (("invite", "P01", "--url", "lab.example"), "not the address of a website"),
        (("serve", "--url", "lab.example"), "not the address of a website"),
        (("serve", "--host", "no such host"), "no such host"),
    ],
)
def test_wrong_arguments_are_refused_and_nothing_is_printed(
    served: Served, arguments: tuple[str, ...], said: str
) -> None:
    name, *others = arguments
    refused = ana_study(name, served.study, *others)
    assert refused.returncode == 2
    assert said in refused.stderr
    assert refused.stdout == ""


def test_only_those_on_the_roster_are_invited(tmp_path: Path) -> None:
    study = small_study(tmp_path / "study")
    (study.folder / "roster.csv").write_text("P01\nP02\n")
    refused = ana_study("invite", study, "P01", "P03")
    assert refused.returncode == 2
    assert "P03 is not on the roster" in refused.stderr
    assert refused.stdout == ""
    assert ana_study("invite", study, "P02").returncode == 0


# --- a whole session ----------------------------------------------------------------------------


def test_a_preflight_in_a_browser_is_one_in_a_terminal(served: Served) -> None:
    with enter(served, "P10") as terminal:
        identity = Identity("live", "P10")
        person = TerminalParticipant(terminal, served.study, identity)
        person.preflight()
        person.consent()
    (preflight,) = (
        it.record
        for it in journal_of(served.study, identity).entries
        if isinstance(it.record, Preflighted)
    )
    assert (preflight.terminal.columns, preflight.terminal.rows) == (120, 40)
    assert preflight.colours == "truecolor"
