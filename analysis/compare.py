"""`ana compare`: coaches on the same simulated people, in worlds of different kinds of people."""

from __future__ import annotations

import json
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any, Literal, Protocol

import click

from game.errors import AnaError

COACHES = "static:1,static:2,static:3,ana,ana:calibrated,knowledge"
WORLDS = "default,hasty,careful,slow-readers,poor-explorers,good-explorers"
BUILDINGS = "harbour,foundry"
PEOPLE, PEOPLE_A_DRAW = 40, 3
CUBE_AXES = 18


class Playing(Protocol):
    """What the command is given by the game."""

    def trials(self, tick: Callable[[int, int], None], **asked: Any) -> Iterator[dict[str, Any]]:
        """Play the missions that are asked for; one row each."""
        ...


def _names(_ctx: click.Context, _option: click.Parameter, value: str | None) -> list[str] | None:
    return None if value is None else [name for it in value.split(",") if (name := it.strip())]


def _listed(names: str) -> Callable[[click.Context, click.Parameter, str], list[str]]:
    """Offers a shell the names that could come next in a list with commas."""

    def offer(_ctx: click.Context, _option: click.Parameter, typed: str) -> list[str]:
        before, comma, begun = typed.rpartition(",")
        return [f"{before}{comma}{it}" for it in names.split(",") if it.startswith(begun)]

    return offer


@click.command(name="compare")
@click.pass_obj
@click.option("--coaches", default=COACHES, show_default=True, callback=_names, metavar="K,...",
              shell_complete=_listed(f"{COACHES},ana:belief,knowledge+quiz,truth,pace"),
              help="Kinds of coach, ana:PRESET, static:LEVEL, knowledge+quiz, truth (told what "
              "people know) or FILE.py:CLASS.")  # fmt: skip
@click.option("--worlds", callback=_names, metavar="W,...", shell_complete=_listed(WORLDS),
              help="Kinds of people: names or TOML files.  "
              f"[default: {WORLDS}; none with --hypercube]")  # fmt: skip
@click.option("--buildings", default=BUILDINGS, show_default=True, callback=_names,
              metavar="B,...", shell_complete=_listed(BUILDINGS),
              help="Names, generated:SEED or files.")  # fmt: skip
@click.option("--people", type=click.IntRange(1), metavar="N",
              help="Persons in each world and building.  "
              f"[default: {PEOPLE}; {PEOPLE_A_DRAW} with --hypercube]")  # fmt: skip
@click.option("--set", "of", type=click.Choice(["choosing", "reporting"]), default="reporting",
              show_default=True, help="Which people: numbers are chosen on one set and reported on "
              "the other.")  # fmt: skip
@click.option("--seed", type=click.IntRange(0), default=1, show_default=True)
@click.option("--hypercube", type=click.IntRange(1), metavar="N",
              help="Draw N worlds by Latin hypercube, and average over them.")  # fmt: skip
@click.option("--jobs", type=click.IntRange(1), help="Processes.  [default: all cores]")
@click.option("--scheduler", metavar="ADDRESS", help="Use the dask cluster of this scheduler.")
@click.option("--json", "out", type=click.Path(path_type=Path), metavar="OUT.json",
              help="Write all numbers here.")  # fmt: skip
@click.option("--figures", type=click.Path(path_type=Path), metavar="DIR",
              help="Draw the figure into DIR.")  # fmt: skip
def command(
    game: Playing,
    coaches: list[str],
    worlds: list[str] | None,
    buildings: list[str],
    people: int | None,
    of: str,
    seed: int,
    hypercube: int | None,
    jobs: int | None,
    scheduler: str | None,
    out: Path | None,
    figures: Path | None,
) -> None:
    """Let the same simulated people play with several coaches, and compare what comes of it.

    Every person plays with every coach, so differences are taken person by person: to the static
    level that is best for each knowledge group, and to ANA. The people are simulated: this tells
    about coaches and assumptions, not about people.
    """
    import pandas as pd
    from scipy.stats import qmc

    from analysis.pages.coaches import comparison_rows, comparison_text
    from analysis.sources.absent import Row, plain
    from analysis.stats.comparison import LOW_UP_TO, MED_UP_TO, compared

    if worlds is None:
        worlds = [] if hypercube else WORLDS.split(",")
    if not (coaches and buildings and (worlds or hypercube)):
        raise click.UsageError("there must be a coach, a building and a world to compare")
    _can_be_written(out, figures)
    people = people or (PEOPLE_A_DRAW if hypercube else PEOPLE)
    cube = qmc.LatinHypercube(CUBE_AXES, rng=seed).random(hypercube or 0)
    rows = game.trials(
        _tell,
        coaches=coaches,
        worlds=worlds,
        cube=cube.tolist(),
        buildings=buildings,
        people=people,
        seed=seed,
        of=of,
        jobs=jobs,
        scheduler=scheduler,
    )
    trials = pd.DataFrame(list(rows))
    parts = []
    named = trials["world"].isin(worlds)
    if named.any():
        parts.append(compared(trials[named]))
    if hypercube:
        drawn = trials[~named].assign(draw=lambda it: it["world"], world="hypercube")
        parts.append(compared(drawn, unit="draw"))
    said = (
        f"Simulated people of the set for {of} (seed {seed}): {people} in each world and building"
    )
    click.echo("\n\n".join(comparison_text(part, said) for part in parts))
    if out is not None:
        facts: Row = {
            "simulated": True,
            "people": of,
            "seed": seed,
            "people_in_each": people,
            "hypercube": hypercube or 0,
            "buildings": buildings,
            "groups": {
                "LOW": [0, LOW_UP_TO],
                "MED": [LOW_UP_TO, MED_UP_TO],
                "HIGH": [MED_UP_TO, 1],
            },
        }
        found = [comparison_rows(part) for part in parts]
        joined: Row = {key: [row for part in found for row in part[key]] for key in found[0]}
        tree, absent = plain(facts | joined)
        assert isinstance(tree, dict)
        _write(out, json.dumps(tree | {"absent": absent}, indent=1) + "\n")
    if figures is not None:
        _draw(figures, parts)


def _can_be_written(out: Path | None, figures: Path | None) -> None:
    """Raise AnaError now rather than after all missions for a place that cannot be written to."""
    if out is not None:
        there = out.exists()
        _write(out, "", "a")
        if not there:
            out.unlink()
    if figures is not None:
        _make(figures)


def _make(folder: Path) -> None:
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise AnaError(
            f"the figure cannot be written ({error.strerror})", place=str(folder)
        ) from error


def _draw(folder: Path, parts: list[Any]) -> None:
    from analysis.pages.coaches import comparison_figure

    _make(folder)
    for number, part in enumerate(parts):
        drawn = comparison_figure(part)
        name = drawn.name if number == 0 else f"{drawn.name}-hypercube"
        try:
            drawn.figure.savefig(folder / f"{name}.svg", metadata={"Date": None})
        except OSError as error:
            raise AnaError(
                f"the figure cannot be written ({error.strerror})", place=str(folder)
            ) from error


def _write(path: Path, text: str, mode: Literal["a", "w"] = "w") -> None:
    try:
        with path.open(mode, encoding="utf-8") as file:
            file.write(text)
    except OSError as error:
        raise AnaError(
            f"the numbers cannot be written ({error.strerror})",
            place=str(path),
            hint="Give a file in a folder that exists and that you may write to.",
        ) from error


def _tell(done: int, of: int) -> None:
    """Count what has been played on a terminal's error stream."""
    if sys.stderr.isatty():
        click.echo(f"\r{done} of {of} people have played", err=True, nl=done == of)
