"""`ana verify`: does a journal replay to the same mission and the same instructions?"""

from __future__ import annotations

from pathlib import Path

import click

from game.session.verification import verify_files


@click.command(name="verify")
@click.argument("journals", nargs=-1, required=True, type=click.Path(path_type=Path))
def verify_command(journals: tuple[Path, ...]) -> int:
    """Replay JOURNALS from their recorded actions and compare every derived record.

    Exit status 0: all match; 1: one does not, and the first difference is named; 2: a file is not
    a journal.
    """
    return verify_files(journals, click.echo)
