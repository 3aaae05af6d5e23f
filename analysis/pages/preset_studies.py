"""Several simulated studies side by side: every preset over several kinds of people."""

import gzip
from collections.abc import Mapping
from pathlib import Path

import pandas as pd

from analysis.pages.mission_rows import missions
from analysis.sources.absent import SourceError
from analysis.sources.recorded import Recorded
from analysis.stats.groups import grouped

FILE = "behaviour.csv.gz"
PRESETS = ("floodfill", "calibrated", "literal", "fig10", "released")
POPULATIONS = ("default", "hasty", "careful")
#: What tells the studies apart: the coach's preset and the kind of people.
BY = ["preset", "people"]

Key = tuple[str, str]


def missions_of(recorded: Recorded) -> pd.DataFrame:
    """The missions of one study, as `missions` has them. Groups are formed in it, and nobody is
    left out: whether somebody disobeys depends on the preset."""
    study, _ = grouped(recorded.study())
    return missions(recorded, study)


def write_missions(studies: Mapping[Key, pd.DataFrame], folder: Path) -> Path:
    """Write the missions of several studies, each by preset and kind of people, into `folder`."""
    parts = [
        part.assign(preset=preset, people=people) for (preset, people), part in studies.items()
    ]
    path = folder / FILE
    table = pd.concat(parts, ignore_index=True)
    text = table.to_csv(index=False, lineterminator="\n", float_format="%.9g")
    path.write_bytes(gzip.compress(text.encode(), 9, mtime=0))
    return path


def read_missions(folder: Path) -> pd.DataFrame:
    """The missions of several studies that lie beside the tables of one.

    Raises SourceError where there are none.
    """
    path = folder / FILE
    if not path.is_file():
        raise SourceError(
            "there are no missions of other simulated studies here",
            place=str(path),
            hint="`make reproduce` simulates them",
        )
    return pd.read_csv(path)
