"""`ana building`: look at a building, or check a file before using it in a study."""

from __future__ import annotations

import os
import shutil
import sys
from collections.abc import Iterator, Sequence

import click

from game.commands.offered import buildings, offering
from game.world import load_building
from game.world.building import Building, Room, Severity
from game.world.drawing import BuildingError
from game.world.fitness import shortcomings
from game.world.labels import HALF_BLOCKS, SQUARES
from game.world.picture import LEGEND, Ink, Row, joined, picture, small_picture

STATUS_PROBLEMS = 2

_PAPER = os.terminal_size((400, 200))
"""The size to draw on if there is no terminal."""

_COLOURS = {
    Ink.WALL: "bright_black",
    Ink.DOOR: "yellow",
    Ink.RED: "bright_red",
    Ink.BLUE: "bright_blue",
    Ink.START: "bright_green",
}
_seed_option = click.option(
    "--seed",
    default=0,
    show_default=True,
    help="Names, victims and start for a CSV grid without a legend.",
)


@click.group(name="building")
def building_group() -> None:
    """Look at buildings and check them."""


@building_group.command("show", short_help="Draw a building.")
@click.argument("building", shell_complete=offering(buildings, files=True))
@_seed_option
def show_building(building: str, seed: int) -> None:
    """Draw BUILDING (a name, generated:SEED or a file) with its rooms, doors, victims and start."""
    loaded = load_building(building, seed)
    coloured = _wants_colour()
    columns, lines = shutil.get_terminal_size() if sys.stdout.isatty() else _PAPER
    small = loaded.plan.width > columns
    rooms = sorted(loaded.rooms, key=lambda room: room.name)
    numbers = {room.name: number for number, room in enumerate(rooms, start=1)}
    drawn = small_picture(loaded, numbers) if small else _whole_picture(loaded, columns, lines)
    for row in _panels(drawn, columns):
        click.echo("".join(_painted(row) if coloured else _plain(row)).rstrip())
    click.echo("".join(_painted(LEGEND) if coloured else _plain(LEGEND)))
    click.echo(f"\n{loaded.name}: {counts(loaded)}")
    for room in rooms:
        number = f"{numbers[room.name]:>2} " if small else ""
        click.echo(f"  {number}{room.name:<24}{_contents(loaded, room)}")


@building_group.command("check", short_help="Check a building file.")
@click.argument("file", shell_complete=offering(buildings, files=True))
@_seed_option
def check_building(file: str, seed: int) -> int:
    """Check the building FILE, a name or generated:SEED: list every problem and how to fix it."""
    try:
        building = load_building(file, seed)
        problems = shortcomings(building, file, _top_line(file, building))
    except BuildingError as error:
        problems = error.problems
    for problem in problems:
        click.echo(f"{problem.place}: {problem.message}. {problem.hint}.")
    if problems:
        return STATUS_PROBLEMS
    click.echo(f"{file}: no problems ({counts(building)})")
    return 0


def counts(building: Building) -> str:
    """The size of a building and what is in it."""
    reds = sum(victim.severity is Severity.RED for victim in building.victims)
    return (
        f"{building.plan.width} x {building.plan.height} cells, {len(building.rooms)} rooms, "
        f"{len(building.doors)} doors, {len(building.victims)} victims ({reds} red)"
    )


def _contents(building: Building, room: Room) -> str:
    """The doors and victims of a room, as `2 doors, 1 red, 1 blue`."""
    found = [f"{len(room.doors)} {'door' if len(room.doors) == 1 else 'doors'}"]
    for severity in Severity:
        lying = sum(
            victim.severity is severity and building.room_of(victim) is room
            for victim in building.victims
        )
        if lying:
            found.append(f"{lying} {severity}")
    return ", ".join(found)


def _top_line(file: str, building: Building) -> int:
    """The line of the file that holds the first row of the plan."""
    if file.lower().endswith(".csv"):
        return 1
    lines = [line.rstrip() for line in building.text.split("\n")]
    return lines.index("plan:") + 2


def _whole_picture(building: Building, columns: int, lines: int) -> Sequence[Row]:
    """In squares if they fit the terminal, else in half-blocks."""
    plan = building.plan
    fits = plan.width * SQUARES.columns <= columns and plan.height <= lines
    return picture(building, SQUARES if fits else HALF_BLOCKS)


def _panels(rows: Sequence[Row], columns: int) -> Iterator[Row]:
    """The rows; of a picture wider than the terminal, panels one below the other."""
    for left in range(0, len(rows[0]), columns):
        for row in rows:
            yield joined(row[left : left + columns])


def _painted(row: Row) -> Iterator[str]:
    for stroke in row:
        yield click.style(
            stroke.text,
            fg=_COLOURS.get(stroke.ink),
            bg=_COLOURS.get(stroke.paper),
            bold=stroke.ink is Ink.NAME,
        )


def _plain(row: Row) -> Iterator[str]:
    return (stroke.text for stroke in row)


def _wants_colour() -> bool:
    return sys.stdout.isatty() and not os.environ.get("NO_COLOR")
