"""Finds out what kind of source was given, and reads it into tidy tables."""

from pathlib import Path

from analysis.absent import SourceError
from analysis.longcsv import read_long_csv
from analysis.tables import Study


def load_study(source: Path, quiz: Path | None = None) -> Study:
    """Read one long CSV, with quiz scores if given.

    Raises SourceError naming the place and the mend.
    """
    if source.is_dir():
        raise SourceError(f"{source}: this is a folder; give one long CSV file")
    return read_long_csv(source, quiz)
