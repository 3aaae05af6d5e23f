"""`ana verify`: does a journal replay to the same mission and the same instructions?"""

from __future__ import annotations

from pathlib import Path

import click

from game.journal.folders import all_journals
from game.session.verification import verify_files


@click.command(name="verify")
@click.argument("journals", nargs=-1, required=True, type=click.Path(path_type=Path))
def verify_command(journals: tuple[Path, ...]) -> int:
    """Replay JOURNALS from their recorded actions and compare every derived record.

    A folder stands for the session in it, or for all sessions of a study.

    Exit status 0: all match; 1: one does not, and the first difference is named; 2: a file is not
    a journal.
    """
    paths = [
        path for given in journals for path in (all_journals(given) if given.is_dir() else (given,))
    ]
    return verify_files(paths, click.echo)
