"""The commands of `ana study` with which a lab watches a study, lets it in, and takes it out."""

from __future__ import annotations

import getpass
import os
import signal
import sys
import syslog
import tomllib
from functools import partial
from importlib import resources
from pathlib import Path
from typing import TYPE_CHECKING, cast

import click
import msgspec

from game.errors import AnaError

if TYPE_CHECKING:
    from game.study.ledger import Mode
    from game.study.overview import ExclusionRule
    from game.study.texts import Login

_FOLDER = click.argument("folder", metavar="DIR", type=click.Path(path_type=Path))
_MODES = ("live", "pilot", "simulated")
_STATUS_TROUBLE = 2
_UNBLINDED = "The study is open: the ledger records that it was unblinded."


@click.command()
@_FOLDER
@click.option("--watch", is_flag=True, help="Stay on the screen and follow; Q leaves.")
@click.option("--json", "as_json", is_flag=True, help="Print JSON.")
@click.option(
    "--unblind", is_flag=True, help="Tell counts by design cell too; the ledger records it."
)
def status(folder: Path, *, watch: bool, as_json: bool, unblind: bool) -> int:
    """Show who is where in the study DIR. Reads only, and tells nobody's allocation."""
    from game.study.overview import StatusReader, breakdown
    from game.study.statustext import page

    if watch:
        if as_json or unblind:
            raise click.UsageError("--watch goes alone.")
        from game.screens.lab.status_screen import watch_status

        return watch_status(folder)
    now = StatusReader(folder).look()
    shown = unblind or now.closed
    cells = breakdown(folder, _rules(), "ana study status --unblind") if shown else ()
    if as_json:
        told = msgspec.to_builtins(now) | ({"design_cells": cells} if shown else {})
        click.echo(msgspec.json.format(msgspec.json.encode(told), indent=2))
    else:
        click.echo("\n".join(page(now, cells)))
    return 0


@click.command()
@_FOLDER
@click.argument("out", metavar="OUT", type=click.Path(path_type=Path))
@click.option(
    "--mode",
    "modes",
    type=click.Choice(_MODES),
    multiple=True,
    default=("live",),
    show_default=True,
    help="Which sessions; may be given more than once. Modes never share a file.",
)
def export(folder: Path, out: Path, modes: tuple[str, ...]) -> None:
    """Write the study DIR to the folder OUT as a Psych-DS dataset with a codebook."""
    from game.study.export import export_study

    done = export_study(folder, out, cast("tuple[Mode, ...]", modes))
    for mode, sessions in done.sessions.items():
        click.echo(f"{out}: {mode} sessions {sessions}, rounds {done.rounds[mode]}")
    if done.unblinded:
        click.echo(_UNBLINDED, err=True)


def unblind(folder: Path, why: str) -> str:
    """Record that the allocation of the live participants was looked at, unless the study is
    closed; what to tell of it. A ledger that cannot be written stops nobody who has a copy."""
    from game.study.folder import LEDGER
    from game.study.ledger import Ledger, LedgerError, is_closed

    ledger = Ledger(folder / LEDGER)
    try:
        if is_closed(ledger.entries()):
            return ""
        ledger.unblind(why)
    except LedgerError as error:
        return f"This unblinds the study unless it is closed, and could not be recorded: {error}\n"
    return f"{_UNBLINDED}\n"


@click.command()
@_FOLDER
@click.argument("participant", metavar="ID")
def drop(folder: Path, participant: str) -> None:
    """Record that participant ID dropped out; what was recorded is kept."""
    from game.study.dropout import drop_out
    from game.study.folder import identify, open_study

    study = open_study(folder)
    drop_out(study, identify(participant))
    refilled = study.settings.refill_dropouts
    told = "the place is given out again" if refilled else "the place stays empty (study.toml)"
    click.echo(f"{participant} dropped out; {told}")


@click.command()
@_FOLDER
def close(folder: Path) -> None:
    """End recruiting in the study DIR: no more places are given out, nothing is concealed.

    Who has a place may finish. All others read that no place is left: newcomers at login, and
    whoever is in consent or practice now after practice.
    """
    from game.study.folder import open_study

    open_study(folder).ledger.close()
    click.echo(
        f"{folder}: closed. Who has a place may finish. All others read that no place is left: "
        "newcomers at login, and whoever is in consent or practice now after practice"
    )


@click.command()
@_FOLDER
@click.option("--account", help="The participants' account (default: DIR's owner).")
@click.option("--port", type=click.IntRange(1, 65535), help="For a test server of your own.")
@click.option("--keys", type=click.Path(path_type=Path), help="Where its keys are.")
def sshd(folder: Path, account: str | None, port: int | None, keys: Path | None) -> None:
    """Print the OpenSSH configuration that lets participants into the study DIR."""
    from game.study.folder import open_study
    from game.study.sshd import LoopbackServer, configuration, program

    if (port is None) is not (keys is None):
        raise click.UsageError("--port and --keys go together.")
    open_study(folder)
    loopback = None if port is None or keys is None else LoopbackServer(port, keys)
    user = account or (folder.owner() if loopback is None else getpass.getuser())
    click.echo(configuration(folder, user, program(), loopback), nl=False)


@click.command()
@_FOLDER
@click.option("--pilot", is_flag=True, help="Try the study without taking a place in it.")
def login(folder: Path, *, pilot: bool) -> int:
    """Let whoever has logged in over SSH take part in the study DIR.

    The ID is that of the key, or is asked for. What stands in the way is told in the study's words;
    where it lies and how to mend it is for the system's log.
    """
    if not (sys.stdin.isatty() and sys.stdout.isatty()):
        raise AnaError(
            "this login is for taking part in a study, and needs a terminal",
            mend="Log in without a command: ssh ACCOUNT@HOST",
        )
    for number in (signal.SIGQUIT, signal.SIGTSTP):
        signal.signal(number, signal.SIG_IGN)
    from game.study.folder import identify, open_study
    from game.study.sshd import who_logs_in
    from game.study.texts import filled, shipped_texts

    texts = shipped_texts()
    try:
        study = open_study(folder)
        texts = study.texts
        participant = who_logs_in(os.environ, partial(_ask_for_id, texts.login))
        signal.signal(signal.SIGINT, signal.SIG_IGN)
        from game.screens.study.app import run_session

        return run_session(study, identify(participant, pilot=pilot))
    except AnaError as error:
        syslog.openlog("ana")
        syslog.syslog(syslog.LOG_ERR, str(error))
        page = filled(texts.words.trouble, problem=error.message)
        click.echo(f"\n{page.title}\n\n{page.body.strip()}\n", err=True)
        return _STATUS_TROUBLE


def _ask_for_id(words: Login, refused: str) -> str:
    if refused:
        click.echo(f"\n  {words.wrong.replace('{id}', refused)}")
    try:
        return input(f"\n  {words.ask} ")
    except EOFError:
        raise click.Abort from None
    except UnicodeDecodeError:
        return "?"


def _rules() -> tuple[ExclusionRule, ...]:
    """The analysis' rules of exclusion, which are data."""
    from game.study.overview import ExclusionRule

    text = resources.files("analysis").joinpath("exclusions.toml").read_text(encoding="utf-8")
    return msgspec.convert(tomllib.loads(text)["rule"], tuple[ExclusionRule, ...])
