"""`ana study run` and `ana study login`: a participant at a terminal.

Whatever fails is shown to them on a page, in the study's own words where it has any.
"""

from __future__ import annotations

import os
import signal
import sys
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

import click

from game.errors import STATUS_DEFECT, STATUS_TROUBLE, AnaError

if TYPE_CHECKING:
    from game.study.texts import Login, Texts

FROM_THE_KEYBOARD = (signal.SIGINT, signal.SIGQUIT, signal.SIGTSTP)

_NOTHING_WORKS = "The study cannot continue here. Please tell the experimenter."


def take_part_here(folder: Path, participant: str, *, pilot: bool) -> int:
    """Let a participant take part at this terminal; the exit status."""
    for number in FROM_THE_KEYBOARD:
        signal.signal(number, signal.SIG_IGN)
    try:
        from game.screens.study.app import run_session
        from game.study.folder import identify, open_study, refuse_other_accounts

        refuse_other_accounts(folder, f"ana study run {folder} --participant {participant}")
        identity = identify(participant, pilot=pilot)
        return run_session(open_study(folder), identity)
    except AnaError:
        raise
    except Exception as error:
        return _cannot_go_on(error)


def let_in_over_ssh(folder: Path, *, pilot: bool) -> int:
    """Let whoever logged in over SSH take part; the exit status."""
    if not (sys.stdin.isatty() and sys.stdout.isatty()):
        raise AnaError(
            "this login is for taking part in a study, and needs a terminal",
            hint="Log in without a command: ssh ACCOUNT@HOST",
        )
    for number in (signal.SIGQUIT, signal.SIGTSTP):
        signal.signal(number, signal.SIG_IGN)
    texts = None
    try:
        from game.study.folder import identify, open_study, refuse_other_accounts
        from game.study.lab.sshd import who_logs_in
        from game.study.texts import shipped_texts

        texts = shipped_texts()
        refuse_other_accounts(folder, f"ana study login {folder}")
        study = open_study(folder)
        texts = study.texts
        participant = who_logs_in(os.environ, partial(_ask_for_id, texts.login))
        signal.signal(signal.SIGINT, signal.SIG_IGN)
        from game.screens.study.app import run_session

        return run_session(study, identify(participant, pilot=pilot))
    except AnaError as error:
        from game.screens.study.fault import log_to_system, tell_plainly
        from game.study.texts import filled, shipped_texts

        log_to_system(str(error))
        words = (texts or shipped_texts()).words
        tell_plainly(filled(words.trouble, problem=error.message))
        return STATUS_TROUBLE
    except Exception as error:
        return _cannot_go_on(error, texts)


def _cannot_go_on(error: Exception, texts: Texts | None = None) -> int:
    """Show the participant that something failed which nobody expected; the exit status."""
    try:
        from game.screens.study.fault import cannot_go_on
        from game.study.texts import shipped_texts

        return cannot_go_on(error, texts or shipped_texts())
    except Exception:
        click.echo(f"\n{_NOTHING_WORKS}\n", err=True)
        return STATUS_DEFECT


def _ask_for_id(words: Login, refused: str) -> str:
    if refused:
        click.echo(f"\n  {words.wrong.replace('{id}', refused)}")
    try:
        return input(f"\n  {words.ask} ")
    except EOFError:
        raise click.Abort from None
    except UnicodeDecodeError:
        return "?"
