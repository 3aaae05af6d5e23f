"""The `ana` command as a user sees it: what it prints, where, and its exit status."""

import os
import pty
import subprocess
import sys
import threading
import time
from collections.abc import Callable

import click
import pytest

from game import __version__
from game.cli import ana, main
from game.errors import AnaError
from game.lazy import LazyCommand

Capture = pytest.CaptureFixture[str]


@pytest.fixture
def command_that(monkeypatch: pytest.MonkeyPatch) -> Callable[[Callable[[], int | None]], None]:
    """Adds a command `probe` that runs the given function."""

    def add(run: Callable[[], int | None]) -> None:
        probe = click.Command("probe", callback=run)
        monkeypatch.setitem(ana.commands, "probe", probe)

    return add


def raising(error: BaseException) -> Callable[[], int | None]:
    def run() -> int | None:
        raise error

    return run


def test_version(capsys: Capture) -> None:
    assert main(["--version"]) == 0
    assert capsys.readouterr().out == f"ana {__version__}\n"


def test_python_m_game_is_ana() -> None:
    run = subprocess.run([sys.executable, "-m", "game", "--version"], capture_output=True)
    assert (run.returncode, run.stdout.decode()) == (0, f"ana {__version__}\n")


def test_help_lists_every_command_in_the_order_of_the_table(capsys: Capture) -> None:
    assert main(["--help"]) == 0
    listed = capsys.readouterr().out.partition("Play:\n")[2]
    rows = [line.split() for line in listed.splitlines() if line]
    assert [row[0] for row in rows if len(row) > 2] == list(ana.commands)
    headings = [row for row in rows if len(row) <= 2]
    assert headings == [["Study:"], ["This", "computer:"]]


@pytest.mark.parametrize(
    ("args", "suggestion"),
    [
        (["docter"], "No such command 'docter'. Did you mean 'doctor'?"),
        (["--versoin"], "No such option '--versoin'. Did you mean '--version'?"),
        (["doctor", "--jsn"], "No such option '--jsn'. Did you mean '--json'?"),
    ],
)
def test_a_typo_gets_the_nearest_right_word(
    args: list[str], suggestion: str, capsys: Capture
) -> None:
    assert main(args) == 2
    out, err = capsys.readouterr()
    assert out == ""
    assert err.startswith(f"ana: {suggestion}\nTry 'ana")


def test_a_users_error_goes_to_the_error_stream(
    command_that: Callable[[Callable[[], int | None]], None], capsys: Capture
) -> None:
    command_that(raising(AnaError("row 3 is short", place="a.txt, line 5", hint="Add 2 cells.")))
    assert main(["probe"]) == 2
    assert capsys.readouterr() == ("", "ana: a.txt, line 5: row 3 is short. Add 2 cells.\n")


def test_a_command_of_a_tier_that_is_not_installed_says_how_to_install_it() -> None:
    program = (
        "import sys; sys.modules['numpy'] = None\n"
        "from game.cli import main; sys.exit(main(['analyse', 'study', '--json', 'out.json']))"
    )
    run = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True)
    assert (run.returncode, run.stdout) == (2, "")
    assert run.stderr.startswith("ana: ana analyse: this command needs the Python package numpy")
    assert "make test" in run.stderr
    assert "pip install --require-hashes --requirement requirements/all.txt" in run.stderr


@pytest.mark.parametrize("target", ["game.nowhere:command", "analysis.nowhere:command"])
def test_a_missing_module_of_our_own_is_a_bug(target: str) -> None:
    with pytest.raises(ModuleNotFoundError):
        LazyCommand("probe", target, "A probe.").load()


def test_a_bug_is_not_reported_as_a_users_error(
    command_that: Callable[[Callable[[], int | None]], None],
) -> None:
    command_that(raising(ZeroDivisionError()))
    with pytest.raises(ZeroDivisionError):
        main(["probe"])


@pytest.mark.parametrize(("returned", "status"), [(None, 0), (0, 0), (1, 1)])
def test_a_commands_return_value_is_the_exit_status(
    returned: int | None,
    status: int,
    command_that: Callable[[Callable[[], int | None]], None],
) -> None:
    command_that(lambda: returned)
    assert main(["probe"]) == status


def test_an_interrupt_gives_130(
    command_that: Callable[[Callable[[], int | None]], None],
) -> None:
    command_that(raising(KeyboardInterrupt()))
    assert main(["probe"]) == 130


def test_a_closed_pipe_is_quiet() -> None:
    read_end, write_end = os.pipe()
    os.close(read_end)
    run = subprocess.run(
        [sys.executable, "-m", "game", "--help"], stdout=write_end, stderr=subprocess.PIPE
    )
    os.close(write_end)
    assert (run.returncode, run.stderr) == (1, b"")


NOT_IN_THE_GAME_TIER = (
    "aiohttp", "dask", "matplotlib", "numpy", "pandas", "pingouin", "scipy", "statsmodels",
    "textual_serve",
)  # fmt: skip


