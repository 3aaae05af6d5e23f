"""`ana verify`: does a journal replay to the same mission and the same instructions?"""

from __future__ import annotations

from pathlib import Path

import click

from game.journal.folders import all_journals
from game.journal.records import STUDY_MODES
from game.session.verification import verify_files


@click.command(name="verify")
@click.argument("journals", nargs=-1, required=True, type=click.Path(path_type=Path))
def verify_command(journals: tuple[Path, ...]) -> int:
    """Replay JOURNALS from their recorded actions and compare every derived record.

    A folder stands for the session in it, or for all sessions of a study.

    Exit status 0: all match; 1: one does not, and the first difference is named; 2: a file is not
    a journal.
    """
    from game.study.lab.sessions import refuse_unlike_ledger

    paths: list[Path] = []
    for given in journals:
        if given.is_dir():
            paths += all_journals(given)
            for mode in STUDY_MODES:
                refuse_unlike_ledger(given, mode)
        else:
            paths.append(given)
    return verify_files(paths, click.echo)
