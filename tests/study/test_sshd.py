"""Participants over SSH, against a real OpenSSH server on the loopback."""

from __future__ import annotations

import signal
import subprocess
from collections.abc import Iterator
from pathlib import Path

import pytest

from game.journal.records import Preflighted, TakenOver
from game.study.folder import Identity, Study, StudyError
from game.study.lab.sshd import LoopbackServer, configuration, who_logs_in
from tests.study.participant import TerminalParticipant
from tests.study.people import cut_off, journal_of, small_study
from tests.study.server import BY_KEY, SSH, SSHD, Server, login
from tests.terminal import Terminal

pytestmark = pytest.mark.long
needs_sshd = pytest.mark.skipif(
    SSHD is None or SSH is None, reason="OpenSSH's server or client is not installed"
)
P02, P04, P07 = (Identity("live", name) for name in ("P02", "P04", "P07"))
REFUSAL = "needs a terminal"
SHELL_SIGNS = ("uid=", "root@", "$ ", "# ")


@pytest.fixture(scope="module")
def study(tmp_path_factory: pytest.TempPathFactory) -> Study:
    return small_study(tmp_path_factory.mktemp("ssh") / "a study")


@pytest.fixture(scope="module")
def server(study: Study, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Server]:
    options = {f"p0{number}": BY_KEY.format(f"P0{number}") for number in range(1, 5)}
    options |= {"odd": BY_KEY.format("../P01"), "lab": "restrict,pty"}
    folder = tmp_path_factory.mktemp("server") / "keys"
    with Server(study.folder, folder, options) as running:
        yield running


def run(command: list[str], **keywords: object) -> subprocess.CompletedProcess[str]:
    return subprocess.run(  # type: ignore[call-overload,no-any-return]
        command, capture_output=True, text=True, timeout=30, **keywords
    )


# --- what the configuration says ----------------------------------------------------------------


def test_a_system_configuration_names_account_program_and_folder(tmp_path: Path) -> None:
    folder = tmp_path / "it's a study"
    text = configuration(folder, "taker", Path("/opt/ana/bin/ana"))
    assert "Match User taker\n" in text
    quoted = f"'{tmp_path}/it'\"'\"'s a study'"
    assert f"ForceCommand exec /opt/ana/bin/ana study login {quoted}\n" in text
    before, _, _ = text.partition("Match User")
    assert "ForceCommand" not in before
    assert "Port" not in before


@needs_sshd
def test_the_server_holds_participants_to_a_terminal_and_nothing_else(server: Server) -> None:
    holds = server.effective()
    assert " study login " in holds["forcecommand"]
    assert holds["disableforwarding"] == "yes"
    assert holds["permittunnel"] == "no"
    assert holds["permituserrc"] == "no"
    assert holds["permittty"] == "yes"
    assert holds["maxsessions"] == "1"
    assert (holds["clientaliveinterval"], holds["clientalivecountmax"]) == ("15", "3")
    assert holds["acceptenv"].split() == ["COLORTERM", "LANG", "LC_*"]
    assert holds["permituserenvironment"] == "ANA_PARTICIPANT"


@needs_sshd
def test_the_system_configuration_is_one_that_sshd_accepts(server: Server, tmp_path: Path) -> None:
    assert SSHD is not None
    text = configuration(tmp_path, "taker", Path("/opt/ana/bin/ana"))
    whole = tmp_path / "sshd_config"
    whole.write_text(f"HostKey {server.folder / 'host_key'}\n{text}")
    assert run([SSHD, "-t", "-f", str(whole)]).returncode == 0


def test_a_test_server_stays_on_the_loopback(tmp_path: Path) -> None:
    text = configuration(tmp_path, "me", Path("/bin/ana"), LoopbackServer(2222, tmp_path / "keys"))
    assert "\nListenAddress 127.0.0.1\nPort 2222\n" in text


# --- who has logged in --------------------------------------------------------------------------


def test_the_key_decides_whose_session_it_is() -> None:
    def never(_: str) -> str:
        raise AssertionError("asked")

    assert who_logs_in({"ANA_PARTICIPANT": "P01"}, never) == "P01"
    with pytest.raises(StudyError):
        who_logs_in({"ANA_PARTICIPANT": "a b"}, never)


def test_the_id_is_asked_for_until_it_is_valid() -> None:
    answers, told = iter(["; sh", " P07 "]), []

    def ask(refused: str) -> str:
        told.append(refused)
        return next(answers)

    assert who_logs_in({}, ask) == "P07"
    assert told == ["", "; sh"]
    with pytest.raises(StudyError, match="no participant ID"):
        who_logs_in({}, lambda _: "$(sh)")


# --- nothing but the study ----------------------------------------------------------------------


@needs_sshd
@pytest.mark.parametrize("asked", [("id",), ("-T",), ("sh", "-c", "id"), ("-T", "scp", "-f", "/")])
def test_without_a_terminal_there_is_a_clear_refusal(
    server: Server, asked: tuple[str, ...]
) -> None:
    done = run(server.ssh("p01", *asked), stdin=subprocess.DEVNULL)
    assert (done.returncode, done.stdout) == (2, "")
    assert REFUSAL in done.stderr