def test_every_help_can_be_read_where_only_the_game_is_installed() -> None:
    """A process without the other packages shows the help of every command and subcommand."""
    program = f"""
import sys
for name in {NOT_IN_THE_GAME_TIER!r}:
    sys.modules[name] = None
import click
from game.cli import ana, main
from game.lazy import LazyCommand
def helped(words, command):
    assert main([*words, "--help"]) == 0, words
    command = command.load() if isinstance(command, LazyCommand) else command
    for name, under in getattr(command, "commands", {{}}).items():
        helped([*words, name], under)
helped([], ana)
"""
    run = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True)
    assert (run.returncode, run.stderr) == (0, "")
    for command in ("play", "analyse", "compare", "study new", "study serve", "building show"):
        assert f"Usage: ana {command}" in run.stdout


@pytest.mark.parametrize("shell", ["bash", "zsh", "fish"])
def test_completion_script(shell: str, capsys: Capture, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("SHELL", f"/bin/{shell}")
    assert main(["completion", shell]) == 0
    named = capsys.readouterr().out
    assert main(["completion"]) == 0
    assert capsys.readouterr().out == named
    assert f"_ANA_COMPLETE={shell}_complete" in named


def test_completion_of_an_unknown_shell(capsys: Capture, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("SHELL", "/bin/tcsh")
    assert main(["completion"]) == 2
    assert "'tcsh'" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("words", "expected"),
    [
        ("ana doc", ["doctor"]),
        ("ana doctor --j", ["--json"]),
        ("ana play --building ha", ["harbour"]),
        ("ana play --building gen", ["generated:"]),
        ("ana play --coach yo", ["yoked"]),
        ("ana play --preset cal", ["calibrated"]),
        ("ana play --difficulty h", ["hard"]),
        ("ana play --victims s", ["seeded"]),
        ("ana play --set controls=t", ["controls=turn"]),
        ("ana play --set moves", ["moves_per_second=5.0"]),
        ("ana watch --rescuer new", ["newcomer"]),
        ("ana building show foun", ["foundry"]),
        ("ana simulate out --population has", ["hasty"]),
        ("ana compare --worlds default,ha", ["default,hasty"]),
        ("ana compare --buildings harbour,f", ["harbour,foundry"]),
    ],
)
def test_the_shell_gets_its_completions(
    words: str, expected: list[str], capsys: Capture, monkeypatch: pytest.MonkeyPatch
) -> None:
    for name, value in asked_by_bash(words).items():
        monkeypatch.setenv(name, value)
    with pytest.raises(SystemExit):
        main([])
    assert [line.partition(",")[2] for line in capsys.readouterr().out.splitlines()] == expected


@pytest.mark.parametrize(
    ("words", "expected"),
    [("ana doc", "plain,doctor\n"), ("ana play --victims s", "plain,seeded\n")],
)
def test_a_shell_is_answered_by_a_process(words: str, expected: str) -> None:
    run = subprocess.run(
        [sys.executable, "-m", "game"],
        env=os.environ | asked_by_bash(words),
        capture_output=True,
        text=True,
    )
    assert run.stdout == expected


def asked_by_bash(words: str) -> dict[str, str]:
    """The environment in which bash asks for what completes the last of these words."""
    return {
        "_ANA_COMPLETE": "bash_complete",
        "COMP_WORDS": words,
        "COMP_CWORD": str(len(words.split()) - 1),
    }


def in_a_terminal(args: list[str], keys: list[bytes], env: dict[str, str]) -> tuple[int, str]:
    """Run `ana` in a pseudo-terminal, and type `keys` once it asks for one."""
    controller, terminal = pty.openpty()
    process = subprocess.Popen(
        [sys.executable, "-m", "game", *args],
        stdin=terminal,
        stdout=terminal,
        stderr=terminal,
        env=os.environ | env,
    )
    os.close(terminal)
    shown = b""

    def type_keys() -> None:
        for key in keys:
            os.write(controller, key)
            time.sleep(0.4)

    typist = threading.Thread(target=type_keys)
    try:
        while chunk := os.read(controller, 4096):
            shown += chunk
            if b"arrow key ..." in shown and not typist.ident:
                typist.start()
    except OSError:
        pass
    if typist.ident:
        typist.join()
    os.close(controller)
    return process.wait(10), shown.decode()


def test_doctor_reads_an_arrow_key_in_a_terminal() -> None:
    env = {"TERM": "xterm-256color"}
    _, shown = in_a_terminal(["doctor"], [b"\x1b[A"], env)
    assert "up arrow, complete within" in shown


def test_doctor_notices_an_arrow_key_in_pieces() -> None:
    env = {"TERM": "xterm-256color", "ESCDELAY": "20"}
    status, shown = in_a_terminal(["doctor"], [b"\x1b", b"[B"], env)
    assert status == 1
    assert "down arrow, in pieces over" in shown
    assert "set ESCDELAY=" in shown
