"""`ana study demo`: a study to try the experimenter's tools on."""

from __future__ import annotations

from functools import partial
from pathlib import Path

import click

from game.rescuers.person import world
from game.simulation.demonstration import UNDER_WAY, demonstrate
from game.simulation.workers import cores, on_cores

_TRY = """\
{folder}: a study with {participants} simulated people; {under_way} of them are in the middle.
Try:
  ana study status {folder} --watch
  ana study run {folder} --participant ME --pilot
  ana study serve {folder}        (and, beside it: ana study invite {folder} P01)
  ana study export {folder} {folder}-dataset --mode simulated
  ana verify {folder}
  ana analyse {folder} --json results.json
  make lab ANA_SOURCE={folder}"""


def demonstration(folder: Path, participants: int, seed: int) -> None:
    """Make the study, and say what can be tried; see `ana study demo --help`."""
    workers = partial(on_cores, jobs=cores())
    progress = demonstrate(folder, participants, seed, world("default"), workers)
    with click.progressbar(length=participants, label="Simulating", show_pos=True) as bar:
        before = 0
        for done in progress:
            bar.update(done - before)
            before = done
    under_way = len(UNDER_WAY)
    click.echo(_TRY.format(folder=folder, participants=participants, under_way=under_way))
