"""`ana study`: set a study up, let participants in, amend it, let somebody withdraw."""

from __future__ import annotations

import signal
from pathlib import Path

import click

from game.lazy import LazyCommand, LazyGroup

_FOLDER = click.argument("folder", metavar="DIR", type=click.Path(path_type=Path))
FROM_THE_KEYBOARD = (signal.SIGINT, signal.SIGQUIT, signal.SIGTSTP)


@click.group(
    name="study",
    cls=LazyGroup,
    commands=[
        LazyCommand("status", "game.commands.lab:status", "Show who is where, and what is wrong."),
        LazyCommand(
            "export", "game.commands.lab:export", "Write a Psych-DS dataset with a codebook."
        ),
        LazyCommand("drop", "game.commands.lab:drop", "Record that somebody does not come back."),
        LazyCommand("close", "game.commands.lab:close", "End recruiting."),
        LazyCommand("sshd", "game.commands.lab:sshd", "Print the SSH server's configuration."),
        LazyCommand("login", "game.commands.lab:login", "What that server runs for a participant."),
    ],
)
def group() -> None:
    """Run the experiment: a study lives in a folder."""


@group.command()
@_FOLDER
@click.option("--seed", type=int, help="Decides who is allocated what (default: drawn).")
@click.option("--blocks", type=click.IntRange(1), default=5, show_default=True,
              help="How many times 24 places the study has.")  # fmt: skip
def new(folder: Path, seed: int | None, blocks: int) -> None:
    """Make the study folder DIR, with settings and texts to look through before you begin."""
    from game.study.folder import ITEMS, SETTINGS, TEXTS, new_study

    new_study(folder, seed, blocks)
    click.echo(
        f"{folder}: a new study. Look through {SETTINGS}, {TEXTS} and {ITEMS}, then try it:\n"
        f"  ana study run {folder} --participant TEST --pilot"
    )


@group.command()
@_FOLDER
@click.option("--participant", required=True, metavar="ID", help="A pseudonym, such as P01.")
@click.option("--pilot", is_flag=True, help="Try the study without taking a place in it.")
def run(folder: Path, participant: str, pilot: bool) -> int:
    """Let participant ID take part at this terminal, or go on where they were."""
    for number in FROM_THE_KEYBOARD:
        signal.signal(number, signal.SIG_IGN)
    from game.screens.study.app import run_session
    from game.study.folder import identify, open_study

    identity = identify(participant, pilot=pilot)
    return run_session(open_study(folder), identity)


@group.command()
@_FOLDER
@click.option("--why", required=True, metavar="TEXT", help="The reason, kept in the ledger.")
def amend(folder: Path, why: str) -> None:
    """Record that study.toml was changed after the first participant, and why."""
    from game.study.folder import amend as amend_study

    amend_study(folder, why)
    click.echo(f"{folder}: the change is recorded; sessions go on under the new settings")


@group.command()
@_FOLDER
@click.argument("participant", metavar="ID")
@click.option("--pilot", is_flag=True, help="A pilot session.")
def withdraw(folder: Path, participant: str, pilot: bool) -> None:
    """Delete all that was recorded of participant ID; the ledger keeps that they withdrew."""
    from game.study.folder import identify, open_study
    from game.study.withdraw import withdraw as withdraw_session

    identity = identify(participant, pilot=pilot)
    deleted = withdraw_session(open_study(folder), identity)
    told = "what was recorded is deleted" if deleted else "nothing had been recorded"
    click.echo(f"{participant} has withdrawn; {told}")
