"""`ana simulate`: a whole study with simulated people."""

from __future__ import annotations

from functools import partial
from pathlib import Path

import click

from game.coach.presets import PRESETS
from game.coach.spec import DEFAULT_PRESET
from game.commands.offered import coaches, offering
from game.rescuers.person import POPULATIONS, world
from game.simulation.simulated_study import Workers, simulate
from game.simulation.workers import cores, here, on_cluster, on_cores
from game.study.folder import refuse_other_accounts
from game.study.study_settings import ADAPTIVE


@click.command(name="simulate")
@click.argument("folder", metavar="DIR", type=click.Path(path_type=Path))
@click.option("--participants", type=click.IntRange(1, 9999), required=True, metavar="N",
              help="How many people take part.")  # fmt: skip
@click.option("--seed", type=click.IntRange(0), required=True, help="Seed for everything.")
@click.option(
    "--jobs", type=click.IntRange(1), help="Processes on this machine.  [default: all cores]"
)
@click.option("--scheduler", metavar="ADDRESS", help="Use the dask cluster of this scheduler.")
@click.option(
    "--population",
    type=click.Choice(list(POPULATIONS)),
    help="What kind of people take part.  [default: default]",
)
@click.option(
    "--world", "people", metavar="FILE.toml", help="People of a kind of your own, instead."
)
@click.option(
    "--coach",
    metavar="KIND",
    shell_complete=offering(coaches, files=True),
    help="The adaptive instructor of a new study: as in ana play, or knowledge+quiz.  "
    f"[default: {ADAPTIVE}]",
)
@click.option(
    "--preset",
    type=click.Choice(list(PRESETS)),
    help=f"How ana adapts in a new study.  [default: {DEFAULT_PRESET}]",
)
def simulate_command(
    folder: Path,
    participants: int,
    seed: int,
    jobs: int | None,
    scheduler: str | None,
    population: str | None,
    people: str | None,
    coach: str | None,
    preset: str | None,
) -> None:
    """Let N simulated people take part in the study DIR, which is created if it does not exist.

    Their journals have the same form as real ones and are marked as simulated. The same seed gives
    the same journals on any machine. After an interruption, run the command again to continue.
    """
    if population and people:
        raise click.UsageError("give either --population or --world")
    refuse_other_accounts(folder, f"ana simulate {folder} ...")
    workers = _workers(jobs, scheduler)
    who = world(people or population or "default")
    progress = simulate(folder, participants, seed, who, workers, preset, coach)
    before = next(progress)
    with click.progressbar(length=participants, label="Simulating", show_pos=True) as bar:
        bar.update(before)
        for done in progress:
            bar.update(done - before)
            before = done
    click.echo(f"{folder}: {participants} simulated participants")


def _workers(jobs: int | None, scheduler: str | None) -> Workers:
    if scheduler is not None:
        return partial(on_cluster, address=scheduler)
    jobs = jobs or cores()
    return here if jobs == 1 else partial(on_cores, jobs=jobs)