@needs_sshd
def test_no_files_go_over_sftp(server: Server, tmp_path: Path) -> None:
    subsystem = server.ssh("p01")
    done = run([*subsystem[:-1], "-s", subsystem[-1], "sftp"], input="")
    assert done.returncode != 0
    assert done.stdout == ""


@needs_sshd
def test_nothing_is_forwarded(server: Server) -> None:
    inward = run(server.ssh("p01", "-W", f"127.0.0.1:{server.port}"), input="")
    assert inward.returncode != 0
    assert "SSH-2.0" not in inward.stdout
    strict = ("ExitOnForwardFailure=yes", "LogLevel=INFO")
    outward = run(
        server.ssh("p01", "-N", "-R", "0:127.0.0.1:1", options=strict), stdin=subprocess.DEVNULL
    )
    assert outward.returncode != 0
    assert "remote port forwarding failed" in outward.stderr


@needs_sshd
def test_a_clients_command_is_not_carried_out(server: Server) -> None:
    with login(server, "p01", "-tt", "id; sh") as terminal:
        shown = terminal.wait_for("Before you begin")
        assert "uid=" not in shown


@needs_sshd
@pytest.mark.parametrize("key", ["p01", "lab"])
def test_no_key_leads_out_of_the_study(server: Server, key: str) -> None:
    first = {"p01": "Before you begin", "lab": "participant ID"}[key]
    keys = [b"\x1a", b"\x1c", b"\x10", b"\x1b", b"!sh\r", b"id\r", b"\x11", b"\x04", b"\x03"]
    while keys:
        with login(server, key) as terminal:
            terminal.wait_for(first)
            while keys and terminal.read_for(0.1):
                terminal.write(keys.pop(0))
                terminal.read_for(0.2)
                terminal.write(b"id\r")
            terminal.read_for(0.3)
            shown = terminal.text()
            assert not [sign for sign in SHELL_SIGNS if sign in shown], shown


@needs_sshd
def test_nobody_can_open_another_participants_session(server: Server, study: Study) -> None:
    pretended = ("SendEnv=ANA_PARTICIPANT", "SendEnv=PYTHONSTARTUP", "SendEnv=TEXTUAL_DRIVER")
    command = server.ssh("p02", options=pretended)
    env = {"ANA_PARTICIPANT": "P01", "TEXTUAL_DRIVER": "os:system"}
    with Terminal(command, columns=120, rows=40, env=env) as terminal:
        terminal.wait_for("Before you begin")
        assert (study.home(P02) / "lock").exists()
    with login(server, "odd") as terminal:
        assert terminal.wait() == 2
        assert "is not a participant ID" in terminal.text()


@needs_sshd
def test_a_shared_key_asks_for_the_id(server: Server, study: Study) -> None:
    with login(server, "lab") as terminal:
        terminal.wait_for("participant ID")
        terminal.write(b"../P01\r")
        terminal.wait_for("is not a participant ID")
        terminal.write(b"P07\r")
        terminal.wait_for("Before you begin")
        assert (study.home(P07) / "lock").exists()


# --- taking part --------------------------------------------------------------------------------


@needs_sshd
@pytest.mark.parametrize(
    ("participant", "term", "colorterm", "colours"),
    [
        ("C2", "tmux-256color", "", "256"),
        ("C3", "xterm-256color", "truecolor", "truecolor"),
        ("C4", "screen", "truecolor", "16"),
    ],
)
def test_the_terminal_behind_the_line_is_known(
    server: Server, study: Study, participant: str, term: str, colorterm: str, colours: str
) -> None:
    with login(server, "lab", TERM=term, COLORTERM=colorterm) as terminal:
        terminal.wait_for("participant ID")
        terminal.write(f"{participant}\r".encode())
        person = TerminalParticipant(terminal, study, Identity("live", participant))
        person.preflight()
        person.consent()
        raw = b"".join(chunk.data for chunk in terminal.chunks)
    records = [entry.record for entry in journal_of(study, Identity("live", participant)).entries]
    found = next(record for record in records if isinstance(record, Preflighted))
    assert (found.terminal.term, found.terminal.colorterm) == (term, colorterm)
    assert found.colours == colours
    assert (b"\x1b[38;2;" in raw or b"\x1b[48;2;" in raw) is (colours == "truecolor")
    assert (b"8;5;" in raw) is (colours == "256")


@needs_sshd
def test_a_suspended_client_is_taken_over(server: Server, study: Study) -> None:
    cut_off(study, P04, at="prefer")
    with login(server, "p04") as frozen:
        frozen.wait_for("Both instructors")
        frozen.kill(signal.SIGSTOP)
        with login(server, "p04") as terminal:
            terminal.wait_for("another window")
            terminal.press("y")
            terminal.wait_for("Both instructors")
        frozen.kill(signal.SIGCONT)
        assert frozen.wait() != 0
        assert not [sign for sign in SHELL_SIGNS if sign in frozen.text()]
    records = [entry.record for entry in journal_of(study, P04).entries]
    assert sum(isinstance(record, TakenOver) for record in records) == 1
